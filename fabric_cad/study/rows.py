"""Rows of a study: the base row with the factors' values in their columns, as one table of numbers."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..measured.columns import CHOICES, MEASURED, WEAVE_COLUMNS, kept_column
from ..measured.family import Family
from ..measured.relations import out_of_bounds
from ..support.errors import Problem
from ..weave.faults import weave_fault
from ..weave.patterns import read_pattern, written
from ..weave.weaves import Weave, weave_of
from .design import Samples

_KEPT = {field.name for field in fields(Family)}
_FIELDS = {
    column: next(name for name in (column, f"{column}s") if name in _KEPT) for column in CHOICES
}
"""Where a table keeps its columns of choices: under their name, or its plural."""


def weave_cells(base: Family) -> dict[str, Any]:
    """Weave columns of a table's first row with its values."""
    weave = base.weaves[0]
    cells: dict[str, dict[str, Any]] = {
        "plain": {},
        "twill": {"over": weave.over, "under": weave.under},
        "satin": {"harness": weave.warps, "step": weave.step},
        "pattern": {"pattern": written(weave.pattern)},
    }
    return cells[base.family]


def base_value(base: Family, column: str) -> Any:
    """What the base row has in a column, in the unit of that column."""
    if column in WEAVE_COLUMNS[base.family]:
        return weave_cells(base)[column]
    if column in _FIELDS:
        return getattr(base, _FIELDS[column])[0]
    kept, unit = kept_column(column)
    return float(base.measured[kept][0]) / unit


def study_rows(base: Family, samples: Samples) -> tuple[Family, dict[int, Problem]]:
    """A table of one row a unit, named ``<base row>_<unit>``, and what makes a row none, by row number.

    ``base`` is a table of one row; standard deviations are dropped, since scatter is what is
    sampled.
    """
    units = len(samples)
    (name,) = base.names
    repeated = base.take([0] * units)
    measured = dict(repeated.measured)
    choices: dict[str, Any] = {}

    for column, values in samples.values.items():
        if column in _FIELDS:
            choices[_FIELDS[column]] = tuple(values.tolist())
        elif column not in WEAVE_COLUMNS[base.family]:
            kept, unit = kept_column(column)
            measured[kept] = np.asarray(values, dtype=float) * unit

    weaves, faults = _weaves(base, samples)
    width = len(str(max(units - 1, 0)))
    table = replace(
        repeated,
        names=tuple(f"{name}_{unit:0{width}d}" for unit in range(units)),
        weaves=weaves,
        measured=measured,
        scatter={column: np.full(units, np.nan) for column in MEASURED},
        **choices,
    )
    refused = {at: table.problem(at, column, message) for at, (column, message) in faults.items()}

    return table, out_of_bounds(table) | refused


def _weaves(base: Family, samples: Samples) -> tuple[tuple[Weave, ...], dict[int, tuple[str, str]]]:
    """The weave of every unit, and (column, message) where its cells make none (the base row's weave stands in)."""
    columns = [column for column in WEAVE_COLUMNS[base.family] if column in samples.values]
    if not columns:
        return base.weaves * len(samples), {}
    known: dict[tuple, tuple[Weave, tuple[str, str] | None]] = {}
    weaves, faults = [], {}
    for at, cells in enumerate(zip(*(samples.values[column].tolist() for column in columns))):
        if cells not in known:
            row = weave_cells(base) | dict(zip(columns, cells))
            fault = weave_fault(base.family, row)
            if base.family == "pattern" and fault is None:
                row["pattern"] = read_pattern(row["pattern"])
            known[cells] = (base.weaves[0] if fault else weave_of(base.family, row)), fault

        weave, fault = known[cells]
        weaves.append(weave)
        if fault:
            faults[at] = fault

    return tuple(weaves), faults
