"""TOML files beside the family tables: tables of keys, and ``[rows.NAME.TABLE]`` with what differs for one row."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path

from ..support.errors import InputError, Problem, did_you_mean, quoted
from ..support.toml_files import read_toml
from .tables import Family, read_families

Check = tuple[type, Callable, str]
"""What a key's value is, whether one of that kind is sound, and what is said of one that is not."""

POSITIVE: Check = (float, lambda v: 0 < v < math.inf, "is not a number above 0")
POISSON: Check = (float, lambda v: -1 < v < 1, "is not between -1 and 1")
FINITE: Check = (float, math.isfinite, "is not a finite number")
TEXT: Check = (str, lambda _text: True, "is not a text")


class SettingsFile:
    """One file, parsed, with everything that is wrong in it as ``problems``.

    ``checks`` has every table's keys and what holds for their values. Raises :class:`InputError`
    where the file cannot be read or is not TOML.
    """

    def __init__(self, path: Path, checks: Mapping[str, Mapping[str, Check]]) -> None:
        self.path = str(path)
        self.problems: list[Problem] = []
        self.content, self.lines = read_toml(path)
        self._checks = checks
        for table, keys in self.content.items():
            if table == "rows" and isinstance(keys, dict):
                for row, tables in keys.items():
                    self._check_row(path.parent, row, tables)
            else:
                self._check_table(table, keys, "")

    def tables(self, row: str) -> dict[str, dict]:
        """The tables the file has, a row's own keys in place of the general ones."""
        merged: dict[str, dict] = {}
        for tables in (self.content, self.content.get("rows", {}).get(row, {})):
            for table in self._checks:
                if table in tables:
                    merged[table] = merged.get(table, {}) | tables[table]

        return merged

    def problem(self, table: str, key: str, message: str, row: str = "") -> Problem:
        """A :class:`Problem` of this file, at the line of a key, or of its table where it has no such key."""
        place = ".".join(part for part in (table, key) if part)
        line = self.lines.get(f"rows.{row}.{place}", self.lines.get(place))
        return Problem(message, self.path, line, key, row or None)

    def _check_row(self, families: Path, row: str, tables: object) -> None:
        known = _row_names(families)
        if row not in known and did_you_mean(
            row, known
        ):  # a slip; what is like no row may be left of one
            self.problems.append(
                self.problem("", f"rows.{row}", f"no row is called so{did_you_mean(row, known)}")
            )
        if not isinstance(tables, dict):
            self.problems.append(self.problem("", f"rows.{row}", "is not a table"))
            return

        for name, inner in tables.items():
            self._check_table(name, inner, row)

    def _check_table(self, table: str, keys: object, row: str) -> None:
        if table not in self._checks:
            guess = did_you_mean(table, [*self._checks, "rows"])
            self.problems.append(self.problem("", table, f"no such table{guess}", row))
        elif not isinstance(keys, dict):
            self.problems.append(self.problem("", table, "is not a table", row))
        else:
            for key, value in keys.items():
                self._check(table, key, value, row)

    def _check(self, table: str, key: str, value: object, row: str) -> None:
        checks = self._checks[table]
        if key not in checks:
            self.problems.append(
                self.problem(
                    table, key, f"no such key in [{table}]{did_you_mean(key, checks)}", row
                )
            )
            return

        kind, sound, complaint = checks[key]
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        fits = number if kind is float else isinstance(value, kind) and not isinstance(value, bool)
        if not (fits and sound(value)):
            self.problems.append(self.problem(table, key, f"{quoted(value)} {complaint}", row))


def _row_names(families: Path) -> list[str]:
    """Names of all rows of a folder of family tables, unfinished ones too, as far as it can be read."""
    try:
        read = read_families(families, partial=True).values()
    except InputError:
        return []

    tables = [table for table in read if isinstance(table, Family)]
    refused = [problem.row for table in tables for problem in table.refused if problem.row]
    return [*(name for table in tables for name in table.names), *refused]
