"""The measured numbers of a table from its texts, held against the bounds of their columns."""

from __future__ import annotations

import numpy as np

from .cells import measurement, with_point
from .columns import MEASURED, NUMBERS, STD
from .refusals import Step
from .relations import relations
from .row_values import RowValues
from .rules import BOUNDS, SCATTER
from .texts import TextRows


def read_numbers(table: TextRows) -> RowValues:
    """The numbers of all rows by the column they are kept in; those refused are NaN, and told."""
    values = {column: np.full(len(table), np.nan) for column in (*MEASURED, *STD)}
    filled = {column: np.zeros(len(table), dtype=bool) for column in values}

    for column in (column for column in table.header if column in NUMBERS):
        kept, written = NUMBERS[column].kept, table.has_text(column)
        for row in np.flatnonzero(written & ~np.isnan(values[kept])).tolist():
            table.refusals.add(row, Step.CELL, "this quantity is given twice, in two units", column)

        values[kept] = np.where(written, _column(table, column), values[kept])
        filled[kept] |= table.is_filled(column)
    return RowValues(values, filled, [texts.get("section") or "" for texts in table.rows])


def _column(table: TextRows, column: str) -> np.ndarray:
    """The numbers of one column in the unit they are kept in, shape (rows,)."""
    numbers, written = np.full(len(table), np.nan), {}
    for row, text in table.column(column):
        if not text:
            continue
        written[row] = with_point(text, table.separator)
        try:
            numbers[row] = measurement(text, column, table.separator) * NUMBERS[column].factor
        except ValueError as error:
            table.refusals.add(row, Step.CELL, str(error), column)

    rows = RowValues({column: numbers}, {}, [""] * len(table))
    for row, message in BOUNDS[column].faults(rows, written.__getitem__):
        table.refusals.add(row, Step.CELL, message, column)
        numbers[row] = np.nan

    return numbers


def check_relations(table: TextRows, rows: RowValues) -> None:
    """Refuse rows for the rules between their cells."""
    scattered = [column for column in table.header if column in SCATTER]
    filled = {**rows.filled, **{column: table.has_text(column) for column in scattered}}
    with_scatter = RowValues(rows.values, filled, rows.sections)
    for column in scattered:
        for row, message in SCATTER[column].faults(with_scatter):
            table.refusals.add(row, Step.SCATTER, message, column)

    for rule in relations():
        for row, message in rule.faults(rows):
            table.refusals.add(row, Step.RELATION, message, rule.column)
