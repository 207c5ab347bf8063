"""Means and standard deviations of what is identified, from those of what was measured.

First order: a quantity y identified from measurements x1, x2, ... has the mean y(x) and

    std(y)^2 = sum over k of (dy/dxk std(xk))^2

the measurements being independent of each other. A balanced row's weft measurement is the
warp's too: one variable, moved once. Derivatives are central differences of the
identification itself, so they hold for every quantity that it gives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..measured.family import Family
from ..measured.relations import SPACING
from ..measured.row_values import RowValues
from ..measured.rules import BOUNDS, Rule
from ..support.errors import InputError, Problem, expect
from ..weave.directions import DIRECTIONS
from .identification import identify
from .solved import SolvedTable

_STEP = 2.0**-17
"""Step of the differences as a share of the value: the cube root of the rounding, where a central
difference loses as little to rounding as to truncation, about 1e-10."""

# faces closer than this, as a share of the fabric, are level: the same rounding as the
# identification's
_LEVEL = 1e-9


@dataclass(frozen=True, eq=False)
class Spread:
    """Mean and standard deviation of every number column of a solved table, in its units.

    ``mean`` and ``std`` map a column's name to an array of shape (rows,). A standard
    deviation is NaN in rows without any ``*_std`` cell, and 0 where no scatter given acts.
    """

    mean: Mapping[str, np.ndarray]
    std: Mapping[str, np.ndarray]

    def row(self, at: int) -> dict[str, float]:
        """Standard deviations of row number ``at``, by column."""
        return {column: float(values[at]) for column, values in self.std.items()}


def propagate(table: Family, solved: SolvedTable | None = None) -> Spread:
    """Spread of a table's identified quantities; ``solved`` saves identifying it again.

    Where two solutions exist the one taken is kept. At a bound of what is a fabric, a
    one-sided difference is taken, good to about 1e-5. Raises :class:`InputError` where the
    table does, and naming the row and column where a fabric is left on either side.
    """
    expect(table, Family, "table", " (read_family gives one)")
    solved = identify(table) if solved is None else solved
    columns = _number_columns(solved)
    mean = _numbers(solved, columns)
    table = _branch_kept(table, solved)
    variance = np.where(table.scattered, 0.0, np.nan) * np.ones((len(columns), 1))
    problems: list[Problem] = []

    for name, std in table.scatter.items():
        rows = np.flatnonzero(std > 0)
        if len(rows):
            slopes, wrong = _derivatives(table.take(rows), name, columns, mean[:, rows])
            variance[:, rows] += (slopes * std[rows]) ** 2
            problems += wrong

    if problems:
        raise InputError(sorted(problems, key=lambda problem: problem.line or 0))

    return Spread(dict(zip(columns, mean)), dict(zip(columns, np.sqrt(variance))))


def doubts(table: Family, solved: SolvedTable) -> list[Problem]:
    """Where first order says little: what a measurement one standard deviation off would change.

    A row is named where it would be no fabric there, or where the other direction would
    reach the fabric's faces, at which the fabric thickness (15) has a kink.
    """
    kept = _branch_kept(table, solved)
    columns = _number_columns(solved)
    outer = _warp_outside(solved)
    found: list[Problem] = []

    for name, std in table.scatter.items():
        rows = np.flatnonzero(std > 0)
        if not len(rows):
            continue
        part = kept.take(rows)
        turned = np.zeros(len(rows), dtype=bool)
        for sign, word in ((-1, "below"), (1, "above")):
            moved = part.measured[name] + sign * std[rows]
            numbers, refused = _identified_at(part, name, moved, columns)
            found += [
                table.problem(
                    rows[at],
                    f"{name}_std",
                    f"one standard deviation {word} the mean is no fabric: {why}",
                )
                for at, why in refused.items()
            ]
            there = dict(zip(columns, numbers))
            turned |= np.where(np.isnan(numbers[0]), outer[rows], _outside(there)) != outer[rows]

        found += [
            table.problem(
                rows[at],
                f"{name}_std",
                "within one standard deviation the other direction reaches the fabric's faces, "
                "and first order misjudges the fabric thickness",
            )
            for at in np.flatnonzero(turned).tolist()
            if "fabric_thickness_mm" not in solved.columns["identified_by"][rows[at]]
        ]

    return sorted(found, key=lambda problem: problem.line or 0)


def _number_columns(solved: SolvedTable) -> list[str]:
    """The columns that hold a number in every row, without those of a second solution."""
    return [
        column
        for column, values in solved.columns.items()
        if all(isinstance(value, float) for value in values) and not column.startswith("other_")
    ]


def _numbers(solved: SolvedTable, columns: Sequence[str]) -> np.ndarray:
    """Values of the columns, shape (columns, rows)."""
    return np.array([solved.columns[column] for column in columns], dtype=float).reshape(
        len(columns), len(solved)
    )


def _outside(columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Boolean (rows,): the warp alone reaches the fabric's faces. (15)"""
    weft, warp = (columns[f"{d}_thickness_mm"] + columns[f"{d}_amplitude_mm"] for d in DIRECTIONS)
    return warp - weft > _LEVEL * columns["fabric_thickness_mm"]


def _warp_outside(solved: SolvedTable) -> np.ndarray:
    quantities = [f"{d}_{q}_mm" for d in DIRECTIONS for q in ("thickness", "amplitude")] + [
        "fabric_thickness_mm"
    ]
    return _outside(
        {column: np.array(solved.columns[column], dtype=float) for column in quantities}
    )


def _branch_kept(table: Family, solved: SolvedTable) -> Family:
    """The table with ``thicker`` set to the solution taken, so that no step changes it."""
    taken = ("warp" if warp else "weft" for warp in _warp_outside(solved))
    return replace(table, thicker=tuple(asked or each for asked, each in zip(table.thicker, taken)))


def _derivatives(
    table: Family, name: str, columns, centre: np.ndarray
) -> tuple[np.ndarray, list[Problem]]:
    """d columns / d ``measured[name]``, shape (columns, rows), and the rows that have none."""
    value = table.measured[name]
    step = _STEP * np.where(value > 0, value, table.scatter[name])
    below, above = value - step, value + step
    (low, _), (high, _) = (_identified_at(table, name, moved, columns) for moved in (below, above))
    no_low, no_high = np.isnan(low).any(axis=0), np.isnan(high).any(axis=0)
    rise = np.where(no_high, centre, high) - np.where(no_low, centre, low)
    run = np.where(no_high, value, above) - np.where(no_low, value, below)
    message = (
        "neither a little more nor a little less than {:g} is a fabric: no scatter to propagate"
    )
    wrong = [
        table.problem(at, f"{name}_std", message.format(value[at]))
        for at in np.flatnonzero(no_low & no_high).tolist()
    ]

    return rise / np.where(no_low & no_high, np.nan, run), wrong


def _identified_at(
    table: Family, name: str, values: np.ndarray, columns
) -> tuple[np.ndarray, dict[int, str]]:
    """Columns of the table with other values of one measurement, shape (columns, rows).

    Rows that are no fabric with it are NaN; second, why, by row number.
    """
    moved = replace(table, measured={**table.measured, name: values})
    refused = _out_of_bounds(moved, name)
    numbers = np.full((len(columns), len(table)), np.nan)
    good = [at for at in range(len(table)) if at not in refused]
    try:
        numbers[:, good] = _numbers(identify(moved.take(good)), columns)
    except InputError as error:
        why = {problem.row: f"{problem.column}: {problem.message}" for problem in error.problems}
        refused |= {at: why[table.names[at]] for at in good if table.names[at] in why}
        good = [at for at in good if at not in refused]
        numbers[:, good] = _numbers(identify(moved.take(good)), columns)

    return numbers, refused


def _out_of_bounds(table: Family, name: str) -> dict[int, str]:
    """Rows that another value of one measurement takes beyond its column's bound or its yarns' spacing, and why."""
    rows = RowValues.of(table)

    def faults(rule: Rule) -> list[tuple[int, str]]:
        return rule.faults(rows, lambda row: f"{rows.values[rule.column][row]:.4g}")

    refused = dict(faults(BOUNDS[name]))
    for rule in SPACING.values():
        for row, message in faults(rule):
            refused.setdefault(row, f"{rule.column}: {message}")
    return refused
