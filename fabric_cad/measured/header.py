"""The header of a family table: which columns it may have, must have, and where they stand in a sheet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..support.errors import InputError, Place, Problem, did_you_mean
from .columns import OTHER_UNITS, known_columns, needed_columns
from .records import Records


def read_header(family: str, records: Records) -> tuple[list[str], Place]:
    """The columns of a table and its place, which knows their letters in a sheet.

    Raises :class:`InputError` where there is no header or something is wrong with it.
    """
    if not records.lines:
        raise InputError(records.place.problem("the table is empty: no header line"))

    first = records.lines[0]
    header = list(first.cells)
    while header and not header[-1]:
        header.pop()

    place = _with_letters(records.place, header)
    if problems := _header_problems(family, header, place, first.line):
        raise InputError(problems)
    return header, place


def _header_problems(
    family: str, header: Sequence[str], place: Place, line: int | None
) -> list[Problem]:
    """What is wrong with a header: unknown, repeated and missing columns."""
    known = known_columns(family)
    problems = []

    for column in header:
        if column not in known:
            hint = did_you_mean(column.lower(), known, cutoff=0.3)
            problems.append(
                place.problem(f"unknown column of {family}.csv{hint}", line, column or "(empty)")
            )
        elif header.count(column) > 1:
            problems.append(place.problem("this column stands twice in the header", line, column))

    for column in needed_columns(family):
        written = [column, *(other for other, (kept, _) in OTHER_UNITS.items() if kept == column)]
        if not any(name in header for name in written):
            problems.append(place.problem("this column is missing", line, column))

    return list(dict.fromkeys(problems))


def _with_letters(place: Place, header: Sequence[str]) -> Place:
    """The place with the letters of a sheet's columns, also under the name a quantity is kept in."""
    if place.sheet is None:
        return place
    from .workbooks import letters_of

    letters = {column: letters_of(number) for number, column in enumerate(header)}
    kept = {
        OTHER_UNITS[column][0]: letter
        for column, letter in letters.items()
        if column in OTHER_UNITS
    }
    return replace(place, letters=kept | letters)
