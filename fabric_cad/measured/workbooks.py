"""Workbooks (``.xlsx``, ``.ods``) as tables of texts, through python-calamine."""

from __future__ import annotations

import datetime
import io
import string
from collections.abc import Sequence
from pathlib import Path

from ..support.errors import InputError, Place, Problem, read_input
from .records import Record, Records
from .workbook_scan import READING_ERRORS, Sheet, scan_workbook

_OLD = b"\xd0\xcf\x11\xe0"  # of an OLE file, which an encrypted workbook is too
_ENCRYPTED = "the workbook is protected by a password; save it without one"


def read_workbook(path: Path) -> Records:
    """The one filled sheet of a workbook; formulas count with the value the spreadsheet stored.

    Numbers are taken as they are, in no language's decimal mark. Raises :class:`InputError` where
    the file is no workbook, is protected, unpacks to more than a family table can be, or has more
    than one sheet with something in it.
    """
    raw = read_input(path)
    if raw.startswith(_OLD):
        message = "an old workbook (.xls), or one protected by a password; save it as .xlsx or .ods without one"
        raise InputError(Problem(message, str(path)))

    scanned = scan_workbook(raw, str(path))
    grids = {
        name: grid
        for name, grid in _grids(raw, path).items()
        if _is_filled(grid, scanned.get(name))
    }
    if len(grids) > 1:
        names = ", ".join(map(repr, grids))
        raise InputError(
            Problem(f"only one sheet may hold something, and {len(grids)} do: {names}", str(path))
        )

    for name, grid in grids.items():
        return Records(Place(str(path), name), tuple(_records(grid, scanned.get(name, Sheet()))))
    return Records(Place(str(path)), ())


def letters_of(column: int) -> str:
    """What a spreadsheet calls the column of a number from 0: A ... Z, AA, AB ..."""
    name = ""
    column += 1
    while column:
        column, letter = divmod(column - 1, 26)
        name = string.ascii_uppercase[letter] + name
    return name


def _grids(raw: bytes, path: Path) -> dict[str, list[list]]:
    """The values of every sheet by name, row by row from cell A1."""
    import python_calamine as calamine

    try:
        book = calamine.CalamineWorkbook.from_filelike(io.BytesIO(raw))
        names = [
            sheet.name
            for sheet in book.sheets_metadata
            if sheet.typ == calamine.SheetTypeEnum.WorkSheet
        ]
        return {
            name: book.get_sheet_by_name(name).to_python(skip_empty_area=False) for name in names
        }
    except calamine.PasswordError as error:
        raise InputError(Problem(_ENCRYPTED, str(path))) from error
    except (calamine.CalamineError, *READING_ERRORS) as error:
        raise InputError(Problem(f"cannot be read as a workbook: {error}", str(path))) from error
    except BaseException as error:
        if (
            type(error).__name__ != "PanicException"
        ):  # the reader's own, in no module to import it from
            raise

        raise InputError(Problem(f"cannot be read as a workbook: {error}", str(path))) from error


def _is_filled(grid: Sequence[Sequence], sheet: Sheet | None) -> bool:
    return any(value != "" for row in grid for value in row) or bool(sheet and sheet.faults)


def _records(grid: Sequence[Sequence], sheet: Sheet):
    """Lines of a sheet that hold something, comments left out."""
    for row in range(max([len(grid), *(row + 1 for row, _ in sheet.faults)])):
        values = list(grid[row]) if row < len(grid) else []
        faults = {column: fault for (place, column), fault in sheet.faults.items() if place == row}
        values += [""] * (max(faults, default=-1) + 1 - len(values))
        texts = tuple(_text(value) for value in values)
        if not (any(texts) or faults) or (texts and texts[0].startswith("#")):
            continue

        faults |= {column: fault for column, value in enumerate(values) if (fault := _fault(value))}
        merged = {column: fault for (place, column), fault in sheet.merged.items() if place == row}
        numbers = frozenset(column for column, value in enumerate(values) if _is_number(value))
        percents = frozenset(column for place, column in sheet.percents if place == row)
        yield Record(row + 1, texts, faults, merged, numbers, percents)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _text(value: object) -> str:
    """A cell as the text that a CSV table would have."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return repr(value) if _is_number(value) else str(value).strip()


def _fault(value: object) -> str | None:
    """What a cell is that is no text and no number."""
    if isinstance(value, bool):
        return f"{str(value).upper()} is a truth value; enter a number or a text"
    if isinstance(value, (datetime.date, datetime.time, datetime.timedelta)):
        kind = "date" if isinstance(value, datetime.date) else "time"
        return (
            f"{value} is a {kind}, which spreadsheets make of numbers and patterns as they are typed; "
            "give the cell the format text (for a pattern) or number, and enter it again"
        )
    return None
