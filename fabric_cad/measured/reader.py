"""From the lines of a family table to its values, or to all that is wrong with them.

Texts are read cell by cell (:mod:`~fabric_cad.measured.cells`), and what they say is held against
the rules of a row (:mod:`~fabric_cad.measured.rules`) for all rows at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..support.errors import Place, quoted
from ..weave.weaves import weave_of
from .cells import sheet_fault, width_fault
from .columns import CHOICES, FLOAT_GAPS, MEASURED, SECTIONS, STD, is_safe_name
from .family import Family
from .header import read_header
from .numbers import check_relations, read_numbers
from .records import Record, Records
from .refusals import Refusals, Step
from .row_values import RowValues
from .texts import TextRows, Texts
from .weave_cells import read_weave_cells


def table_of(family: str, records: Records) -> Family:
    """The table of the lines of a file. Raises :class:`InputError` where its header is wrong."""
    header, place = read_header(family, records)
    return read_rows(family, header, place, records.lines[1:], records.separator)


def read_rows(
    family: str, header: Sequence[str], place: Place, records: Sequence[Record], separator: str = ""
) -> Family:
    """The table of the lines under a header.

    What is wrong with those left out is in its ``refused``.
    """
    blank = [""] * len(header)
    cells = [dict(zip(header, [*record.cells, *blank])) for record in records]
    names = [row["name"] for row in cells]
    refusals = Refusals(place, records, names, header)

    for row, record in enumerate(records):
        if fault := width_fault(record, header, separator):
            refusals.close(row, fault)

    _check_names(names, records, refusals)

    sound = [
        _without_sheet_faults(row, record, cells[row], refusals)
        for row, record in enumerate(records)
    ]
    table = TextRows(header, separator, sound, refusals)
    values = read_numbers(table)
    weaves = read_weave_cells(family, table)
    _check_choices(table)
    check_relations(table, values)

    return _sound_rows(family, table, values, weaves)


def _check_names(names: Sequence[str], records: Sequence[Record], refusals: Refusals) -> None:
    """Every row has a name of its own that may name a file."""
    word = "row" if refusals.place.sheet else "line"
    seen: dict[str, int | None] = {}

    for row, (name, record) in enumerate(zip(names, records)):
        if row in refusals.closed:
            continue
        if not name:
            refusals.add(row, Step.NAME, "the row has no name", "name", named=False)
        elif not is_safe_name(name):
            message = (
                f"{quoted(name)} is no safe file name: letters, digits, '_' and '-' only, not '-' first, "
                "at most 80 characters, and no name a system keeps for itself"
            )
            refusals.add(row, Step.NAME, message, "name", named=False)
        elif name.lower() in seen:
            refusals.add(
                row, Step.NAME, f"this row name is also at {word} {seen[name.lower()]}", "name"
            )

        seen.setdefault(name.lower(), record.line)


def _without_sheet_faults(
    row: int, record: Record, cells: Mapping[str, str], refusals: Refusals
) -> Texts:
    """The texts of a row, None in place of a cell of a workbook that is refused for what it is."""
    texts: Texts = dict(cells)
    for place, column in enumerate(cells):
        if fault := sheet_fault(record, place, column, cells[column]):
            refusals.add(row, Step.SHEET, fault, column)
            texts[column] = None
    return texts


def _check_choices(table: TextRows) -> None:
    for column, choices in CHOICES.items():
        for row, text in table.column(column):
            if text and text not in choices:
                message = f"{quoted(text)} is none of {', '.join(choices)}"
                table.refusals.add(row, Step.CHOICE, message, column)


def _sound_rows(
    family: str, table: TextRows, rows: RowValues, weaves: Sequence[Mapping[str, object]]
) -> Family:
    """The table of the rows that nothing is wrong with; a name that stands twice is no row's."""
    refusals, refused = table.refusals, table.refusals.told()
    twice = {(problem.row or "").lower() for problem in refused if problem.column == "name"}
    wrong = refusals.rows | {
        row for row, name in enumerate(refusals.names) if name.lower() in twice
    }
    kept = [row for row in range(len(table)) if row not in wrong]

    def texts(column: str, default: str = "") -> tuple[str, ...]:
        return tuple(table.rows[row].get(column) or default for row in kept)

    return Family(
        family=family,
        place=refusals.place,
        names=texts("name"),
        lines=tuple(refusals.records[row].line for row in kept),
        weaves=tuple(weave_of(family, weaves[row]) for row in kept),
        measured={column: rows.values[column][kept] for column in MEASURED},
        scatter={column: rows.values[std][kept] for column, std in zip(MEASURED, STD)},
        sections=texts("section", next(iter(SECTIONS))),
        float_gaps=texts("float_gap", FLOAT_GAPS[0]),
        thicker=texts("thicker"),
        sources=texts("source"),
        notes=texts("notes"),
        refused=refused,
    )
