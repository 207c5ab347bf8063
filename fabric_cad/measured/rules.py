"""The rules of a row that need no model: what a rule is, and those of single columns, over whole tables of numbers.

The reader of the tables, rows from a script, a study's rows and the propagation of scatter all ask
the same rules. Those between a row's cells are in :mod:`~fabric_cad.measured.relations`, those of a
weave's cells in :mod:`~fabric_cad.weave.faults`; what a text must be to be a number is the reader's
own business (:mod:`~fabric_cad.measured.cells`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .columns import NUMBERS, SECTIONS
from .row_values import RowValues

_USUAL_SECTION = next(iter(SECTIONS))


@dataclass(frozen=True)
class Rule:
    """A rule of one column: where it is broken, and what to say of the value and the bound that it breaks.

    ``message`` may hold ``{value}``, ``{bound}`` and ``{section}``; ``broken`` and ``bound`` give
    arrays of shape (rows,).
    """

    column: str
    broken: Callable[[RowValues], np.ndarray]
    message: str
    bound: Callable[[RowValues], np.ndarray] | None = None

    def faults(
        self, rows: RowValues, shown: Callable[[int], str] | None = None
    ) -> list[tuple[int, str]]:
        """The number of every row that breaks it and what to say of it.

        ``shown(row)`` writes the row's value.
        """
        broken = np.flatnonzero(self.broken(rows)).tolist()
        if not broken:
            return []

        bounds = None if self.bound is None else self.bound(rows)
        values = rows.values.get(self.column)

        def told(row: int) -> str:
            value = shown(row) if shown else "" if values is None else f"{values[row]:g}"
            bound = None if bounds is None else bounds[row]
            return self.message.format(
                value=value, bound=bound, section=rows.sections[row] or _USUAL_SECTION
            )

        return [(row, told(row)) for row in broken]


def bound_fault(column: str, value: float) -> str | None:
    """What the bound of a column says of a value in the column's unit."""
    bound = NUMBERS[column].bound
    return f"{value:g} is {bound.word}" if bound.broken(value, 0) else None


def _bounded(column: str) -> Rule:
    bound = NUMBERS[column].bound
    return Rule(
        column, lambda rows: bound.broken(rows.values[column], 0), f"{{value}} is {bound.word}"
    )


BOUNDS = {column: _bounded(column) for column in NUMBERS}
"""The bound of every column of numbers, by the name it is written with."""


def _with_its_value(column: str) -> Rule:
    kept = NUMBERS[column].kept.removesuffix("_std")
    value = column.removesuffix("_std")
    return Rule(
        column,
        lambda rows: rows.filled[column] & ~rows.filled[kept],
        f"a standard deviation without its value; {value} is empty",
    )


SCATTER = {column: _with_its_value(column) for column in NUMBERS if column.endswith("_std")}
"""A standard deviation belongs to a measured value: a rule for every column of one, by the name it is written with."""
