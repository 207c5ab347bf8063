"""A row saved into the CSV that is edited otherwise: that row added or changed, every other byte as it was."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

from ..measured.columns import needed_columns
from ..measured.family import Family
from ..measured.table_files import table_files
from ..measured.tables import read_families, read_family
from ..support.errors import InputError, OutputError, Problem, read_input
from .edited import EditedRow, edited
from .table_text import is_same, with_row

_BOM = b"\xef\xbb\xbf"


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

    Columns that the table does not have yet are added at the end of its header; a table that is not
    there is begun. What would be written is first read by the strict reader: raises
    :class:`InputError` with the problems of the row, or where its name is taken
    (:class:`RowExistsError`, in this table), or where the table is a workbook or not UTF-8;
    :class:`OutputError` where it cannot be written. The file is exchanged in one step, or as it
    was.
    """
    path = _table(row, Path(families))
    before = read_input(path) if path.exists() else _begun(row)
    replaced = _is_taken(row, Path(families), replace)
    text, added = with_row(row, before, path)
    encoded = (_BOM if before.startswith(_BOM) else b"") + text.encode("utf-8")

    _check(row, encoded, path.name)
    _exchange(path, encoded)
    return Saved(path, replaced, added)


def _table(row: EditedRow, families: Path) -> Path:
    files = table_files(families).get(row.family, []) if families.is_dir() else []
    if len(files) > 1 or files and files[0].suffix != ".csv":
        message = (
            "rows are saved into text tables only; save this one as CSV, and keep one of its kind"
        )
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
            raise InputError(
                Problem(
                    f"this row name is in {family}.csv; choose another", column="name", row=row.name
                )
            )

        if not replace:
            message = "a row of this name is there already; replace it, or choose another name"
            raise RowExistsError(Problem(message, table.path, column="name", row=row.name))

        taken = True

    return taken


def _check(row: EditedRow, encoded: bytes, name: str) -> None:
    """Read what would be written, strictly: the row must be in it and say what it was to say."""
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch) / name
        copy.write_bytes(encoded)
        table = read_family(copy, partial=True)

    problems = [
        problem for problem in table.refused if (problem.row or "").lower() == row.name.lower()
    ]
    problems += [
        problem for problem in table.refused if problem.column == "name" and not problem.row
    ]
    if row.name not in table:
        told = problems or [Problem("the row has no name", column="name")]
        raise InputError(
            [Problem(problem.message, column=problem.column, row=row.name) for problem in told]
        )

    back, given = edited(table[row.name]), row
    for column in {*back.cells, *given.cells}:
        if not is_same(back.cells.get(column, ""), given.cells.get(column, ""), comma=False):
            raise InputError(
                Problem("this cell would not be read back as it was written", column=column)
            )


def _exchange(path: Path, encoded: bytes) -> None:
    """Put the new bytes in a file's place in one step."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(
            dir=path.parent, prefix=f".{path.name}.", delete=False
        ) as file:
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
