"""Trajectories, control planes and the exact skin swept between control sections.

Everything is a polynomial spline (arcs: rational), so the skin has closed-form poles and
nothing is fitted. Between two control planes the section is translated along the trajectory;
where the two planes' sections differ they blend with the cubic smoothstep 3 t^2 - 2 t^3, whose
Bernstein coefficients 0, 0, 1, 1 repeat each section's poles twice. The skin is therefore
tangent continuous across every control plane (model, section 5).

::

    mid-gap   crossing, width c of the crossed yarn    mid-gap
       |--------|-----|=================|-----|--------|-------
        gap / 2        contact chord           gap / 2

The planes at the ends of the contact chord are there where it is shorter than the width.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..section.sections import KINDS, Section, contact_section, free_section
from ..section.splines import Quadratic, Spline, as_cubic, line, quadratic_spline
from ..weave.weaves import Yarn


@dataclass(frozen=True)
class ControlPlane:
    """A place along a yarn (mm), and the number of the crossing it belongs to (None: mid-gap)."""

    place: float
    crossing: int | None


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Midline of a yarn over the cell: one spline between every two control planes.

    ``axis`` is the yarn's place across (y of a weft, x of a warp), mm.
    """

    direction: str
    axis: float
    planes: tuple[ControlPlane, ...]
    pieces: tuple[Spline, ...]


@dataclass(frozen=True, eq=False)
class Patch:
    """One tensor-product face of a yarn between two control planes.

    ``poles``, shape (along, across, 4), are t along the yarn, v across it, z (mm) and weight;
    ``along`` and ``across`` are (knots, degree); ``segment`` numbers the pairs of planes.
    """

    segment: int
    side: str
    along: tuple[np.ndarray, int]
    across: tuple[np.ndarray, int]
    poles: np.ndarray


@dataclass(frozen=True, eq=False)
class Skin:
    """The closed surface of a yarn, its two end sections excepted."""

    direction: str
    axis: float
    planes: tuple[ControlPlane, ...]
    patches: tuple[Patch, ...]


def contact_segment(planes: Sequence[ControlPlane], crossing: int) -> int:
    """Number of the pair of control planes between which a crossing's contact lies."""
    numbers = [at for at, plane in enumerate(planes) if plane.crossing == crossing]
    return numbers[len(numbers) // 2 - 1]


def control_planes(fabric: SolvedFabric, yarn: Yarn) -> tuple[ControlPlane, ...]:
    """A yarn's control planes along the cell (Fig. 12)."""
    a, crossed = fabric.directions[yarn.direction].crossed_spacing, fabric.crossed(yarn.direction)
    planes = [ControlPlane(0.0, None)]
    for k, high in enumerate(yarn.high):
        half_chord = crossed.contact["low" if high else "high"].half_chord
        halves = [crossed.width / 2]
        if half_chord < crossed.width / 2 * (1 - 1e-12):
            halves.append(half_chord)
        centre = (k + 0.5) * a
        planes += [ControlPlane(centre - half, k) for half in halves]
        planes += [ControlPlane(centre + half, k) for half in reversed(halves)]
        planes.append(ControlPlane((k + 1) * a, None))
    return tuple(planes)


def contact_patches(fabric: SolvedFabric) -> dict[tuple[str, str], tuple[float, float, float, float]]:
    """Plan rectangle (x from, x to, y from, y to; mm) in which each weft touches each warp."""
    found = {}
    for i, row in enumerate(fabric.weave.interlacement()):
        for j, over in enumerate(row):
            x, y = (j + 0.5) * fabric.weft.crossed_spacing, (i + 0.5) * fabric.warp.crossed_spacing
            half_x = fabric.warp.contact["low" if over else "high"].half_chord
            half_y = fabric.weft.contact["high" if over else "low"].half_chord
            found[f"weft_{i + 1}", f"warp_{j + 1}"] = (x - half_x, x + half_x, y - half_y, y + half_y)
    return found


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


def control_sections(fabric: SolvedFabric, yarn: Yarn, planes: Sequence[ControlPlane]) -> tuple[Section, ...]:
    """The section in every control plane of one yarn (Fig. 9, 13, 17).

    In the middle of a gap it is the symmetric one (Fig. 13b); with ``float_gap`` flat, between two
    crossings of one float, that of a flat contact on the float's side (Fig. 13a).
    """
    solved, frame = fabric.directions[yarn.direction], fabric.frame(yarn.direction)

    def touching(high: bool, left: bool, right: bool) -> Section:
        plateau = "high" if high else "low"
        free = solved.free_sides[plateau, KINDS[left + right]]
        if left and not right:
            free = free.mirrored
        return contact_section(frame, solved.contact[plateau], (left, right), free, below=high)

    in_crossings = [touching(*crossing) for crossing in zip(yarn.high, yarn.turns_left, yarn.turns_right)]

    symmetric, flat = free_section(frame, solved.between), fabric.float_gap == "flat"
    in_gaps = [
        touching(high, False, False) if flat and same else symmetric for high, same in zip(yarn.high, yarn.floats_on)
    ]
    gaps = iter([*in_gaps, in_gaps[0]])  # the cell is cut in a gap, which stands at either end

    return tuple(next(gaps) if plane.crossing is None else in_crossings[plane.crossing] for plane in planes)


def skin(path: Trajectory, sections: Sequence[Section]) -> Skin:
    """Sweep the control sections, one in each control plane, along a trajectory: exact splines."""
    patches = []
    for segment, (piece, first, second) in enumerate(zip(path.pieces, sections, sections[1:])):
        along = piece if first is second else as_cubic(piece)
        for side, strip in first.strips.items():
            other = second.strips[side].poles
            rows = [strip.poles] * len(along.poles) if first is second else [strip.poles] * 2 + [other] * 2
            poles = np.empty((len(along.poles), len(other), 4))
            poles[..., 0] = along.abscissae[:, None]
            poles[..., 1:] = rows
            poles[..., 2] += along.poles[:, None]
            degree = 1 if len(other) == 2 else 2
            patches.append(Patch(segment, side, (along.knots, along.degree), (strip.knots, degree), poles))
    return Skin(path.direction, path.axis, path.planes, tuple(patches))
