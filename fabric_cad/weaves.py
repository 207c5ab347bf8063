"""Interlacement of two-direction weaves: which yarn lies on top at every crossing."""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import numpy as np

FAMILIES = ("plain", "twill", "satin")
"""The weave types; each has one table ``<family>.csv`` and one master."""

DIRECTIONS = ("weft", "warp")


@dataclass(frozen=True)
class Weave:
    """A twill-like weave: every weft passes over ``over`` warps, then under ``under``.

    Each weft repeats the one before it ``step`` warps further on, so that the elementary
    cell holds ``over + under`` yarns of either direction. Plain is 1*1, a twill m*n has
    step 1, a satin of N harnesses is 1*(N-1) with a step coprime to N (paper, section 1.1).
    """

    over: int
    under: int
    step: int = 1

    def __post_init__(self) -> None:
        if self.over < 1 or self.under < 1:
            raise ValueError(f"a yarn passes over and under at least one yarn, got {self.over}*{self.under}")
        if gcd(self.step, self.repeat) != 1:
            raise ValueError(f"step {self.step} is not coprime to {self.repeat}")

    @property
    def repeat(self) -> int:
        """Yarns of either direction in the elementary cell."""
        return self.over + self.under

    def interlacement(self) -> np.ndarray:
        """Boolean matrix, shape (wefts, warps): True where the weft passes over the warp."""
        wefts, warps = np.ogrid[: self.repeat, : self.repeat]
        return (warps - self.step * wefts) % self.repeat < self.over


def weave_of(family: str, numbers: dict[str, int]) -> Weave:
    """The weave of one row of a family table, from its weave columns (empty for plain)."""
    if family == "plain":
        return Weave(1, 1)
    if family == "twill":
        return Weave(numbers["over"], numbers["under"])
    return Weave(1, numbers["harness"] - 1, numbers["step"])


@dataclass(frozen=True)
class Yarn:
    """One yarn of the elementary cell and what it meets, crossing by crossing.

    ``high[k]`` is True where the yarn passes over the k-th yarn it crosses;
    ``turns_left[k]`` and ``turns_right[k]`` are True where that crossed yarn changes its
    side of the fabric just left (smaller v) and right of this yarn, and False where it
    continues its float there.
    """

    name: str
    direction: str
    index: int
    high: tuple[bool, ...]
    turns_left: tuple[bool, ...]
    turns_right: tuple[bool, ...]


def yarns_of(interlacement: np.ndarray) -> tuple[Yarn, ...]:
    """Every yarn of a cell, wefts first, from its interlacement matrix (wefts, warps)."""
    yarns = []
    for direction, high in (("weft", interlacement), ("warp", ~interlacement.T)):
        for index in range(len(high)):
            before, after = high[index - 1], high[(index + 1) % len(high)]
            yarns.append(
                Yarn(
                    name=f"{direction}_{index + 1}",
                    direction=direction,
                    index=index,
                    high=tuple(high[index].tolist()),
                    turns_left=tuple((before != high[index]).tolist()),
                    turns_right=tuple((after != high[index]).tolist()),
                )
            )
    return tuple(yarns)
