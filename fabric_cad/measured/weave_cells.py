"""The weave cells of a table from their texts: whole numbers, or the pattern."""

from __future__ import annotations

from ..weave.faults import count_faults, pattern_of, satin_fault
from .cells import whole_number
from .columns import WEAVE_COLUMNS
from .refusals import Step
from .texts import TextRows

DROPPED_ZEROS = "; a spreadsheet drops the zeros a number starts with: write o and u for 1 and 0"


def read_weave_cells(family: str, table: TextRows) -> list[dict[str, object]]:
    """The weave cells of every row by column.

    None, or an empty pattern, where one is refused, and told.
    """
    if family == "pattern":
        return [{"pattern": _pattern(table, row, text)} for row, text in table.column("pattern")]

    rows: list[dict[str, object]] = []
    for row in range(len(table)):
        counts = {column: _count(table, row, column) for column in WEAVE_COLUMNS[family]}
        if family == "satin":
            _check_satin(table, row, counts["harness"], counts["step"])
        rows.append(dict(counts))
    return rows


def _count(table: TextRows, row: int, column: str) -> int | None:
    text = table.rows[row][column]
    if text is None:
        return None
    try:
        value = whole_number(text, table.separator)
    except ValueError as error:
        table.refusals.add(row, Step.CELL, str(error), column)
        return None

    faults = count_faults(value)
    for fault in faults:
        table.refusals.add(row, Step.CELL, fault, column)
    return None if faults else value


def _check_satin(table: TextRows, row: int, harness: int | None, step: int | None) -> None:
    if harness is None or step is None:
        return  # told already
    if fault := satin_fault(harness, step):
        column, message = fault
        table.refusals.add(row, Step.WEAVE, message, column)


def _pattern(table: TextRows, row: int, text: str | None) -> tuple[str, ...]:
    if text is None:
        return ()
    pattern, faults = pattern_of(text) if text else ((), ("this cell is empty",))

    digits, uneven = "0" in text or "1" in text, len(set(map(len, pattern))) > 1
    for fault in faults:
        table.refusals.add(
            row, Step.CELL, fault + (DROPPED_ZEROS if digits and uneven else ""), "pattern"
        )
    return pattern
