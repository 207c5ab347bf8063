"""Control sections of a yarn: contact side, free side and the lateral zones between them.

All profiles are functions of v, the distance across the yarn from its axis, in a control
plane that is vertical and parallel to the cell's faces (paper, Fig. 9, 13, 17; section 4 of
the model). z is measured from the yarn's midline, the envelope rectangle is |v| <= c/2,
|z| <= b/2::

            free side: one parabola                  contact rise G(v) at the edges
           _.-'''''''''''-._                        /
        .-'                 '-.                    |
    T  <                       >  T       or  flat |   or  round (
        '--.._           _..--'                    |
              '''-----'''  contact side: G of the crossed yarn

The contact side is the crossed yarn's trajectory, G = 0 for |v| <= d_c and p (|v| - d_c)^2
beyond (0 on a side where that yarn floats on), out to the contact chord. From there a pointed
or flat section carries the parabola on to its edge, a round one turns off on a circular arc;
the crossed yarn goes straight, so that the two only move apart.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from .splines import Quadratic, greville, quadratic_knots, quadratic_spline

KINDS = ("float", "edge", "turn")
"""Contact sections: the crossed yarn floats on both sides (flat contact), turns on the right
side only, turns on both."""


@dataclass(frozen=True)
class ContactSide:
    """Contact profile at one plateau: the crossed yarn's parabola p (1/mm), d_c and half the contact chord, mm."""

    p: float
    offset: float
    half_chord: float


@dataclass(frozen=True)
class FreeSide:
    """Free parabola b/2 - q (v - v0)^2 between ``left`` and ``right``; q in 1/mm, the rest mm.

    Its ends are the points of tangency with the arcs of a round section. In other sections the
    parabola runs on to the edges, and the ends only say where its strip is split, so that
    contact at the next crossing can have a face of its own.
    """

    q: float
    v0: float
    left: float
    right: float

    @property
    def mirrored(self) -> FreeSide:
        """The same with left and right exchanged."""
        return FreeSide(self.q, -self.v0, -self.right, -self.left)


@dataclass(frozen=True)
class Frame:
    """What the sections of one direction share: envelope (mm), form, and where their strips are split.

    ``splits`` maps ``bottom`` and ``top`` to their half contact chord and d_c, mm.
    """

    width: float
    thickness: float
    form: str
    lateral_height: float
    splits: dict[str, tuple[float, float]] = field(hash=False)

    def has_laterals(self, side: str) -> bool:
        """True where the ``bottom`` or ``top`` strip ends before the section's edges."""
        return self.form == "round" or self.splits[side][0] < self.width / 2 * (1 - 1e-12)

    def breaks(self, side: str) -> list[float]:
        """Inner and outer breaks of a side's middle strip, as shares from 0 to 1."""
        half_chord, offset = self.splits[side]
        if offset == 0.0:
            return [0.0, 0.5, 1.0]
        share = offset / (2 * half_chord)
        return [0.0, 0.5 - share, 0.5 + share, 1.0]


@dataclass(frozen=True, eq=False)
class Strip:
    """One strip of a section, a quadratic rational spline: ``poles`` (n, 3) are v, z (mm), weight.

    ``knots`` are without unit, from 0 to 1. Strips run from left to right, upright ones upwards.
    """

    side: str
    knots: np.ndarray
    poles: np.ndarray

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Points (v, z), shape (shares, 2), mm, at shares from 0 to 1 of the strip's parameter."""
        from scipy.interpolate import BSpline

        homogeneous = np.hstack([self.poles[:, :2] * self.poles[:, 2:], self.poles[:, 2:]])
        found = BSpline(self.knots, homogeneous, 1 if len(self.poles) == 2 else 2)(shares)
        return found[:, :2] / found[:, 2:]


@dataclass(frozen=True, eq=False)
class Section:
    """A control section: ``strips`` by side.

    Sides are ``bottom`` and ``top``; ``left_lower``, ``right_lower``, ``left_upper``,
    ``right_upper`` between them and the edges; ``left`` and ``right`` for flat sides.
    """

    strips: dict[str, Strip]

    @property
    def pointed(self) -> bool:
        """True where the outline has two true edges and no side between them."""
        return "left" not in self.strips and not self.rounded

    @property
    def rounded(self) -> bool:
        """True where arcs join the contact and the free side."""
        return any((strip.poles[:, 2] != 1.0).any() for strip in self.strips.values())


def free_parabola(thickness, width, rise_left, rise_right, lateral_height):
    """Conic of the free side between two edges: (q in 1/mm, v0 in mm).

    The parabola touches the envelope rectangle's side and ends ``lateral_height`` from the
    contact profile, which has risen by ``rise_left`` and ``rise_right`` at v = -c/2, +c/2;
    all mm, arrays broadcast. The drops e = b - h - rise must be positive. (Fig. 17)
    """
    root_left = np.sqrt(thickness - lateral_height - rise_left)
    root_right = np.sqrt(thickness - lateral_height - rise_right)
    q = ((root_left + root_right) / width) ** 2
    return q, width / 2 * (root_left - root_right) / (root_left + root_right)


def lateral_arc(thickness, width, half_chord, rise, slope):
    """Arc of a round lateral zone: (radius R, height of its centre above the midline), mm.

    Tangent to the contact profile at its end v = ``half_chord``, where that has risen by
    ``rise`` with ``slope``, and to the rectangle's side; arrays broadcast. (Fig. 17)
    """
    root = np.sqrt(1 + np.square(slope))
    radius = (width / 2 - half_chord) / (1 - slope / root)
    return radius, rise - thickness / 2 + radius / root


def round_free_side(thickness, width, arc_left, arc_right):
    """Free parabola of a round section, tangent to both arcs: (q, v0, left, right), mm and 1/mm.

    ``arc_left``, ``arc_right`` are (radius, centre height) of :func:`lateral_arc`. With
    x = 1/sin(theta) at a point of tangency, tangency to one arc is the cubic
    x^3 - (4 q D + 1) x + 4 q R = 0, D the centre's depth below the rectangle's side; its
    largest root in closed form leaves one unknown, q, found by bisection. Arrays broadcast;
    NaN where an arc does not fit below the rectangle's side.
    """
    arcs = [tuple(np.asarray(value, dtype=float) for value in arc) for arc in (arc_left, arc_right)]
    depths = [np.asarray(thickness) / 2 - centre for _, centre in arcs]
    fits = np.all([depth > radius for (radius, _), depth in zip(arcs, depths)], axis=0)

    def ends(q):
        """Per side: distance of the vertex and of the point of tangency from the axis, outwards."""
        found = []
        for (radius, _), depth in zip(arcs, depths):
            P, Q = 4 * q * depth + 1, 4 * q * radius
            x = 2 * np.sqrt(P / 3) * np.cos(np.arccos(np.clip(-1.5 * Q / P * np.sqrt(3 / P), -1, 1)) / 3)
            slope = np.sqrt(np.maximum(x**2 - 1, 0.0))  # of the parabola where it meets the arc
            touch = width / 2 - radius + radius * slope / x
            found.append((touch - slope / (2 * q), touch))
        return found

    low, high = (np.log(np.full(np.shape(fits), value) / width) for value in (1e-9, 1e9))
    with np.errstate(invalid="ignore"):
        for _ in range(100):
            middle = (low + high) / 2
            (vertex_left, _), (vertex_right, _) = ends(np.exp(middle))
            wide = vertex_left + vertex_right > 0  # the vertices pass each other: q is too large
            low, high = np.where(wide, low, middle), np.where(wide, middle, high)
        q = np.exp((low + high) / 2)
        (_, left), (vertex, right) = ends(q)
    return tuple(np.where(fits, value, np.nan) for value in (q, vertex, -left, right))


def round_between(thickness, width, half_chord):
    """Round section between crossings: (q, tan(theta/2)) of its parabolas and arcs.

    Parabolas and arcs meet at |v| = ``half_chord`` with slope cot(theta); mm, arrays
    broadcast. The arc fits where tan(theta/2) <= 1.
    """
    a, b, c = half_chord / 4, thickness / 2, half_chord * 3 / 4 - width / 2
    half = (-b + np.sqrt(b * b - 4 * a * c)) / (2 * a)
    return (1 - half**2) / (4 * half * half_chord), half


@lru_cache(maxsize=256)
def contact_section(
    frame: Frame, contact: ContactSide, turns: tuple[bool, bool], free: FreeSide, below: bool
) -> Section:
    """Section in a crossing: contact profile on one side, free parabola on the other.

    ``turns`` says whether the crossed yarn changes sides just left and right of this one,
    ``below`` whether the contact is on the bottom. The same arguments give the same section
    again: the yarns of a cell share theirs. (Fig. 9, 17)
    """
    if not below:
        flipped = replace(frame, splits={"bottom": frame.splits["top"], "top": frame.splits["bottom"]})
        return _upside_down(contact_section(flipped, contact, turns, free, below=True))
    floor, ceiling, edge = -frame.thickness / 2, frame.thickness / 2, frame.width / 2
    flat = Quadratic(0.0, floor)
    sides = [
        Quadratic(sign * contact.offset, floor, 0.0, contact.p) if turn else flat for sign, turn in zip((-1, 1), turns)
    ]
    middle = [sides[0], flat, sides[1]] if contact.offset else sides
    half = contact.half_chord
    strips = [_parabolic("bottom", frame.breaks("bottom"), -half, half, middle)]
    roof = Quadratic(free.v0, ceiling, 0.0, -free.q)
    strips.append(_parabolic("top", frame.breaks("top"), free.left, free.right, [roof]))
    if frame.form == "round":
        for name, sign, turn, end in (("left", -1, turns[0], free.left), ("right", 1, turns[1], free.right)):
            reach = half - contact.offset
            rise, slope = (contact.p * reach**2, 2 * contact.p * reach) if turn else (0.0, 0.0)
            radius, centre = lateral_arc(frame.thickness, frame.width, half, rise, slope)
            theta = np.arccos(np.clip((abs(end) - (edge - radius)) / radius, -1, 1))
            strips += _arcs(name, sign, edge - radius, centre, radius, -np.pi / 2 + np.arctan(slope), theta)
        return _joined(strips)
    return _joined(
        strips + _laterals(frame, sides, [roof, roof], {"lower": (-half, half), "upper": (free.left, free.right)})
    )


@lru_cache(maxsize=256)
def free_section(frame: Frame, between: FreeSide) -> Section:
    """Section between crossings, where no yarn touches: symmetric, edges at mid-height."""
    floor, ceiling = -frame.thickness / 2, frame.thickness / 2
    roof, bowl = Quadratic(0.0, ceiling, 0.0, -between.q), Quadratic(0.0, floor, 0.0, between.q)
    if frame.form == "round":
        half, edge = between.right, frame.width / 2
        strips = [
            _parabolic("bottom", frame.breaks("bottom"), -half, half, [bowl]),
            _parabolic("top", frame.breaks("top"), -half, half, [roof]),
        ]
        theta = np.arctan2(1.0, 2 * between.q * half)
        radius = (edge - half) / (1 - np.cos(theta))
        for name, sign in (("left", -1), ("right", 1)):
            strips += _arcs(name, sign, edge - radius, 0.0, radius, -theta, theta)
        return _joined(strips)
    halves = {side: frame.splits[side][0] for side in ("bottom", "top")}
    strips = [
        _parabolic(side, frame.breaks(side), -halves[side], halves[side], [shape])
        for side, shape in (("bottom", bowl), ("top", roof))
    ]
    ends = {"lower": (-halves["bottom"], halves["bottom"]), "upper": (-halves["top"], halves["top"])}
    return _joined(strips + _laterals(frame, [bowl, bowl], [roof, roof], ends))


def _parabolic(side: str, breaks: list[float], left: float, right: float, pieces: list[Quadratic]) -> Strip:
    """A strip from v = ``left`` to ``right`` over the given shares of it."""
    places = [left + share * (right - left) for share in breaks]
    places[0], places[-1] = left, right
    spline = quadratic_spline(places, pieces)
    knots = quadratic_knots(breaks)
    v = left + greville(knots, 2) * (right - left)
    v[0], v[-1] = left, right
    return Strip(side, knots, np.column_stack([v, spline.poles, np.ones(len(v))]))


def _laterals(frame, lower, upper, ends) -> list[Strip]:
    """Strips between the split sides and the edges, and the upright ones of a flat section."""
    edge, strips = frame.width / 2, []
    for level, side, shapes in (("lower", "bottom", lower), ("upper", "top", upper)):
        if frame.has_laterals(side):
            left, right = ends[level]
            strips.append(_parabolic(f"left_{level}", [0.0, 1.0], -edge, left, shapes[:1]))
            strips.append(_parabolic(f"right_{level}", [0.0, 1.0], right, edge, shapes[1:]))
    if frame.form == "flat":
        for name, v, low in (("left", -edge, lower[0]), ("right", edge, lower[1])):
            z = low.polar(v, v)
            poles = np.array([[v, z, 1.0], [v, z + frame.lateral_height, 1.0]])
            strips.append(Strip(name, np.array([0.0, 0.0, 1.0, 1.0]), poles))
    return strips


def _arcs(name: str, sign: int, centre_v, centre_z, radius, start, end) -> list[Strip]:
    """Lower and upper arc of a lateral zone, from angle ``start`` < 0 over 0 (the edge) to ``end`` > 0."""
    strips = []
    for level, angles in (("lower", (start, 0.0)), ("upper", (end, 0.0))):
        half = (angles[1] - angles[0]) / 2
        middle, weight = angles[0] + half, np.cos(half)
        polar = [(radius, angles[0]), (radius / weight, middle), (radius, 0.0)]
        poles = np.array([[sign * (centre_v + r * np.cos(a)), centre_z + r * np.sin(a), 1.0] for r, a in polar])
        poles[1, 2] = weight
        if sign < 0:
            poles = poles[::-1]
        strips.append(Strip(f"{name}_{level}", np.array([0.0] * 3 + [1.0] * 3), poles))
    return strips


_JOINTS = (
    # (strip, its end) given, (strip, its end) that takes the same point, to the last bit
    ("bottom", 0, "left_lower", -1),
    ("bottom", -1, "right_lower", 0),
    ("top", 0, "left_upper", -1),
    ("top", -1, "right_upper", 0),
)


def _joined(strips: list[Strip]) -> Section:
    """A section whose neighbouring strips share their end poles exactly."""
    by_side = {strip.side: strip for strip in strips}
    for given, at, taking, there in _JOINTS:
        if taking in by_side:
            by_side[taking].poles[there, :2] = by_side[given].poles[at, :2]
    for name, end in (("left", 0), ("right", -1)):
        low = by_side.get(f"{name}_lower", by_side["bottom"]).poles[end, :2]
        high = by_side.get(f"{name}_upper", by_side["top"]).poles[end, :2]
        if name in by_side:
            low_side, high_side = by_side[name].poles[0], by_side[name].poles[-1]
            low_side[:2] = low
            high[:] = [high[0], high_side[1]]
            high_side[:2] = high
        else:
            high[:] = low
    return Section(by_side)


_TURNED = {"bottom": "top", "top": "bottom", "left": "left", "right": "right"} | {
    f"{name}_{level}": f"{name}_{other}"
    for name in ("left", "right")
    for level, other in (("lower", "upper"), ("upper", "lower"))
}


def _upside_down(section: Section) -> Section:
    """The section mirrored at its midline."""
    strips = []
    for strip in section.strips.values():
        poles = strip.poles * [1.0, -1.0, 1.0]
        if strip.side in ("left", "right"):
            poles = poles[::-1]
        strips.append(Strip(_TURNED[strip.side], strip.knots, poles))
    return Section({strip.side: strip for strip in strips})
