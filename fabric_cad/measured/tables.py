"""Family tables: what was measured, a file a weave type and a row a fabric.

A table is a CSV in any dialect a spreadsheet writes (:mod:`~fabric_cad.measured.records`) or a workbook
(:mod:`~fabric_cad.measured.workbooks`). It is read whole: everything that is wrong in it is listed in one
:class:`~fabric_cad.support.errors.InputError`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from os import PathLike
from pathlib import Path

import numpy as np

from ..support.errors import ArgumentError, InputError, Place, Problem, UnknownRowError, did_you_mean, expect
from ..weave.weaves import Weave, weave_of
from .columns import (
    FLOAT_GAPS,
    MEASURED,
    MOST_YARNS,
    OTHER_UNITS,
    PER_DIRECTION,
    SECTIONS,
    STD,
    WEAVE_COLUMNS,
    is_safe_name,
)
from .records import Records, read_csv
from .row_rules import RowReader, header_problems
from .table_files import NO_TABLE, WORKBOOKS, family_of, stray_tables, table_files

__all__ = [
    "FLOAT_GAPS",
    "MEASURED",
    "MOST_YARNS",
    "OTHER_UNITS",
    "SECTIONS",
    "WEAVE_COLUMNS",
    "Family",
    "expect_row",
    "is_safe_name",
    "read_families",
    "read_family",
]


@dataclass(frozen=True, eq=False)
class Family:
    """The rows of one family table, as measured; every array has shape (rows,).

    ``measured`` maps each name of :data:`MEASURED` to an array in mm, 1/mm, tex, g/cm3 or
    (crimp) a plain ratio, NaN where the cell was empty; ``scatter`` maps the same names to
    the standard deviations of the ``*_std`` columns, in the same units. ``place`` is the file,
    and ``lines`` are the rows' lines in it, None where there is no file. ``refused`` is what is
    wrong with rows of the file that are not among these (:func:`read_family` with ``partial``).

    ``table[name]`` is the table of that one row, ``name in table`` whether there is one,
    ``len(table)`` the number of rows; iterating gives a table of one row after the other.
    """

    family: str
    place: Place
    names: tuple[str, ...]
    lines: tuple[int | None, ...]
    weaves: tuple[Weave, ...]
    measured: Mapping[str, np.ndarray]
    scatter: Mapping[str, np.ndarray]
    sections: tuple[str, ...]
    float_gaps: tuple[str, ...]
    thicker: tuple[str, ...]
    sources: tuple[str, ...]
    notes: tuple[str, ...]
    refused: tuple[Problem, ...] = field(default=(), metadata={"whole": True})

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[Family]:
        return (self.take([row]) for row in range(len(self)))

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> Family:
        """The table that holds the row ``name`` only.

        Raises :class:`UnknownRowError`, a KeyError, where there is none, and :class:`InputError`
        with its problems where the row is refused.
        """
        if not isinstance(name, str):
            raise ArgumentError(f"a row of a table is named by a text, not {type(name).__name__} {name!r:.60}")
        if name in self.names:
            return self.take([self.names.index(name)])
        if problems := self.problems_of(name):
            raise InputError(problems)
        raise UnknownRowError(self.place.problem(f"no row is called {name!r}{did_you_mean(name, self.names)}"))

    @property
    def path(self) -> str | None:
        """The table's file, None where it has none."""
        return self.place.path

    def problems_of(self, name: str) -> list[Problem]:
        """What is wrong with the refused row of that name; capitals make no difference, as for files."""
        return [problem for problem in self.refused if (problem.row or "").lower() == name.lower()]

    def take(self, rows: Sequence[int]) -> Family:
        """The table of the rows with these numbers, in this order."""

        def taken(part):
            value = getattr(self, part.name)
            if part.metadata.get("whole"):
                return part.default
            if isinstance(value, Mapping):
                return {column: values[rows] for column, values in value.items()}
            return tuple(value[row] for row in rows) if isinstance(value, tuple) else value

        return Family(**{part.name: taken(part) for part in fields(self)})

    @property
    def balanced(self) -> np.ndarray:
        """Boolean (rows,): True where every warp cell is empty."""
        return np.all([np.isnan(self.measured[f"warp_{q}"]) for q in PER_DIRECTION], axis=0)

    @property
    def scattered(self) -> np.ndarray:
        """Boolean (rows,): True where any standard deviation is given."""
        return ~np.all([np.isnan(values) for values in self.scatter.values()], axis=0)

    def problem(self, row: int, column: str, message: str) -> Problem:
        """A :class:`Problem` placed at a column of row number ``row``."""
        return self.place.problem(message, self.lines[row], column, self.names[row])


def expect_row(row: object, name: str = "row") -> None:
    """Raise :class:`ArgumentError` where an argument is no table of one row."""
    expect(row, Family, name, " of one row (table['name'] gives one)")
    if len(row) != 1:
        raise ArgumentError(f"{name}: expected a table of one row (table['name'] gives one), got {len(row)} rows")


def read_family(path: str | Path, partial: bool = False) -> Family:
    """Read one family table; the weave type is the file's name (``twill.csv``, ``.xlsx``, ``.ods``).

    Raises :class:`InputError` with every problem of the table: unreadable file, unknown or
    missing column, bad name, text or a bound broken where a number belongs. With ``partial``
    a row in which something is wrong is left out, and its problems are in ``refused``; what
    concerns the whole table still raises.
    """
    if not isinstance(path, (str, PathLike)):
        raise ArgumentError(f"path: expected the path of a family table, got {type(path).__name__} {path!r:.60}")
    path = Path(path)
    family = family_of(path)
    if path.suffix in WORKBOOKS:
        from .workbooks import read_workbook

        table = table_of(family, read_workbook(path))
    else:
        table = table_of(family, read_csv(path))
    if table.refused and not partial:
        raise InputError(table.refused)
    return table


def table_of(family: str, records: Records) -> Family:
    """The table of the lines of a file. Raises :class:`InputError` where its header is wrong."""
    if not records.lines:
        raise InputError(records.place.problem("the table is empty: no header line"))
    first, *others = records.lines
    header = list(first.cells)
    while header and not header[-1]:
        header.pop()

    place = _with_letters(records.place, header)
    if problems := header_problems(family, header, place, first.line):
        raise InputError(problems)

    reader = RowReader(family, header, place, records.separator)
    rows, lines, refused = [], [], []
    for record in others:
        row, problems = reader.read(record)
        refused += problems
        if not problems:
            rows.append(row)
            lines.append(record.line)
    twice = {(problem.row or "").lower() for problem in refused if problem.column == "name"}
    kept = [number for number, row in enumerate(rows) if row["name"].lower() not in twice]
    return family_table(family, place, [rows[n] for n in kept], [lines[n] for n in kept], tuple(refused))


def family_table(
    family: str, place: Place, rows: Sequence[Mapping], lines: Sequence[int | None], refused: tuple[Problem, ...] = ()
) -> Family:
    """The table of rows as :class:`~fabric_cad.measured.row_rules.RowReader` gives them."""
    return Family(
        family=family,
        place=place,
        names=tuple(row["name"] for row in rows),
        lines=tuple(lines),
        weaves=tuple(weave_of(family, row) for row in rows),
        measured={column: np.array([row[column] for row in rows], dtype=float) for column in MEASURED},
        scatter={column: np.array([row[std] for row in rows], dtype=float) for column, std in zip(MEASURED, STD)},
        sections=tuple(row["section"] or "lenticular" for row in rows),
        float_gaps=tuple(row["float_gap"] or FLOAT_GAPS[0] for row in rows),
        thicker=tuple(row["thicker"] for row in rows),
        sources=tuple(row["source"] for row in rows),
        notes=tuple(row["notes"] for row in rows),
        refused=refused,
    )


def _with_letters(place: Place, header: Sequence[str]) -> Place:
    """The place with the letters of a sheet's columns, also under the name a quantity is kept in."""
    if place.sheet is None:
        return place
    from .workbooks import letters_of

    letters = {column: letters_of(number) for number, column in enumerate(header)}
    kept = {OTHER_UNITS[column][0]: letter for column, letter in letters.items() if column in OTHER_UNITS}
    return replace(place, letters=kept | letters)


def read_families(folder: str | Path, partial: bool = False) -> dict[str, Family | InputError]:
    """Read every family table of a folder; a table with problems is given as its error.

    With ``partial``, as in :func:`read_family`, only a table that cannot be read as a whole is.
    Row names are unique over all tables: a name used in two is a problem of both. Raises
    :class:`InputError` where there is no folder or no table in it.
    """
    folder = Path(folder)
    if not folder.is_dir():
        message = "no such folder of family tables; 'fabric-cad init' puts the shipped ones into ./families"
        raise InputError(Problem(message, str(folder)))

    tables: dict[str, Family | InputError] = {}
    for family, paths in table_files(folder).items():
        try:
            if len(paths) > 1:
                names = " and ".join(path.name for path in paths)
                raise InputError(Problem(f"this table is there more than once, as {names}; keep one", str(paths[0])))
            tables[family] = read_family(paths[0], partial=True)
        except InputError as error:
            tables[family] = error
    if not tables:
        raise InputError([Problem(f"no family table in this folder ({NO_TABLE})", str(folder)), *stray_tables(folder)])

    tables = _without_shared_names(tables)
    if partial:
        return tables
    return {
        family: InputError(table.refused) if isinstance(table, Family) and table.refused else table
        for family, table in tables.items()
    }


def _without_shared_names(tables: Mapping[str, Family | InputError]) -> dict[str, Family | InputError]:
    """The tables with the rows refused whose name another table has too."""
    users: dict[str, list[tuple[str, int]]] = {}
    for family, table in tables.items():
        if isinstance(table, Family):
            for row, name in enumerate(table.names):
                users.setdefault(name.lower(), []).append((family, row))

    shared: dict[str, dict[int, Problem]] = {}
    for rows in users.values():
        for family, row in rows if len(rows) > 1 else ():
            others = (tables[other].problem(number, "name", "") for other, number in rows if other != family)
            where = ", ".join(problem.where for problem in others)
            problem = tables[family].problem(row, "name", f"this row name is also at {where}")
            shared.setdefault(family, {})[row] = problem

    kept = dict(tables)
    for family, problems in shared.items():
        table = tables[family]
        part = table.take([row for row in range(len(table)) if row not in problems])
        kept[family] = replace(part, refused=(*table.refused, *problems.values()))
    return kept
