"""The text of a CSV with one row added or changed in it: separator, line ends and quoting are the file's own."""

from __future__ import annotations

import csv
import io
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ..measured.columns import NUMBERS, kept_column
from ..measured.records import Records, read_csv
from ..support.errors import InputError, Problem
from .edited import DEFAULTS, EditedRow

_ENDING = re.compile(r"\r\n|\r|\n")


def with_row(row: EditedRow, before: bytes, path: Path) -> tuple[str, tuple[str, ...]]:
    """The text of the table with the row, and the columns that were added."""
    try:
        text = before.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(
            Problem("not UTF-8 text; save the table as 'CSV UTF-8'", str(path))
        ) from error

    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / path.name
        copy.write_bytes(before)
        records = read_csv(copy)

    lines = _lines(text)
    ending = next((found[0] for line in lines if (found := _ENDING.search(line))), "\n")

    header = _without_blank_end(records.lines[0].cells)
    added = tuple(column for column in row.cells if column not in map(_kept, header))
    if added:
        first = (records.lines[0].line or 1) - 1
        last = first + _length(lines, first, records.separator) - 1
        body = lines[last].rstrip("\r\n")
        named = _csv_line(added, records.separator)
        lines[last] = (
            f"{body.rstrip(f' {records.separator}')}{records.separator}{named}{lines[last][len(body) :]}"
        )
        header = (*header, *added)

    own = next(
        (
            line
            for line in records.lines[1:]
            if _name(line.cells, header).lower() == row.name.lower()
        ),
        None,
    )
    if own is None or own.line is None:
        if lines and not lines[-1].endswith(("\n", "\r")):
            lines[-1] += ending
        return "".join(
            [*lines, _csv_line(_cells(row, header, records, ()), records.separator), ending]
        ), added

    first, count = own.line - 1, _length(lines, own.line - 1, records.separator)
    end = _ENDING.search(lines[first + count - 1])
    written = _csv_line(_cells(row, header, records, own.cells), records.separator)
    lines[first : first + count] = [written + (end[0] if end else "")]
    return "".join(lines), added


def _cells(
    row: EditedRow, header: Sequence[str], records: Records, former: Sequence[str]
) -> list[str]:
    """The row's texts under a header.

    A cell that says the same as its former text is left as it was written.
    """
    comma = records.separator == ";"
    cells = []

    for place, column in enumerate(header):
        kept, factor = kept_column(column)
        old, new = former[place] if place < len(former) else "", row.cells.get(kept, "")
        if new and kept in NUMBERS and factor != 1.0:
            new = f"{float(new) / factor:.12g}"
        is_default = not new and old == DEFAULTS.get(column)
        if not is_default and not is_same(old, new, comma):
            old = new.replace(".", ",") if comma and kept in NUMBERS else new
        cells.append(old)

    return cells


def is_same(old: str, new: str, comma: bool) -> bool:
    """Whether two texts of a cell are one text, or one number."""
    if old == new:
        return True
    try:
        numbers = [float(text.replace(",", ".") if comma else text) for text in (old, new)]
    except ValueError:
        return False
    return abs(numbers[0] - numbers[1]) <= 1e-11 * abs(numbers[0])


def _lines(text: str) -> list[str]:
    """Lines with their endings.

    Those of the strict reader, which knows no others than these three.
    """
    ends = [found.end() for found in _ENDING.finditer(text)]
    return [line for line in (text[a:b] for a, b in zip([0, *ends], [*ends, len(text)])) if line]


def _length(lines: Sequence[str], first: int, separator: str) -> int:
    """How many lines a record takes, whose quoted cells may hold line breaks."""
    reader = csv.reader(
        (_ENDING.sub("\n", line) for line in lines[first:]),
        delimiter=separator,
        skipinitialspace=True,
    )
    next(reader)
    return reader.line_num


def _csv_line(cells: Sequence[str], separator: str) -> str:
    text = io.StringIO()
    csv.writer(text, delimiter=separator, lineterminator="").writerow(cells)
    return text.getvalue().rstrip(separator) if cells[-1:] == [""] else text.getvalue()


def _name(cells: Sequence[str], header: Sequence[str]) -> str:
    place = header.index("name")
    return cells[place] if place < len(cells) else ""


def _kept(column: str) -> str:
    return kept_column(column)[0]


def _without_blank_end(cells: tuple[str, ...]) -> tuple[str, ...]:
    while cells and not cells[-1]:
        cells = cells[:-1]
    return cells
