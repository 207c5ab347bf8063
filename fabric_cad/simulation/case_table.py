"""The table of a load case: a line for every state that was reached, in the case's order."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..weave.lattice import Lattice
from .case_run import CaseRun
from .condition import condition
from .job import Job
from .reached import Deformed, Reached, at_rest


@dataclass(frozen=True, eq=False)
class CaseTable:
    """The lines of a case's table and what they come from, each as long as the table.

    ``times`` are those of the series for ParaView, ``rows`` the columns by name, ``labels`` the
    states in words; ``valid`` numbers the lines whose yarns keep out of each other.
    """

    times: tuple[float, ...]
    rows: tuple[Mapping[str, float], ...]
    labels: tuple[str, ...]
    reached: tuple[Reached, ...]
    valid: tuple[int, ...]

    def columns(self) -> dict[str, list[float]]:
        """The table by columns; none of a table without lines."""
        return {
            name: [row[name] for row in self.rows] for name in (self.rows[0] if self.rows else ())
        }

    def write(self, path: Path) -> None:
        """Write the rows as CSV; an empty cell where there is no number."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            if self.rows:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(self.rows[0])
                writer.writerows(
                    [[_cell_text(value) for value in row.values()] for row in self.rows]
                )


def case_table(run: CaseRun, paths: Sequence[Sequence[Any]], jobs: Sequence[Job]) -> CaseTable:
    """The table of what the ``jobs``, one a path, have reached of the states of ``paths``."""
    case, mesh = run.case, run.cell.mesh
    states = [state for path, job in zip(paths, jobs) for state in path[: len(job.reached)]]
    reached = [state for job in jobs for state in job.reached]
    rest = case.at_rest()
    if rest is not None:
        states, reached = [rest, *states], [at_rest(mesh), *reached]

    lattice = run.cell.fabric.lattice
    cells = [_deformed(run, lattice, state, place) for state, place in zip(states, reached)]
    with run.stages("penetration"):
        conditions = [condition(cell, run.settings.yarn) for cell in cells]

    lines = case.lines(states)
    rows = tuple(
        {**line.columns, **case.measures(states[number], cells[number]), **conditions[number]}
        for line in lines
        for number in [line.number]
    )

    return CaseTable(
        times=tuple(line.time for line in lines),
        rows=rows,
        labels=tuple(map(case.label, rows)),
        reached=tuple(reached[line.number] for line in lines),
        valid=tuple(
            n for n, row in enumerate(rows) if row["penetration_mm"] <= run.penetration_bound
        ),
    )


def _deformed(run: CaseRun, lattice: Lattice, state: Any, reached: Reached) -> Deformed:
    vectors = lattice.vectors + run.case.load(state, lattice).change
    return Deformed(run.cell.mesh, lattice, vectors, reached)


def _cell_text(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.9g}"
