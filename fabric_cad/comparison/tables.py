"""A comparison as text."""

from __future__ import annotations

from collections.abc import Sequence

from .measures import Comparison

_COLUMNS = (
    ("penetration", "max mm", "max_penetration", 13, 4),
    ("overlap", "mm3", "overlap_volume", 10, 3),
    ("overlap", "% yarn", "overlap_percent", 10, 2),
    ("contact", "% area", "contact_percent", 10, 1),
    ("void", "mm3", "void_volume", 10, 3),
    ("mean void", "mm", "mean_void", 11, 4),
)
"""Heading, unit, attribute of a comparison, width, decimals."""


def comparison_table(results: Sequence[Comparison]) -> str:
    """The results as plain text, one model a line."""
    headings = "".join(f"{heading:>{width}}" for heading, _, _, width, _ in _COLUMNS)
    units = "".join(f"{unit:>{width}}" for _, unit, _, width, _ in _COLUMNS)
    lines = [f"{'':24}{headings}", f"{'':24}{units}"]

    for result in results:
        line = f"{result.model:24}"
        for _, _, attribute, width, decimals in _COLUMNS:
            line += f"{_short(getattr(result, attribute), decimals):>{width}}"
        lines.append(line)

    return "\n".join(lines)


def _short(value: float, decimals: int) -> str:
    """A number with so many decimals, or as a power of ten where these would hide it."""
    if value >= 10.0**-decimals:
        return f"{value:.{decimals}f}"
    return f"{value:.0e}" if value else "0"
