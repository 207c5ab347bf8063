"""Lines of the table that ``fabric-cad validate`` prints: measured against model, and spreads."""

from __future__ import annotations

import math

from ..measured.tables import Family
from ..weave.directions import DIRECTIONS
from .scatter import Spread
from .solved import SolvedTable

_SHOWN = (  # label, quantity of a direction, factor
    ("crimp %", "crimp", 100.0),
    ("thickness mm", "thickness_mm", 1.0),
    ("amplitude mm", "amplitude_mm", 1.0),
    ("slope", "slope", 1.0),
)


def plus_minus(mean: float, std: float) -> str:
    """``0.3548 +- 0.0041``: the standard deviation in two digits, the mean to the same place.

    The mean alone, in four digits, where the standard deviation is NaN.
    """
    if math.isnan(std):
        return f"{mean:.4g}"
    if std <= 1e-12 * abs(mean):
        return f"{mean:.4g} +- 0"
    places = max(0, 1 - math.floor(math.log10(std)))
    return f"{mean:.{places}f} +- {std:.{places}f}"


def compared(measured: Family, solved: SolvedTable, spread: Spread) -> list[tuple[str, ...]]:
    """(row, quantity, measured, model, difference %) of all that was measured beyond need."""
    return [
        (
            name,
            quantity,
            plus_minus(value, measured.scatter[quantity][at]),
            plus_minus(model, spread.std[quantity][at]),
            f"{100 * (model - value) / value:+.2f}",
        )
        for at, name in enumerate(measured.names)
        for quantity, value, model in solved.comparisons[at]
    ]


def spread_out(measured: Family, spread: Spread) -> list[tuple[str, ...]]:
    """(row, quantity, weft, warp) as mean +- standard deviation, of rows that give any scatter."""

    def shown(column: str, at: int, factor: float = 1.0) -> str:
        return plus_minus(factor * spread.mean[column][at], factor * spread.std[column][at])

    lines = []
    for at, name in enumerate(measured.names):
        if measured.scattered[at]:
            for label, quantity, factor in _SHOWN:
                lines.append(
                    (name, label, *(shown(f"{d}_{quantity}", at, factor) for d in DIRECTIONS))
                )
            lines.append((name, "fabric thickness mm", shown("fabric_thickness_mm", at), ""))
    return lines
