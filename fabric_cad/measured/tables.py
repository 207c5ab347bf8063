"""Family tables: what was measured, a file a weave type and a row a fabric.

A table is a CSV in any dialect a spreadsheet writes (:mod:`~fabric_cad.measured.records`) or a
workbook (:mod:`~fabric_cad.measured.workbooks`). It is read whole: everything that is wrong in it
is listed in one :class:`~fabric_cad.support.errors.InputError`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path

from ..support.errors import ArgumentError, InputError, Problem
from ..weave.faults import MOST_YARNS
from .columns import FLOAT_GAPS, MEASURED, OTHER_UNITS, SECTIONS, WEAVE_COLUMNS, is_safe_name
from .family import Family, expect_row
from .reader import table_of
from .records import read_csv
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


def read_family(path: str | Path, partial: bool = False) -> Family:
    """Read one family table; the weave type is the file's name (``twill.csv``, ``.xlsx``, ``.ods``).

    Raises :class:`InputError` with every problem of the table: unreadable file, unknown or
    missing column, bad name, text or a bound broken where a number belongs. With ``partial``
    a row in which something is wrong is left out, and its problems are in ``refused``; what
    concerns the whole table still raises.
    """
    if not isinstance(path, (str, PathLike)):
        raise ArgumentError(
            f"path: expected the path of a family table, got {type(path).__name__} {path!r:.60}"
        )

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
                raise InputError(
                    Problem(
                        f"this table is there more than once, as {names}; keep one", str(paths[0])
                    )
                )

            tables[family] = read_family(paths[0], partial=True)
        except InputError as error:
            tables[family] = error

    if not tables:
        raise InputError(
            [
                Problem(f"no family table in this folder ({NO_TABLE})", str(folder)),
                *stray_tables(folder),
            ]
        )

    tables = _without_shared_names(tables)
    if partial:
        return tables
    return {
        family: InputError(table.refused) if isinstance(table, Family) and table.refused else table
        for family, table in tables.items()
    }


def _without_shared_names(
    tables: Mapping[str, Family | InputError],
) -> dict[str, Family | InputError]:
    """The tables with the rows refused whose name another table has too."""
    readable = {family: table for family, table in tables.items() if isinstance(table, Family)}
    users: dict[str, list[tuple[str, int]]] = {}
    for family, table in readable.items():
        for row, name in enumerate(table.names):
            users.setdefault(name.lower(), []).append((family, row))

    shared: dict[str, dict[int, Problem]] = {}
    for rows in users.values():
        for family, row in rows if len(rows) > 1 else ():
            others = (
                readable[other].problem(number, "name", "")
                for other, number in rows
                if other != family
            )
            where = ", ".join(problem.where for problem in others)
            problem = readable[family].problem(row, "name", f"this row name is also at {where}")
            shared.setdefault(family, {})[row] = problem

    kept = dict(tables)
    for family, problems in shared.items():
        table = readable[family]
        part = table.take([row for row in range(len(table)) if row not in problems])
        kept[family] = replace(part, refused=(*table.refused, *problems.values()))

    return kept
