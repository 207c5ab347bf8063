"""Trajectories, control planes and the exact skin swept between control sections.

Everything is a polynomial spline, so the skin has closed-form poles and nothing is fitted.
Between two control planes the section is translated along the trajectory; where the two
planes' sections differ they blend with the cubic smoothstep 3 t^2 - 2 t^3, whose Bernstein
coefficients 0, 0, 1, 1 repeat each section's poles twice. The skin is therefore tangent
continuous across every control plane (model, section 5).

::

    plane   0     1           2     3           4       mid-gap planes: 0, 3, 6, ...
            |-----|-----------|-----|-----------|----   crossings: 1-2, 4-5, ...
           gap/2   crossing, c  gap   crossing
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .sections import Section, contact_section, free_section
from .solved import Direction, FreeSide, SolvedFabric
from .weaves import Yarn


@dataclass(frozen=True, eq=False)
class Spline:
    """A polynomial spline z(t): ``knots`` with multiplicities, ``poles``, ``degree``."""

    knots: np.ndarray
    poles: np.ndarray
    degree: int

    @property
    def abscissae(self) -> np.ndarray:
        """Greville abscissae: the poles of t itself over the same knots."""
        inner = np.lib.stride_tricks.sliding_window_view(self.knots[1:-1], self.degree)
        return inner.mean(axis=1)


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Midline of a yarn over the cell: one spline between every two control planes.

    ``axis`` is the yarn's place across (y of a weft, x of a warp) and ``planes`` the places
    of the control planes along it, mm.
    """

    direction: str
    axis: float
    planes: tuple[float, ...]
    pieces: tuple[Spline, ...]


@dataclass(frozen=True, eq=False)
class Patch:
    """One tensor-product polynomial face z(t, v) of a yarn, t along and v across, mm.

    ``z`` are the poles, shape (len(along), len(across)); ``along`` and ``across`` carry
    knots, degree and the coordinates' own poles. ``side`` is ``top``, ``bottom``, ``left`` or
    ``right``; on the last two ``across`` is the constant v and z is linear in a parameter
    from the lower edge (0) to the upper one (1).
    """

    side: str
    along: Spline
    across: Spline
    z: np.ndarray


@dataclass(frozen=True, eq=False)
class Skin:
    """The closed surface of a yarn: strips of patches, one patch per pair of control planes."""

    direction: str
    axis: float
    planes: tuple[float, ...]
    patches: tuple[Patch, ...]


def control_planes(fabric: SolvedFabric, direction: str) -> tuple[float, ...]:
    """Places of a yarn's control planes along the cell, mm: mid-gap and both sides of each crossing."""
    a = fabric.directions[direction].crossed_spacing
    c = fabric.crossed(direction).width
    places = [0.0]
    for k in range(fabric.weave.crossed_by(direction)):
        places += [(k + 0.5) * a - c / 2, (k + 0.5) * a + c / 2, (k + 1) * a]
    return tuple(places)


def trajectory(fabric: SolvedFabric, yarn: Yarn, planes: Sequence[float]) -> Trajectory:
    """The midline of one yarn between its control planes (Fig. 11, 16).

    Plateaux and half parabolas over the crossings, straight segments over the gaps.
    """
    solved = fabric.directions[yarn.direction]
    pieces = []
    for k, high in enumerate(yarn.high):
        plateau = solved.z_high if high else solved.z_low
        p = -solved.p_high if high else solved.p_low
        before, here, after = planes[3 * k], planes[3 * k + 1 : 3 * k + 3], planes[3 * k + 3]
        centre = (here[0] + here[1]) / 2
        turns = yarn.high[k - 1] != high, yarn.high[(k + 1) % len(yarn.high)] != high
        ends = [p * (side - centre) ** 2 if turn else 0.0 for side, turn in zip(here, turns)]
        slopes = [2 * p * (side - centre) if turn else 0.0 for side, turn in zip(here, turns)]
        reach = before - here[0], after - here[1]
        outer = [plateau + end + slope * length for end, slope, length in zip(ends, slopes, reach)]
        inner = [plateau + end for end in ends]
        pieces += [
            _line(before, here[0], outer[0], inner[0]),
            Spline(
                np.array([here[0]] * 3 + [centre] + [here[1]] * 3),
                np.array([inner[0], plateau, plateau, inner[1]]),
                2,
            ),
            _line(here[1], after, inner[1], outer[1]),
        ]
    return Trajectory(
        yarn.direction,
        (yarn.index + 0.5) * fabric.crossed(yarn.direction).crossed_spacing,
        tuple(planes),
        tuple(pieces),
    )


def _line(start: float, end: float, z_start: float, z_end: float) -> Spline:
    return Spline(np.array([start, start, end, end]), np.array([z_start, z_end]), 1)


def control_sections(fabric: SolvedFabric, yarn: Yarn) -> tuple[Section, ...]:
    """The section in every control plane of one yarn (Fig. 12): contact, contact, free, ..."""
    solved = fabric.directions[yarn.direction]
    crossed = fabric.crossed(yarn.direction)
    between = free_section(solved.thickness, solved.width, fabric.lateral_height)
    sections = [between]
    for high, left, right in zip(yarn.high, yarn.turns_left, yarn.turns_right):
        free = _free_side(solved, "high" if high else "low", left, right)
        rise = (crossed.p_low if high else crossed.p_high) * (solved.width / 2) ** 2
        contact = contact_section(
            solved.thickness,
            solved.width,
            rise * left,
            rise * right,
            free.q,
            free.v0,
            fabric.lateral_height,
            contact_below=high,
        )
        sections += [contact, contact, between]
    return tuple(sections)


def _free_side(solved: Direction, plateau: str, left: bool, right: bool) -> FreeSide:
    kind = {0: "float", 1: "edge", 2: "turn"}[left + right]
    free = solved.free_sides[plateau, kind]
    return FreeSide(free.q, -free.v0) if left and not right else free


def skin(path: Trajectory, sections: Sequence[Section]) -> Skin:
    """Sweep the control sections along a trajectory: exact tensor-product splines.

    ``sections`` has one entry per control plane, all lenticular or all with flat sides.
    """
    patches = []
    for piece, first, second in zip(path.pieces, sections, sections[1:]):
        for side, across, start, end in _strips(first, second):
            if start is end or np.array_equal(start, end):
                along, rows = piece, np.broadcast_to(start, (len(piece.poles), len(start)))
            else:
                along, rows = _cubic(piece), np.array([start, start, end, end])
            patches.append(Patch(side, along, across, along.poles[:, None] + rows))
    return Skin(path.direction, path.axis, path.planes, tuple(patches))


def _strips(first: Section, second: Section) -> Iterator[tuple[str, Spline, np.ndarray, np.ndarray]]:
    """(side, spline of v, z poles in the first and in the second section) of every strip."""
    ends = first.v[0], first.v[-1]
    knots = np.array([ends[0]] * 3 + [0.0] + [ends[1]] * 3)
    yield "top", Spline(knots, first.v, 2), first.top, second.top
    yield "bottom", Spline(knots, first.v, 2), first.bottom, second.bottom
    if not first.pointed:
        upward = np.array([0.0, 0.0, 1.0, 1.0])
        for side, at in (("left", 0), ("right", -1)):
            yield (
                side,
                Spline(upward, np.full(2, ends[at]), 1),
                np.array([first.bottom[at], first.top[at]]),
                np.array([second.bottom[at], second.top[at]]),
            )


def _cubic(line: Spline) -> Spline:
    """The same straight piece as a cubic without inner knots."""
    (start, *_, end), (z_start, z_end) = line.knots, line.poles
    share = np.array([0, 1 / 3, 2 / 3, 1.0])
    return Spline(np.array([start] * 4 + [end] * 4), z_start + (z_end - z_start) * share, 3)
