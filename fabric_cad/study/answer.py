"""What a study found, in a few lines for a person: which factors its figures depend on, and why units gave none."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from .sensitivity import Row

_MOST = 6
"""Most factors named of a figure, and most reasons."""

_HEADS = {
    "sobol": ("total index (95 %)", "first-order index (95 %)"),
    "one-at-a-time": ("elasticity", "change"),
    "grid": ("rank correlation", "p-value"),
    "latin-hypercube": ("rank correlation", "p-value"),
}


def answer_lines(design: str, rows: Sequence[Row]) -> list[str]:
    """A table of the rows of ``sensitivity.csv``: the factors of every figure, the one that matters most first."""
    if not rows:
        return []
    table: list[tuple[str, ...]] = [("", *_HEADS[design])]
    for figure in dict.fromkeys(str(row["figure"]) for row in rows):
        ranked = sorted((row for row in rows if row["figure"] == figure), key=_weight, reverse=True)
        table.append((f"{figure} depends on",))
        table += [_cells(design, row) for row in ranked[:_MOST]]
        if len(ranked) > _MOST:
            table.append((f"  and {len(ranked) - _MOST} more, see sensitivity.csv",))

    full = [line for line in table if len(line) > 1]
    widths = [max(map(len, column)) for column in zip(*full)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in table
    ]


def _weight(row: Mapping) -> float:
    """What a row ranks by."""
    for name in ("total", "spearman", "elasticity", "change"):
        if _known(row.get(name)):
            return abs(row[name])
    return 0.0


def _known(value: object) -> bool:
    return isinstance(value, float) and value == value


def _cells(design: str, row: Mapping) -> tuple[str, str, str]:
    factor = f"  {row['factor']}"
    if design == "sobol":
        return factor, _interval(row, "total"), _interval(row, "first_order")
    if design != "one-at-a-time":
        return (
            factor,
            f"{row['spearman']:+.2f}",
            f"{row['p_value']:.1g}" if row["p_value"] else "below 1e-300",
        )

    if _known(row.get("figure_value")):  # a factor of texts has a row a value
        return f"{factor} = {row['value']}", "", f"figure {row['figure_value']:.5g}"

    elasticity = f"{row['elasticity']:+.2f}" if _known(row.get("elasticity")) else ""
    ends = f"{row['figure_at_low']:.5g} to {row['figure_at_high']:.5g}"
    return (
        factor,
        elasticity,
        f"{row['change']:+.3g} ({ends}) over {row['low']:.4g} to {row['high']:.4g}",
    )


def _interval(row: Mapping, name: str) -> str:
    return f"{row[name]:.2f} ({row[f'{name}_low']:.2f} to {row[f'{name}_high']:.2f})"


def reasons_lines(reasons: Iterable[tuple[str, str]]) -> list[str]:
    """Lines that count the (status, reason) of refused and failed units.

    Reasons that differ in numbers are one.
    """
    kinds: dict[tuple[str, str], list[str]] = {}
    for status, reason in reasons:
        kinds.setdefault((status, re.sub(r"\d[\d.]*(e[+-]?\d+)?", "#", reason)), []).append(reason)

    counted = sorted(kinds.items(), key=lambda kind: -len(kind[1]))
    lines = []
    for (status, _), same in counted[:_MOST]:
        such_as = ", such as" if len(set(same)) > 1 else ""
        lines.append(f"  {len(same)} {status}{such_as}: {same[0]}")

    if len(counted) > _MOST:
        left = sum(len(same) for _, same in counted[_MOST:])
        lines.append(f"  {left} for {len(counted) - _MOST} other reasons, see table.csv")

    return lines
