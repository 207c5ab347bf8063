"""Which files of a folder are family tables, and which look as if they were meant to be."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from ..support.errors import InputError, Problem
from ..weave.weaves import FAMILIES

WORKBOOKS = (".xlsx", ".ods")
SUFFIXES = (".csv", *WORKBOOKS)
"""What the name of a family table ends in."""

_MEANT = (*SUFFIXES, ".xls", ".xlsm", ".xlsb", ".tsv", ".txt")

NO_TABLE = ", ".join(f"{family}.csv" for family in FAMILIES)


def family_of(path: Path) -> str:
    """The family whose table a path names. Raises :class:`InputError` where it is none."""
    if path.stem in FAMILIES:
        return path.stem
    meant = _meant(path)
    hint = (
        f"; did you mean {meant}?"
        if meant
        else f"; those are {NO_TABLE}, or .xlsx or .ods for .csv"
    )
    raise InputError(Problem(f"not a family table{hint}", str(path)))


def table_files(folder: Path) -> dict[str, list[Path]]:
    """The files of every family that has a table in the folder, usually one."""
    files = {family: [folder / f"{family}{suffix}" for suffix in SUFFIXES] for family in FAMILIES}
    there = {family: [path for path in paths if path.exists()] for family, paths in files.items()}
    return {family: paths for family, paths in there.items() if paths}


def stray_tables(folder: Path) -> list[Problem]:
    """Files of the folder that are not read, but whose names are nearly those of tables."""
    read = [path for paths in table_files(folder).values() for path in paths]
    strays = []
    try:
        files = sorted(path for path in folder.iterdir() if path.exists())
    except OSError:  # no right to list the folder; its tables may be readable all the same
        return []

    for path in files:
        meant = _meant(path)
        # some file systems take Twill.csv for twill.csv, and so it was read
        if meant and not any(path.samefile(table) for table in read):
            strays.append(
                Problem(f"this file is not read; a table of that kind is called {meant}", str(path))
            )

    return strays


def _meant(path: Path) -> str | None:
    """The name of the table that a file seems to be meant for.

    None for what a spreadsheet locks a table with.
    """
    suffix = path.suffix.strip().lower()
    if suffix not in _MEANT or path.name.startswith((".", "~")):
        return None
    stem = path.stem.strip().lower().removesuffix(".csv")
    families = get_close_matches(stem, FAMILIES, n=1, cutoff=0.75)
    proper = suffix if suffix in SUFFIXES else ".xlsx" if suffix.startswith(".xls") else ".csv"
    return f"{families[0]}{proper}" if families else None
