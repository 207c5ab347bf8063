"""A row of a family table as it is being edited: texts by column, and what the strict reader says of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from ..measured.columns import FLOAT_GAPS, SECTIONS, WEAVE_COLUMNS, known_columns, needed_columns
from ..measured.family import Family
from ..measured.reader import read_rows
from ..measured.records import Record
from ..model.identification import Identified, identify_rows
from ..model.solved import SolvedFabric, SolvedTable
from ..support.errors import InputError, Place, Problem, did_you_mean
from ..weave.patterns import read_pattern, written
from ..weave.weaves import FAMILIES, weave_of

DEFAULTS = MappingProxyType({"section": next(iter(SECTIONS)), "float_gap": FLOAT_GAPS[0]})
"""What an empty cell of these columns means."""

MOST_EDITED = 32
"""Most wefts or warps that are edited crossing by crossing."""


@dataclass(frozen=True)
class EditedRow:
    """A row as texts: ``cells`` maps columns to what stands in them, without empty ones and :data:`DEFAULTS`.

    Numbers are in the units that quantities are kept in. Raises :class:`InputError` for a family or
    a column that there is none of; what a text says is only judged by :func:`answer`.
    """

    family: str
    cells: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.family not in FAMILIES:
            hint = did_you_mean(self.family, FAMILIES)
            raise InputError(Problem(f"{self.family!r:.60} is none of {', '.join(FAMILIES)}{hint}"))

        known = known_columns(self.family)
        unknown = [column for column in self.cells if column not in known]
        if unknown:
            word = f"unknown column of {self.family}.csv"
            raise InputError([Problem(word, column=column) for column in unknown])

        texts = {column: text.strip() for column, text in self.cells.items()}
        filled = {
            column: text for column, text in texts.items() if text not in ("", DEFAULTS.get(column))
        }
        object.__setattr__(self, "cells", MappingProxyType(filled))

    @property
    def name(self) -> str:
        """The row's name, empty where it has none."""
        return self.cells.get("name", "")

    def changed(self, **cells: str) -> EditedRow:
        """The row with other texts in some columns."""
        return EditedRow(self.family, {**self.cells, **cells})

    def woven(self, family: str, **cells: str) -> EditedRow:
        """The row with another weave, of a family and its weave columns."""
        others = {column for columns in WEAVE_COLUMNS.values() for column in columns}
        kept = {column: text for column, text in self.cells.items() if column not in others}
        return EditedRow(family, kept | cells)

    def grid(self) -> tuple[str, ...]:
        """The interlacement, a text of ``1`` (weft over) and ``0`` a weft.

        () where the cells give none.
        """
        try:
            if self.family == "pattern":
                return read_pattern(self.cells.get("pattern", ""))
            counts = {column: int(self.cells[column]) for column in WEAVE_COLUMNS[self.family]}
            matrix = weave_of(self.family, counts).interlacement()
        except (ValueError, KeyError):
            return ()
        return tuple("".join("01"[over] for over in weft) for weft in matrix.astype(int))

    def flipped(self, crossings: Iterable[tuple[int, int]]) -> EditedRow:
        """The row as a pattern in which (weft, warp), each from 0, have changed sides."""
        marks = [list(weft) for weft in self.grid()]
        for weft, warp in crossings:
            marks[weft][warp] = "10"[int(marks[weft][warp])]
        return self.woven("pattern", pattern=written("".join(weft) for weft in marks))

    def resized(self, wefts: int, warps: int) -> EditedRow:
        """The row as a pattern of another size: cut, or repeated."""
        wefts, warps = (min(max(count, 2), MOST_EDITED) for count in (wefts, warps))
        marks = np.array([list(weft) for weft in self.grid()])
        marks = np.take(np.take(marks, range(wefts), 0, mode="wrap"), range(warps), 1, mode="wrap")
        return self.woven("pattern", pattern=written("".join(weft) for weft in marks))


@dataclass(frozen=True, eq=False)
class Solution:
    """What a row that is a fabric was identified to; ``table`` and ``solved`` hold it alone."""

    row: EditedRow
    table: Family
    identified: Identified
    solved: SolvedTable
    fabric: SolvedFabric

    @property
    def identified_by(self) -> tuple[str, ...]:
        """Columns that identified it."""
        return tuple(str(self.identified.columns["identified_by"][0]).split())


def answer(row: EditedRow) -> Solution | tuple[Problem, ...]:
    """The fabric of a row, or all that makes it none, each problem with its column."""
    cells = {"name": "fabric", **row.cells}
    header = list(dict.fromkeys([*needed_columns(row.family), *cells]))
    record = Record(None, tuple(cells.get(column, "") for column in header))

    table = read_rows(row.family, header, Place(), [record])
    if table.refused:
        return tuple(table.refused)
    identified = identify_rows(table)
    if identified.refused:
        return tuple(identified.refused.values())

    columns = {
        name: values.tolist() if isinstance(values, np.ndarray) else list(values)
        for name, values in identified.columns.items()
    }
    solved = SolvedTable(columns, identified.comparisons())

    return Solution(row, table, identified, solved, solved[table.names[0]])


def solution_of(table: Family) -> Solution:
    """The fabric of a table of one row. Raises :class:`InputError` where it is none."""
    found = answer(edited(table))
    if not isinstance(found, Solution):
        raise InputError(found)
    return found


def edited(table: Family) -> EditedRow:
    """The row of a table of one row, to be edited."""
    weave = table.weaves[0]
    weaving = {
        "over": str(weave.over),
        "under": str(weave.under),
        "harness": str(weave.over + weave.under),
        "step": str(weave.step),
        "pattern": written(weave.pattern),
    }
    texts = {"name": table.names, "section": table.sections, "float_gap": table.float_gaps}
    texts |= {"thicker": table.thicker, "source": table.sources, "notes": table.notes}
    cells = {column: values[0] for column, values in texts.items()}
    cells |= {column: weaving[column] for column in WEAVE_COLUMNS[table.family]}

    stds = {f"{column}_std": values for column, values in table.scatter.items()}
    numbers = {column: values[0] for column, values in (*table.measured.items(), *stds.items())}
    cells |= {column: f"{value:.12g}" for column, value in numbers.items() if not np.isnan(value)}
    return EditedRow(table.family, cells)
