"""The strips that a section's outline is made of, and how they are joined.

Seen against the direction of travel, with the names of the sides::

            left_upper            top             right_upper
         .---------------o-------------------o---------------.
    left |                                                   | right
         '---------------o-------------------o---------------'
            left_lower          bottom            right_lower

Strips run from left to right, upright ones upwards. Every section has a ``bottom`` and a ``top``;
its form and its contact chords say which of the others there are: where ``left_lower`` is missing,
``bottom`` runs on to the edge, and where ``left`` is missing, lower and upper side meet there in a
point (an edge, or the outermost point of an arc).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..support.arrays import read_only
from .splines import Quadratic, greville, quadratic_knots, quadratic_spline

FIRST, LAST = 0, -1
"""The poles at a strip's ends."""


@dataclass(frozen=True)
class Side:
    """A side's image in the midline, and the (side, end) from which it takes its own inner end."""

    mirrored: str
    carries_on: tuple[str, int] | None = None
    upright: bool = False


SIDES: Mapping[str, Side] = {
    "bottom": Side("top"),
    "top": Side("bottom"),
    "left_lower": Side("left_upper", ("bottom", FIRST)),
    "right_lower": Side("right_upper", ("bottom", LAST)),
    "left_upper": Side("left_lower", ("top", FIRST)),
    "right_upper": Side("right_lower", ("top", LAST)),
    "left": Side("left", upright=True),
    "right": Side("right", upright=True),
}
"""The order of a section's sides and their joints, as they are drawn above."""

EDGES = {"left": FIRST, "right": LAST}
"""The edges of a section, and the end of the strips that lies there."""


@dataclass(frozen=True, eq=False)
class Strip:
    """One strip of a section, a quadratic rational spline: ``poles`` (n, 3) are v, z (mm), weight.

    ``knots`` are without unit, from 0 to 1.
    """

    side: str
    knots: np.ndarray
    poles: np.ndarray

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Points (v, z), shape (shares, 2), mm, at shares from 0 to 1 of the strip's parameter."""
        from scipy.interpolate import BSpline

        homogeneous = np.hstack([self.poles[:, :2] * self.poles[:, 2:], self.poles[:, 2:]])
        points = BSpline(self.knots, homogeneous, 1 if len(self.poles) == 2 else 2)(shares)
        return points[:, :2] / points[:, 2:]


@dataclass(frozen=True, eq=False)
class Section:
    """A control section: its ``strips`` by side, see :data:`SIDES`."""

    strips: dict[str, Strip]

    @property
    def pointed(self) -> bool:
        """True where the outline has two true edges and no side between them."""
        return "left" not in self.strips and not self.rounded

    @property
    def rounded(self) -> bool:
        """True where arcs join the contact and the free side."""
        return any((strip.poles[:, 2] != 1.0).any() for strip in self.strips.values())

    def outermost(self, edge: str, level: str) -> Strip:
        """The strip that reaches the ``left`` or ``right`` edge on the ``lower`` or ``upper`` side."""
        return _outermost(self.strips, edge, level)


def _outermost(strips: Mapping[str, Strip], edge: str, level: str) -> Strip:
    return strips.get(f"{edge}_{level}") or strips[{"lower": "bottom", "upper": "top"}[level]]


def parabolic_strip(
    side: str, breaks: Sequence[float], left: float, right: float, pieces: Sequence[Quadratic]
) -> Strip:
    """A strip from v = ``left`` to ``right`` (mm), a quadratic between every two ``breaks``.

    The breaks are shares of it, from 0 to 1; one piece given stands for all.
    """
    places = [left + share * (right - left) for share in breaks]
    places[FIRST], places[LAST] = left, right
    spline = quadratic_spline(places, pieces)

    knots = quadratic_knots(breaks)
    v = left + greville(knots, 2) * (right - left)
    v[FIRST], v[LAST] = left, right
    return Strip(side, knots, np.column_stack([v, spline.poles, np.ones(len(v))]))


def upright_strip(side: str, v: float, low: float, height: float) -> Strip:
    """A straight side at ``v`` from ``low`` upwards, all mm."""
    poles = np.array([[v, low, 1.0], [v, low + height, 1.0]])
    return Strip(side, np.array([0.0, 0.0, 1.0, 1.0]), poles)


def joined(strips: Iterable[Strip]) -> Section:
    """The section of new strips, whose neighbours share their end poles to the last bit."""
    by_side = {strip.side: strip for strip in strips}

    for side, strip in by_side.items():
        if joint := SIDES[side].carries_on:
            inner, end = joint
            own_end = LAST if end == FIRST else FIRST
            strip.poles[own_end, :2] = by_side[inner].poles[end, :2]

    for edge, end in EDGES.items():
        low, high = (_outermost(by_side, edge, level).poles[end] for level in ("lower", "upper"))
        if upright := by_side.get(edge):
            upright.poles[FIRST, :2] = low[:2]
            high[1] = upright.poles[LAST, 1]
            upright.poles[LAST, :2] = high[:2]
        else:
            high[:2] = low[:2]

    for strip in by_side.values():
        read_only(strip.poles)
    return Section(by_side)


def upside_down(section: Section) -> Section:
    """The section mirrored at its midline."""
    strips = {}
    for strip in section.strips.values():
        side = SIDES[strip.side]
        poles = strip.poles * [1.0, -1.0, 1.0]
        if side.upright:
            poles = poles[::-1]
        strips[side.mirrored] = Strip(side.mirrored, strip.knots, read_only(poles))
    return Section(strips)
