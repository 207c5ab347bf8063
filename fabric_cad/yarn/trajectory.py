"""The trajectory of a yarn: its midline, a polynomial spline between every two control planes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..model.solved import SolvedFabric
from ..section.splines import Quadratic, Spline, line, quadratic_spline
from ..weave.directions import Direction
from ..weave.weaves import Yarn
from .planes import ControlPlane


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Midline of a yarn over the cell: one spline between every two control planes.

    ``axis`` is the yarn's place across (y of a weft, x of a warp), mm.
    """

    direction: Direction
    axis: float
    planes: tuple[ControlPlane, ...]
    pieces: tuple[Spline, ...]


def trajectory(fabric: SolvedFabric, yarn: Yarn, planes: Sequence[ControlPlane]) -> Trajectory:
    """The midline of one yarn between its control planes (Fig. 11, 16).

    Flat on the plateaux, half a parabola over the contact chord where the yarn leaves a
    float, straight from there.
    """
    crossings = [_crossing(fabric, yarn, number) for number in range(len(yarn.high))]
    pieces = []

    for before, after in zip(planes, planes[1:]):
        number = after.crossing if before.crossing is None else before.crossing
        if number is None:
            raise ValueError(
                "two control planes in the middle of gaps have no crossing between them"
            )

        pieces.append(crossings[number].piece(before.place, after.place))

    axis = (yarn.index + 0.5) * fabric.crossed(yarn.direction).crossed_spacing
    return Trajectory(yarn.direction, axis, tuple(planes), tuple(pieces))


@dataclass(frozen=True)
class _Crossing:
    """The trajectory around one crossed yarn: bent or flat out to the contact chord's ends, straight from there.

    ``bent`` and ``straight`` are left and right of the ``centre``; ``offset`` is d_c, all mm.
    """

    centre: float
    offset: float
    level: float
    bent: tuple[Quadratic, Quadratic]
    straight: tuple[Quadratic, Quadratic]

    def piece(self, start: float, end: float) -> Spline:
        """The spline between two control planes."""
        if start < self.centre < end:
            left, right = self.bent
            if self.offset:
                parts = [left, Quadratic(self.centre, self.level), right]
                return quadratic_spline([start, left.x0, right.x0, end], parts)
            return quadratic_spline([start, self.centre, end], [left, right])

        straight = self.straight[0 if end < self.centre else 1]
        return line(start, end, straight.polar(start, start), straight.polar(end, end))


def _crossing(fabric: SolvedFabric, yarn: Yarn, number: int) -> _Crossing:
    solved, high = fabric.directions[yarn.direction], yarn.high[number]
    level, p = (solved.z_high, -solved.p_high) if high else (solved.z_low, solved.p_low)
    contact = fabric.crossed(yarn.direction).contact["low" if high else "high"]
    centre = (number + 0.5) * solved.crossed_spacing

    turns_left = yarn.high[number - 1] != high
    turns_right = yarn.high[(number + 1) % len(yarn.high)] != high
    bent, straight = [], []

    for sign, turns in ((-1, turns_left), (1, turns_right)):
        vertex, reach = centre + sign * contact.offset, contact.half_chord - contact.offset
        end = centre + sign * contact.half_chord

        parabola = Quadratic(vertex, level, 0.0, p if turns else 0.0)  # (1), (2)
        bent.append(parabola)
        straight.append(Quadratic(end, parabola.polar(end, end), 2 * parabola.p * sign * reach))

    return _Crossing(centre, contact.offset, level, (bent[0], bent[1]), (straight[0], straight[1]))
