"""The rows of one family table as values: arrays by column."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields

import numpy as np

from ..support.errors import (
    ArgumentError,
    InputError,
    Place,
    Problem,
    UnknownRowError,
    did_you_mean,
    expect,
)
from ..weave.weaves import Weave
from .columns import PER_DIRECTION

__all__ = ["Family", "expect_row"]


@dataclass(frozen=True, eq=False)
class Family:
    """The rows of one family table, as measured; every array has shape (rows,).

    ``measured`` maps each name of :data:`~fabric_cad.measured.columns.MEASURED` to an array in mm,
    1/mm, tex, g/cm3 or (crimp) a plain ratio, NaN where the cell was empty; ``scatter`` maps the
    same names to the standard deviations of the ``*_std`` columns, in the same units. ``place`` is
    the file, and ``lines`` are the rows' lines in it, None where there is no file. ``refused`` is
    what is wrong with rows of the file that are not among these
    (:func:`~fabric_cad.measured.tables.read_family` with ``partial``).

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
            raise ArgumentError(
                f"a row of a table is named by a text, not {type(name).__name__} {name!r:.60}"
            )

        if name in self.names:
            return self.take([self.names.index(name)])
        if problems := self.problems_of(name):
            raise InputError(problems)
        raise UnknownRowError(
            self.place.problem(f"no row is called {name!r}{did_you_mean(name, self.names)}")
        )

    @property
    def path(self) -> str | None:
        """The table's file, None where it has none."""
        return self.place.path

    def problems_of(self, name: str) -> list[Problem]:
        """What is wrong with the refused row of that name.

        Capitals make no difference, as for files.
        """
        return [problem for problem in self.refused if (problem.row or "").lower() == name.lower()]

    def take(self, rows: Sequence[int] | np.ndarray) -> Family:
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


def expect_row(row: Family, name: str = "row") -> None:
    """Raise :class:`ArgumentError` where an argument is no table of one row."""
    expect(row, Family, name, " of one row (table['name'] gives one)")
    if len(row) != 1:
        raise ArgumentError(
            f"{name}: expected a table of one row (table['name'] gives one), got {len(row)} rows"
        )
