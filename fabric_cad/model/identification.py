"""From measured rows to the parameters of the model, whole tables at once.

Density and width known, the crimp of a yarn fixes its amplitude A through the length equation and
the reverse; the relations of :mod:`~fabric_cad.model.closing` give the rest. The first quantities
given, in the order of :data:`~fabric_cad.model.closing.CLOSING`, identify a row; what a row holds
beyond them is compared with the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..measured.family import Family
from ..support.errors import InputError, Problem, expect
from .closing import CLOSING
from .identifying import Identifying, insufficient
from .measured_values import Measured
from .refusals import refusals
from .solution import choose, solutions
from .solved import SolvedTable
from .solved_columns import solved_columns
from .transitions import transitions


@dataclass(frozen=True, eq=False)
class Identified:
    """What became of a table's rows.

    ``columns`` are those of the solved table, as arrays or lists of one value for each of ``rows``,
    the numbers of the rows that are fabrics; ``refused`` holds for every other row number what
    makes it none. ``closing`` and ``beyond``, shape (5, fabrics), are the measured quantities of
    :data:`~fabric_cad.model.closing.CLOSING` and whether they are beyond what identified the row.
    """

    columns: Mapping[str, Any]
    rows: np.ndarray
    refused: Mapping[int, Problem]
    closing: np.ndarray
    beyond: np.ndarray

    def without(self, refused: Iterable[int]) -> Identified:
        """The same without the rows of these numbers."""
        numbers = list(refused)
        if not numbers:
            return self

        rows = np.delete(self.rows, numbers)
        columns = {
            name: values[rows]
            if isinstance(values, np.ndarray)
            else [values[row] for row in rows.tolist()]
            for name, values in self.columns.items()
        }

        return replace(
            self,
            columns=columns,
            rows=rows,
            closing=self.closing[:, rows],
            beyond=self.beyond[:, rows],
        )

    def comparisons(self) -> tuple[tuple[tuple[str, float, float], ...], ...]:
        """(quantity, measured, model) of what each fabric measured beyond need."""
        compared: list[list[tuple[str, float, float]]] = [[] for _ in self.rows]
        for name, measured, beyond in zip(CLOSING, self.closing, self.beyond):
            fabrics = np.flatnonzero(beyond)
            model = np.asarray(self.columns[name])[fabrics]
            for fabric, given, computed in zip(fabrics, measured[fabrics].tolist(), model.tolist()):
                compared[fabric].append((name, given, computed))
        return tuple(map(tuple, compared))


def identify(table: Family) -> SolvedTable:
    """Solve every row of a table for the model's parameters.

    The paper's model (sections 3 to 5, appendix A): balanced rows from three parameters,
    unbalanced ones from seven or any other sufficient subset, and with contact chords,
    contact offsets and round sections the more general ones of 8, 12 and 18.
    Raises :class:`InputError` listing, for every row that is not a fabric, the number that
    makes it so; nothing unconverged is returned.
    """
    expect(table, Family, "table", " (read_family gives one)")

    identified = identify_rows(table)
    if identified.refused:
        raise InputError(sorted(identified.refused.values(), key=lambda problem: problem.line or 0))

    lists = {
        name: values.tolist() if isinstance(values, np.ndarray) else values
        for name, values in identified.columns.items()
    }
    return SolvedTable(lists, identified.comparisons())


def identify_rows(table: Family) -> Identified:
    """The same row by row: what is no fabric is refused with its reason, and the others are solved."""
    with np.errstate(all="ignore"):  # refused rows may hold anything
        measured = Measured.of(table)
        identifying = Identifying.of(measured)

        both = solutions(measured, transitions(table, measured), identifying)
        refused_by = refusals(table, both[0]), refusals(table, both[1])
        choice = choose(table, both, refused_by)
        taken, other = choice.of(*both)

        columns = solved_columns(table, replace(both[0], closed=taken), other, choice.two)

    lacking = np.flatnonzero(identifying.number == 0).tolist()
    refused = {row: insufficient(table, measured, row) for row in lacking} | choice.refused(
        *refused_by
    )

    used = [identifying.uses(quantity) for quantity in range(len(CLOSING))]
    beyond = ~np.isnan(measured.closing) & ~np.array(used)
    every = Identified(columns, np.arange(len(table)), refused, measured.closing, beyond)
    return every.without(refused)
