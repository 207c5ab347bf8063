"""Interlacement of two-direction weaves: which yarn lies on top at every crossing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from .bodies import Body, YarnBody
from .directions import Direction
from .faults import pattern_faults, regular_fault
from .levels import HIGH, LOW, Level, level_of

FAMILIES = ("plain", "twill", "satin", "pattern")
"""The weave types; each has one table ``<family>.csv`` and one master."""


@dataclass(frozen=True)
class Weave:
    """A two-direction weave: a regular one by its floats, any other by its pattern.

    Regular: every weft passes over ``over`` warps, then under ``under``, and repeats the
    weft before it ``step`` warps further on; the elementary cell holds ``over + under``
    yarns of either direction. Plain is 1*1, a twill m*n has step 1, a satin of N harnesses
    is 1*(N-1) with a step coprime to N (paper, section 1.1).

    ``pattern`` has one text a weft, of ``1`` where it passes over the warp and ``0`` where
    under; ``over``, ``under`` and ``step`` then mean nothing and are 0. Every yarn must
    change sides somewhere, and none may lie over or under all others with nothing tying them
    together (:mod:`~fabric_cad.weave.faults`). Raises ValueError.
    """

    over: int = 0
    under: int = 0
    step: int = 1
    pattern: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.pattern:
            if faults := pattern_faults(self.pattern):
                raise ValueError("; ".join(faults))
        elif fault := regular_fault(self.over, self.under, self.step):
            raise ValueError(fault)

    @property
    def wefts(self) -> int:
        """Wefts in the elementary cell."""
        return len(self.pattern) or self.over + self.under

    @property
    def warps(self) -> int:
        """Warps in the elementary cell."""
        return len(self.pattern[0]) if self.pattern else self.over + self.under

    def crossed_by(self, direction: Direction) -> int:
        """Yarns that one weft, or one warp, crosses in the cell."""
        return self.warps if direction == Direction.WEFT else self.wefts

    def warps_below(self) -> np.ndarray:
        """How many warps, 0 or 1, lie below the weft at every crossing: integers, shape (wefts, warps)."""
        if self.pattern:
            return np.array([[int(mark) for mark in row] for row in self.pattern])
        wefts, warps = np.ogrid[: self.wefts, : self.warps]
        return ((warps - self.step * wefts) % self.warps < self.over).astype(int)

    def interlacement(self) -> np.ndarray:
        """Boolean matrix, shape (wefts, warps): True where the weft passes over the warp."""
        return self.warps_below() > 0

    def name(self, family: str) -> str:
        """What people call it, e.g. ``satin 8 step 3`` or ``pattern 4 wefts x 6 warps``."""
        if self.pattern:
            return f"{family} {self.wefts} wefts x {self.warps} warps"
        if family == "satin":
            return f"{family} {self.warps} step {self.step}"
        return f"{family} {self.over}*{self.under}"

    def floats(self, direction: Direction) -> tuple[float, float]:
        """Mean length of a direction's low and of its high floats, in crossed yarns."""
        if self.pattern:
            return _mean_floats(self, direction)
        if direction == Direction.WEFT:
            return self.under, self.over
        return self.over, self.under


@lru_cache(maxsize=1024)
def _mean_floats(weave: Weave, direction: Direction) -> tuple[float, float]:
    """Crossings on either side per float on it: every high float is followed by a low one."""
    yarns = yarns_of(weave.interlacement())
    high = np.array([yarn.high for yarn in yarns if yarn.direction == direction])
    floats = np.count_nonzero(high & ~np.roll(high, 1, axis=1))
    return float(np.count_nonzero(~high) / floats), float(np.count_nonzero(high) / floats)


def weave_of(family: str, cells: Mapping) -> Weave:
    """The weave of one row of a family table, from its weave columns (none for plain)."""
    if family == "plain":
        return Weave(1, 1)
    if family == "twill":
        return Weave(cells["over"], cells["under"])
    if family == "satin":
        return Weave(1, cells["harness"] - 1, cells["step"])
    return Weave(pattern=cells["pattern"])


@dataclass(frozen=True)
class Yarn:
    """One yarn of the elementary cell and what it meets, crossing by crossing.

    ``high[k]`` is True where the yarn passes over the k-th yarn it crosses;
    ``turns_left[k]`` and ``turns_right[k]`` are True where that crossed yarn changes its
    side of the fabric just left (smaller v) and right of this yarn, and False where it
    continues its float there.
    """

    direction: Direction
    index: int
    high: tuple[bool, ...]
    turns_left: tuple[bool, ...]
    turns_right: tuple[bool, ...]

    @property
    def body(self) -> YarnBody:
        """What it is in a cell; yarns of one direction are numbered by ``index``, from 0."""
        return Body.yarn(self.direction, self.index)

    @property
    def name(self) -> str:
        """What files call it: ``weft_1``."""
        return self.body.name

    @property
    def levels(self) -> tuple[Level, ...]:
        """Its level at every crossing."""
        return tuple(level_of(self.direction, HIGH if high else LOW) for high in self.high)

    @property
    def floats_on(self) -> tuple[bool, ...]:
        """True where the yarn comes to its k-th crossing on the side it had at the one before.

        The crossing before the first is the last one, a period earlier.
        """
        before = self.high[-1:] + self.high[:-1]
        return tuple(was_high == high for was_high, high in zip(before, self.high))


def yarns_of(interlacement: np.ndarray) -> tuple[Yarn, ...]:
    """Every yarn of a cell, wefts first, from its interlacement matrix (wefts, warps)."""
    return (
        *_yarns_along(Direction.WEFT, interlacement),
        *_yarns_along(Direction.WARP, ~interlacement.T),
    )


def _yarns_along(direction: Direction, high: np.ndarray) -> Iterator[Yarn]:
    """The yarns of a direction; ``high`` (yarns, crossings) is True where one passes over."""
    turns_left = np.roll(high, 1, axis=0) != high
    turns_right = np.roll(high, -1, axis=0) != high
    for index, rows in enumerate(zip(high, turns_left, turns_right)):
        yield Yarn(direction, index, *(tuple(row.tolist()) for row in rows))
