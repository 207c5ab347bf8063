"""What makes the weave cells of a row no weave: the one place of these rules, for tables, drafts and studies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import gcd

from .patterns import read_pattern, size_fault
from .weaves import pattern_faults

MOST_YARNS = 100
"""Largest float or harness a table may ask for, and most wefts or warps of a pattern."""

Fault = tuple[str, str]
"""A column and what is wrong with its cell."""


def count_faults(value: int) -> tuple[str, ...]:
    """What is wrong with a number of yarns, a harness or a step on its own."""
    return () if 1 <= value <= MOST_YARNS else (f"{value} is not between 1 and {MOST_YARNS}",)


def pattern_of(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The pattern of a text, () where it cannot be read or has no size a pattern may have, and its faults."""
    try:
        pattern = read_pattern(text)
    except ValueError as error:
        return (), (str(error),)
    if fault := size_fault(text, pattern, MOST_YARNS):
        return (), (fault,)
    return pattern, pattern_faults(pattern)


def repeat_fault(pattern: Sequence[str]) -> str | None:
    """What is wrong with the size of a draft's repeat."""
    wefts, warps = len(pattern), len(pattern[0])
    if max(wefts, warps) <= MOST_YARNS:
        return None
    return f"its repeat of {wefts} wefts x {warps} warps is more than {MOST_YARNS} in a direction"


def satin_fault(harness: int, step: int) -> Fault | None:
    """What makes a harness and a step no satin (paper, section 1.1)."""
    if harness < 3:
        return "harness", f"{harness} is not at least 3"
    if step >= harness:
        return "step", f"{step} is not below the harness {harness}"
    if gcd(harness, step) != 1:
        return "step", f"{step} is not coprime to the harness {harness}"
    return None


def weave_fault(family: str, cells: Mapping) -> Fault | None:
    """The first fault of the weave cells of a family's row: whole numbers, or the pattern as a text."""
    if family == "pattern":
        _, faults = pattern_of(str(cells["pattern"]))
        return ("pattern", faults[0]) if faults else None

    for column, value in cells.items():
        for fault in count_faults(value):
            return column, fault
    return satin_fault(cells["harness"], cells["step"]) if family == "satin" else None
