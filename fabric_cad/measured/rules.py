"""The rules of a row that need no model, each once: over whole tables of numbers.

The reader of the tables, rows from a script, a study's rows and the propagation of scatter all ask here.
Rules of a weave's cells are in :mod:`~fabric_cad.weave.faults`; what a text must be to be a number is the
reader's own business (:mod:`~fabric_cad.measured.cells`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..support.errors import Problem
from ..weave.directions import DIRECTIONS
from .columns import MEASURED, NUMBERS
from .family import Family
from .row_values import RowValues


@dataclass(frozen=True)
class Rule:
    """A rule of one column: where it is broken, and what to say of the value and the bound that it breaks.

    ``message`` may hold ``{value}``, ``{bound}`` and ``{section}``; ``broken`` and ``bound`` give arrays of shape
    (rows,).
    """

    column: str
    broken: Callable[[RowValues], np.ndarray]
    message: str
    bound: Callable[[RowValues], np.ndarray] | None = None

    def faults(self, rows: RowValues, shown: Callable[[int], str] | None = None) -> list[tuple[int, str]]:
        """The number of every row that breaks it and what to say of it; ``shown(row)`` writes the row's value."""
        broken = np.flatnonzero(self.broken(rows)).tolist()
        if not broken:
            return []

        bounds = None if self.bound is None else self.bound(rows)
        values = rows.values.get(self.column)

        def told(row: int) -> str:
            value = shown(row) if shown else "" if values is None else f"{values[row]:g}"
            bound = None if bounds is None else bounds[row]
            return self.message.format(value=value, bound=bound, section=rows.sections[row] or "lenticular")

        return [(row, told(row)) for row in broken]


def bound_fault(column: str, value: float) -> str | None:
    """What the bound of a column says of a value in the column's unit."""
    bound = NUMBERS[column].bound
    return f"{value:g} is {bound.word}" if bound.broken(value, 0) else None


def _finite(column: str) -> Rule:
    return Rule(column, lambda rows: np.isinf(rows.values[column]), "{value} is not a number")


def _bounded(column: str) -> Rule:
    bound = NUMBERS[column].bound
    return Rule(column, lambda rows: bound.broken(rows.values[column], 0), f"{{value}} is {bound.word}")


BOUNDS = {column: _bounded(column) for column in NUMBERS}
"""The bound of every column of numbers, by the name it is written with."""


def _with_its_value(column: str) -> Rule:
    kept = NUMBERS[column].kept.removesuffix("_std")
    value = column.removesuffix("_std")
    return Rule(
        column,
        lambda rows: rows.filled[column] & ~rows.filled[kept],
        f"a standard deviation without its value; {value} is empty",
    )


SCATTER = {column: _with_its_value(column) for column in NUMBERS if column.endswith("_std")}
"""A standard deviation belongs to a measured value: a rule for every column of one, by the name it is written with."""


def _there(column: str, direction: str) -> Rule:
    hint = " (leave every warp cell empty for a balanced fabric)" if direction == "warp" else ""
    return Rule(column, lambda rows: rows.has(direction) & ~rows.filled[column], f"this cell is empty{hint}")


def _beside_each_other(direction: str) -> Rule:
    column = f"{direction}_width_mm"
    return Rule(
        column,
        lambda rows: rows.has(direction) & (rows.values[column] >= rows.spacing(direction)),
        f"{{value}} is not below the {direction} spacing {{bound:.4g}} mm",
        lambda rows: rows.spacing(direction),
    )


SPACING = {direction: _beside_each_other(direction) for direction in DIRECTIONS}
"""Yarns of a direction lie beside each other."""

LATERAL = (
    Rule(
        "lateral_height_mm",
        lambda rows: rows.is_section("flat") & ~rows.filled["lateral_height_mm"],
        "this cell is empty; a flat section needs the height of its sides",
    ),
    Rule(
        "lateral_height_mm",
        lambda rows: ~rows.is_section("flat") & ~np.isnan(rows.values["lateral_height_mm"]),
        "{value} has no meaning for a {section} section; write flat",
    ),
)
"""The height of the sides belongs to a flat section."""


def _contact(direction: str, side: str) -> Iterator[Rule]:
    """Bounds of a contact chord c_t, c_b and offset d_c."""
    chord, offset = f"{direction}_contact_{side}_mm", f"{direction}_offset_{side}_mm"
    width = f"{direction}_width_mm"

    yield Rule(
        chord,
        lambda rows: rows.values[chord] > rows.values[width],
        f"{{value}} is above the {direction} width {{bound:g}} mm",
        lambda rows: rows.values[width],
    )
    yield Rule(
        chord,
        lambda rows: rows.is_section("round") & (rows.chord(direction, side) == rows.values[width]),
        "a round section needs a contact chord below its width {bound:g} mm",
        lambda rows: rows.values[width],
    )
    yield Rule(
        offset,
        lambda rows: rows.values[offset] >= rows.chord(direction, side) / 2,
        "{value} is not below half the contact chord, {bound:g} mm",
        lambda rows: rows.chord(direction, side) / 2,
    )


def _relations() -> Iterator[Rule]:
    for direction in DIRECTIONS:
        for quantity in ("density_per_mm", "width_mm"):
            yield _there(f"{direction}_{quantity}", direction)
        yield SPACING[direction]

    yield from LATERAL
    for direction in DIRECTIONS:
        for side in ("top", "bottom"):
            yield from _contact(direction, side)


RELATIONS = tuple(_relations())
"""Rules between cells of one row, in the order in which they are told."""

ALL = (*(rule(column) for column in MEASURED for rule in (_finite, _bounded)), *RELATIONS)


def out_of_bounds(table: Family, rules: Iterable[Rule] = ALL) -> dict[int, Problem]:
    """The first rule that each row breaks, by row number; rows that keep all of them are not in it."""
    rows = RowValues.of(table)
    refused: dict[int, Problem] = {}

    for rule in rules:
        for row, message in rule.faults(rows):
            if row not in refused:
                refused[row] = table.problem(row, rule.column, message)
    return refused
