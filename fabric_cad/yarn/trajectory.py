"""The trajectory of a yarn: its midline, a polynomial spline between every two control planes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..model.solved import SolvedFabric
from ..section.splines import Quadratic, Spline, line, quadratic_spline
from ..weave.weaves import Yarn
from .planes import ControlPlane


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Midline of a yarn over the cell: one spline between every two control planes.

    ``axis`` is the yarn's place across (y of a weft, x of a warp), mm.
    """

    direction: str
    axis: float
    planes: tuple[ControlPlane, ...]
    pieces: tuple[Spline, ...]


def trajectory(fabric: SolvedFabric, yarn: Yarn, planes: Sequence[ControlPlane]) -> Trajectory:
    """The midline of one yarn between its control planes (Fig. 11, 16).

    Flat on the plateaux, half a parabola over the contact chord where the yarn leaves a
    float, straight from there.
    """
    solved = fabric.directions[yarn.direction]
    crossed = fabric.crossed(yarn.direction)
    pieces = []
    for before, after in zip(planes, planes[1:]):
        k = before.crossing if before.crossing is not None else after.crossing
        high = yarn.high[k]
        level, p = (solved.z_high, -solved.p_high) if high else (solved.z_low, solved.p_low)
        contact = crossed.contact["low" if high else "high"]
        centre = (k + 0.5) * solved.crossed_spacing
        sides = []
        for sign, turns in ((-1, yarn.high[k - 1] != high), (1, yarn.high[(k + 1) % len(yarn.high)] != high)):
            vertex, reach = centre + sign * contact.offset, contact.half_chord - contact.offset
            end = centre + sign * contact.half_chord
            bent = Quadratic(vertex, level, 0.0, p if turns else 0.0)
            straight = Quadratic(end, bent.polar(end, end), 2 * bent.p * sign * reach)
            sides.append((bent, straight))
        if before.place < centre < after.place:
            (left, _), (right, _) = sides
            inner, parts = [centre], [left, right]
            if contact.offset:
                inner, parts = [left.x0, right.x0], [left, Quadratic(centre, level), right]
            pieces.append(quadratic_spline([before.place, *inner, after.place], parts))
        else:
            straight = sides[0 if after.place < centre else 1][1]
            ends = before.place, after.place
            pieces.append(line(*ends, *(straight.polar(x, x) for x in ends)))
    axis = (yarn.index + 0.5) * crossed.crossed_spacing
    return Trajectory(yarn.direction, axis, tuple(planes), tuple(pieces))
