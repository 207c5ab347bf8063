"""Interlacement of two-direction weaves: which yarn lies on top at every crossing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import gcd

import numpy as np

from .bodies import Body, YarnBody
from .directions import Direction

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
    together (:func:`pattern_faults`). Raises ValueError.
    """

    over: int = 0
    under: int = 0
    step: int = 1
    pattern: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.pattern:
            if faults := pattern_faults(self.pattern):
                raise ValueError("; ".join(faults))
            return
        if self.over < 1 or self.under < 1:
            raise ValueError(f"a yarn passes over and under at least one yarn, got {self.over}*{self.under}")
        if gcd(self.step, self.over + self.under) != 1:
            raise ValueError(f"step {self.step} is not coprime to {self.over + self.under}")

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

    def interlacement(self) -> np.ndarray:
        """Boolean matrix, shape (wefts, warps): True where the weft passes over the warp."""
        if self.pattern:
            return np.array([[mark == "1" for mark in row] for row in self.pattern])
        wefts, warps = np.ogrid[: self.wefts, : self.warps]
        return (warps - self.step * wefts) % self.warps < self.over

    def name(self, family: str) -> str:
        """What people call it, e.g. ``satin 8 step 3`` or ``pattern 4 wefts x 6 warps``."""
        if self.pattern:
            return f"{family} {self.wefts} wefts x {self.warps} warps"
        return f"{family} {self.warps} step {self.step}" if family == "satin" else f"{family} {self.over}*{self.under}"

    def floats(self, direction: Direction) -> tuple[float, float]:
        """Mean length of a direction's low and of its high floats, in crossed yarns."""
        if not self.pattern:
            return (self.under, self.over) if direction == Direction.WEFT else (self.over, self.under)
        return _mean_floats(self, direction)


@lru_cache(maxsize=1024)
def pattern_faults(pattern: tuple[str, ...]) -> tuple[str, ...]:
    """What makes a pattern of ``1`` and ``0`` no weave, one text each; none where it is one."""
    if strange := set("".join(pattern)) - {"0", "1"}:
        return (f"a pattern is of 0 and 1, not {', '.join(sorted(strange))}",)
    warps = len(pattern[0])
    if uneven := [
        f"weft {number} has {len(row)} marks where weft 1 has {warps}"
        for number, row in enumerate(pattern, start=1)
        if len(row) != warps
    ]:
        return tuple(uneven)
    idle = []
    for name, yarns in (("weft", pattern), ("warp", list(zip(*pattern)))):
        for number, yarn in enumerate(yarns, start=1):
            if len(set(yarn)) == 1:
                side = "over" if (yarn[0] == "1") == (name == "weft") else "under"
                idle.append(f"{name} {number} passes {side} every yarn and never interlaces")
    return tuple(idle) or _layers(np.array([[mark == "1" for mark in row] for row in pattern]))


def _layers(weft_over_warp: np.ndarray) -> tuple[str, ...]:
    """A text where some yarns lie wholly under the others: then nothing holds the fabric together."""
    for side, over in (("under", weft_over_warp), ("over", ~weft_over_warp)):
        wefts, warps = np.zeros(len(over), dtype=bool), np.zeros(over.shape[1], dtype=bool)
        wefts[0] = True  # and from there every yarn that lies below (above) one reached
        before, reached = 0, 1
        while reached > before:
            warps |= over[wefts].any(axis=0)
            wefts |= ~over[:, warps].all(axis=1)
            before, reached = reached, np.count_nonzero(wefts) + np.count_nonzero(warps)
        if reached < sum(over.shape):
            names = (
                f"{name} {', '.join(map(str, np.flatnonzero(yarns) + 1))}"
                for name, yarns in (("weft", wefts), ("warp", warps))
            )
            return (f"{' and '.join(names)} lie {side} all other yarns: the weave falls into separate layers",)
    return ()


@lru_cache(maxsize=1024)
def _mean_floats(weave: Weave, direction: Direction) -> tuple[float, float]:
    yarns = yarns_of(weave.interlacement())
    high = np.array([yarn.high for yarn in yarns if yarn.direction == direction])
    floats = np.count_nonzero(high & ~np.roll(high, 1, axis=1))  # high floats; as many low ones
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
    def floats_on(self) -> tuple[bool, ...]:
        """True where the yarn comes to its k-th crossing on the side it had at the one before.

        The crossing before the first is the last one, a period earlier.
        """
        return tuple(before == high for before, high in zip(self.high[-1:] + self.high[:-1], self.high))


def yarns_of(interlacement: np.ndarray) -> tuple[Yarn, ...]:
    """Every yarn of a cell, wefts first, from its interlacement matrix (wefts, warps)."""
    yarns = []
    for direction, high in ((Direction.WEFT, interlacement), (Direction.WARP, ~interlacement.T)):
        for index in range(len(high)):
            before, after = high[index - 1], high[(index + 1) % len(high)]
            yarns.append(
                Yarn(
                    direction=direction,
                    index=index,
                    high=tuple(high[index].tolist()),
                    turns_left=tuple((before != high[index]).tolist()),
                    turns_right=tuple((after != high[index]).tolist()),
                )
            )
    return tuple(yarns)
