"""What makes something no weave: the one place of these rules, for weaves, tables and drafts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from math import gcd

import numpy as np

from ..support.errors import quoted
from .patterns import read_pattern

MOST_YARNS = 100
"""Largest float or harness a table may ask for, and most wefts or warps of a pattern."""

Fault = tuple[str, str]
"""A column and what is wrong with its cell."""


# Numbers


def count_faults(value: int) -> tuple[str, ...]:
    """What is wrong with a number of yarns, a harness or a step on its own."""
    return () if 1 <= value <= MOST_YARNS else (f"{value} is not between 1 and {MOST_YARNS}",)


def regular_fault(over: int, under: int, step: int) -> str | None:
    """What makes floats and a step no regular weave: some yarn would never change sides."""
    if over < 1 or under < 1:
        return f"a yarn passes over and under at least one yarn, got {over}*{under}"
    if gcd(step, over + under) != 1:
        return f"step {step} is not coprime to {over + under}"
    return None


def satin_fault(harness: int, step: int) -> Fault | None:
    """What makes a harness and a step no satin (paper, section 1.1)."""
    if harness < 3:
        return "harness", f"{harness} is not at least 3"
    if step >= harness:
        return "step", f"{step} is not below the harness {harness}"
    if gcd(harness, step) != 1:
        return "step", f"{step} is not coprime to the harness {harness}"
    return None


# Patterns


def pattern_of(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The pattern of a text, and its faults.

    () for a pattern where it cannot be read or has no size that one may have.
    """
    try:
        pattern = read_pattern(text)
    except ValueError as error:
        return (), (str(error),)

    if fault := _size_fault(text, pattern):
        return (), (fault,)
    return pattern, pattern_faults(pattern)


def _size_fault(text: str, pattern: Sequence[str]) -> str | None:
    """What is wrong with the numbers of wefts and warps of a pattern, 2 to MOST_YARNS of either."""
    if not pattern:
        return "this cell is empty"
    if len(pattern) == 1:
        return f"{quoted(text)} is one weft only; part the wefts by a space, / or |"

    wefts, warps = len(pattern), max(map(len, pattern))
    if max(wefts, warps) > MOST_YARNS:
        return f"{wefts} wefts x {warps} warps are more than {MOST_YARNS} in a direction"
    return None


def repeat_fault(pattern: Sequence[str]) -> str | None:
    """What is wrong with the size of a draft's repeat."""
    wefts, warps = len(pattern), len(pattern[0])
    if max(wefts, warps) <= MOST_YARNS:
        return None
    size = f"{wefts} wefts x {warps} warps"
    return f"its repeat of {size} is more than {MOST_YARNS} in a direction"


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

    weft_over_warp = np.array([[mark == "1" for mark in row] for row in pattern])
    return tuple(_idle(weft_over_warp)) or tuple(_separate_layers(weft_over_warp))


def _idle(weft_over_warp: np.ndarray) -> Iterator[str]:
    """A text for every yarn that never changes sides; the matrix is (wefts, warps)."""
    for name, yarns in (("weft", weft_over_warp), ("warp", ~weft_over_warp.T)):
        for number, over in enumerate(yarns, start=1):
            if over.all() or not over.any():
                side = "over" if over[0] else "under"
                yield f"{name} {number} passes {side} every yarn and never interlaces"


def _separate_layers(weft_over_warp: np.ndarray) -> Iterator[str]:
    """A text where some yarns lie wholly under the others: nothing holds the fabric together."""
    for side, over in (("under", weft_over_warp), ("over", ~weft_over_warp)):
        wefts, warps = _reached(over)
        if not (wefts.all() and warps.all()):
            names = " and ".join(
                f"{name} {', '.join(map(str, np.flatnonzero(yarns) + 1))}"
                for name, yarns in (("weft", wefts), ("warp", warps))
            )
            layers = "the weave falls into separate layers"
            yield f"{names} lie {side} all other yarns: {layers}"
            return


def _reached(over: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The wefts and warps, (yarns,) bool, that lie below the first weft, or below one that does.

    ``over`` (wefts, warps) is True where the weft passes over the warp.
    """
    wefts, warps = np.zeros(len(over), dtype=bool), np.zeros(over.shape[1], dtype=bool)
    wefts[0] = True
    before, reached = 0, 1
    while reached > before:
        warps |= over[wefts].any(axis=0)
        wefts |= ~over[:, warps].all(axis=1)
        before, reached = reached, int(np.count_nonzero(wefts) + np.count_nonzero(warps))
    return wefts, warps


# Rows


def weave_fault(family: str, cells: Mapping) -> Fault | None:
    """The first fault of the weave cells of a family's row.

    Cells are whole numbers, or the pattern as a text.
    """
    if family == "pattern":
        _, faults = pattern_of(str(cells["pattern"]))
        return ("pattern", faults[0]) if faults else None

    for column, value in cells.items():
        for fault in count_faults(value):
            return column, fault
    return satin_fault(cells["harness"], cells["step"]) if family == "satin" else None
