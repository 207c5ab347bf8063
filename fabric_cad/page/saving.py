"""A row saved into the CSV that is edited otherwise: that row added or changed, every other byte as it was."""

from __future__ import annotations

import csv
import io
import os
import re
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..measured.columns import NUMBERS, kept_column, needed_columns
from ..measured.family import Family
from ..measured.records import Records, read_csv
from ..measured.table_files import table_files
from ..measured.tables import read_families, read_family
from ..support.errors import InputError, OutputError, Problem, read_input
from .edited import DEFAULTS, EditedRow, edited

_BOM = b"\xef\xbb\xbf"
_ENDING = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True)
class Saved:
    """Where a row was saved: the table, whether it took the place of one, and columns the header got for it."""

    path: Path
    replaced: bool
    added: tuple[str, ...]


class RowExistsError(InputError):
    """A row of that name is there already, and was not to be replaced."""


def save_row(row: EditedRow, families: str | Path, replace: bool = False) -> Saved:
    """Add a row to the CSV of its family in a folder, or with ``replace`` change the one of its name.

    Columns that the table does not have yet are added at the end of its header; a table that is not there is
    begun. What would be written is first read by the strict reader: raises :class:`InputError` with the
    problems of the row, or where its name is taken (:class:`RowExistsError`, in this table), or where the
    table is a workbook or not UTF-8; :class:`OutputError` where it cannot be written. The file is exchanged
    in one step, or as it was.
    """
    path = _table(row, Path(families))
    before = read_input(path) if path.exists() else _begun(row)
    replaced = _is_taken(row, Path(families), replace)
    text, added = _written(row, before, path)
    encoded = (_BOM if before.startswith(_BOM) else b"") + text.encode("utf-8")

    _check(row, encoded, path.name)
    _exchange(path, encoded)
    return Saved(path, replaced, added)


def _table(row: EditedRow, families: Path) -> Path:
    files = table_files(families).get(row.family, []) if families.is_dir() else []
    if len(files) > 1 or files and files[0].suffix != ".csv":
        message = "rows are saved into text tables only; save this one as CSV, and keep one of its kind"
        raise InputError(Problem(message, str(files[0])))

    path = files[0] if files else families / f"{row.family}.csv"
    if path.is_symlink():
        raise OutputError(f"{path}: is a link to {os.readlink(path)}, and is not written through")
    return path


def _begun(row: EditedRow) -> bytes:
    """The header of a new table for a row."""
    return (",".join(dict.fromkeys([*needed_columns(row.family), *row.cells])) + "\n").encode()


def _is_taken(row: EditedRow, families: Path, replace: bool) -> bool:
    """Whether the table has a row of that name, to be replaced. Raises where it may not be, or another has it."""
    if not families.is_dir() or not table_files(families):
        return False

    taken = False
    for family, table in read_families(families, partial=True).items():
        if not isinstance(table, Family):
            if family == row.family:
                raise table
            continue
        names = {*table.names, *(problem.row or "" for problem in table.refused)}
        if row.name.lower() not in {name.lower() for name in names}:
            continue
        if family != row.family:
            raise InputError(Problem(f"this row name is in {family}.csv; choose another", column="name", row=row.name))
        if not replace:
            message = "a row of this name is there already; replace it, or choose another name"
            raise RowExistsError(Problem(message, table.path, column="name", row=row.name))
        taken = True
    return taken


def _written(row: EditedRow, before: bytes, path: Path) -> tuple[str, tuple[str, ...]]:
    """The text of the table with the row, and the columns that were added."""
    try:
        text = before.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(Problem("not UTF-8 text; save the table as 'CSV UTF-8'", str(path))) from error

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
        lines[last] = f"{body.rstrip()}{records.separator}{named}{lines[last][len(body) :]}"
        header = (*header, *added)

    own = next((line for line in records.lines[1:] if _name(line.cells, header).lower() == row.name.lower()), None)
    if own is None or own.line is None:
        if lines and not lines[-1].endswith(("\n", "\r")):
            lines[-1] += ending
        return "".join([*lines, _csv_line(_cells(row, header, records, ()), records.separator), ending]), added

    first, count = own.line - 1, _length(lines, own.line - 1, records.separator)
    end = _ENDING.search(lines[first + count - 1])
    written = _csv_line(_cells(row, header, records, own.cells), records.separator)
    lines[first : first + count] = [written + (end[0] if end else "")]
    return "".join(lines), added


def _cells(row: EditedRow, header: Sequence[str], records: Records, former: Sequence[str]) -> list[str]:
    """The row's texts under a header; a cell that says the same as its former text is left as it was written."""
    comma = records.separator == ";"
    cells = []
    for place, column in enumerate(header):
        kept, factor = kept_column(column)
        old, new = former[place] if place < len(former) else "", row.cells.get(kept, "")
        if new and kept in NUMBERS and factor != 1.0:
            new = f"{float(new) / factor:.12g}"
        is_default = not new and old == DEFAULTS.get(column)
        if not is_default and not _same(old, new, comma):
            old = new.replace(".", ",") if comma and kept in NUMBERS else new
        cells.append(old)
    return cells


def _same(old: str, new: str, comma: bool) -> bool:
    """Whether two texts of a cell are one text, or one number."""
    if old == new:
        return True
    try:
        numbers = [float(text.replace(",", ".") if comma else text) for text in (old, new)]
    except ValueError:
        return False
    return abs(numbers[0] - numbers[1]) <= 1e-11 * abs(numbers[0])


def _lines(text: str) -> list[str]:
    """Lines with their endings; those of the strict reader, which knows no others than these three."""
    ends = [found.end() for found in _ENDING.finditer(text)]
    return [line for line in (text[a:b] for a, b in zip([0, *ends], [*ends, len(text)])) if line]


def _length(lines: Sequence[str], first: int, separator: str) -> int:
    """How many lines a record takes, whose quoted cells may hold line breaks."""
    reader = csv.reader((_ENDING.sub("\n", line) for line in lines[first:]), delimiter=separator, skipinitialspace=True)
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


def _check(row: EditedRow, encoded: bytes, name: str) -> None:
    """Read what would be written, strictly: the row must be in it and say what it was to say."""
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / name
        copy.write_bytes(encoded)
        table = read_family(copy, partial=True)

    problems = [problem for problem in table.refused if (problem.row or "").lower() == row.name.lower()]
    problems += [problem for problem in table.refused if problem.column == "name" and not problem.row]
    if row.name not in table:
        told = problems or [Problem("the row has no name", column="name")]
        raise InputError([Problem(problem.message, column=problem.column, row=row.name) for problem in told])

    back, given = edited(table[row.name]), row
    for column in {*back.cells, *given.cells}:
        if not _same(back.cells.get(column, ""), given.cells.get(column, ""), comma=False):
            raise InputError(Problem("this cell would not be read back as it was written", column=column))


def _exchange(path: Path, encoded: bytes) -> None:
    """Put the new bytes in a file's place in one step."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False) as file:
            file.write(encoded)
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            os.chmod(file.name, path.stat().st_mode & 0o777)
        else:
            os.chmod(file.name, 0o644)
        os.replace(file.name, path)
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}") from error
