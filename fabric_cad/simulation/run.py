"""A row's cell under load, from the family table to the files in its folder.

row -> solved fabric -> STEP -> coarse hexahedra -> deck -> ccx -> table, pictures, report
"""

from __future__ import annotations

import json
import math
import shutil
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from ..cell.pipeline import Stages
from ..cell.traces import renew_digests, trace, write_traced
from ..decks.model import Load
from ..measured.tables import Family
from ..support.errors import SolverError
from ..support.series import valid_until
from ..support.staging import staged
from .cell import loaded_cell
from .job import Job, Reached, Solver, at_rest, condition, run_job, write_model
from .pictures import draw_crushing, draw_shear, draw_state, draw_tension, write_states
from .progress import CaseWatch
from .report import Case, case_report, plain, write_rows
from .settings import Settings, read_settings
from .shear import angles, cell_vectors, shear_loads, shear_row
from .shear import state_label as shear_label
from .tension import by_curve, paths, state_label, tension_loads, tension_row

INCOMPLETE = "incomplete"


def make_tension(row: Family, families: str | Path, out: str | Path, solver: Solver | None = None, **options) -> dict:
    """Biaxial tension of one row's cell: every file of it in ``out/<row name>``; its report.

    ``families`` is the folder whose ``simulation.toml`` holds, where it has one. ``options``:
    ``mesh``, keywords of :func:`fabric_cad.mesh_options` that win over the settings', and
    ``stages``. Raises :class:`FabricCadError`; where the solver stopped early, what it reached is
    in ``out/<row name>/tension_incomplete`` until a later run finishes, and earlier results are as they were.
    """
    return _make("tension", row, families, out, solver, **options)


def make_shear(row: Family, families: str | Path, out: str | Path, solver: Solver | None = None, **options) -> dict:
    """Trellis shear of one row's cell; as :func:`make_tension`."""
    return _make("shear", row, families, out, solver, **options)


def write_case(
    kind: str,
    row: Family,
    families: str | Path,
    out: str | Path,
    dialect: str,
    mesh: Mapping | None = None,
    stages: Stages | None = None,
) -> list[Path]:
    """Write the decks of a case and run nothing; their places in ``out/<row name>``. Options as above."""
    name, settings = row.names[0], read_settings(families, row.names[0])
    with staged(Path(out) / name, renew_digests) as folder:
        case = _prepared(kind, row, settings, folder, mesh or {}, stages or Stages())
        return [Path(out) / name / deck.name for deck in _decks(case, dialect)]


def _make(
    kind: str,
    row: Family,
    families: str | Path,
    out: str | Path,
    solver: Solver | None,
    mesh: Mapping | None = None,
    stages: Stages | None = None,
) -> dict:
    name, settings = row.names[0], read_settings(families, row.names[0])
    target, incomplete, finished = Path(out) / name, f"{kind}_{INCOMPLETE}", False

    def seal(folder: Path) -> None:
        """Drop what earlier runs left and this one does not replace: a stopped one's folder, more states."""
        if finished:
            if (folder / incomplete).exists():
                shutil.rmtree(folder / incomplete)
            for file in _files_of(target / f"{kind}.json") - {*report["files"], f"{kind}.json"}:
                (folder / file).unlink(missing_ok=True)
        renew_digests(folder)

    with staged(target, seal) as folder:
        report, _ = run_case(kind, row, settings, folder, solver or Solver(), mesh or {}, stages or Stages())
        finished = report["solver"]["finished"]
        if not finished:
            files = list(folder.iterdir())
            (folder / incomplete).mkdir()
            for file in files:
                file.rename(folder / incomplete / file.name)

    if not finished:
        reason = report["solver"]["reason"]
        raise SolverError(f"{name}: the solver {reason}; what it reached is in {target / incomplete}")
    return report


def _files_of(report: Path) -> set[str]:
    """Names of the files that the report of an earlier run lists, none where there is no such report."""
    try:
        names = json.loads(report.read_text(encoding="utf-8"))["files"]
        return {name for name in names if Path(name).name == name and name.startswith(report.stem)}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return set()


def run_case(
    kind: str, row: Family, settings: Settings, folder: Path, solver: Solver, mesh: Mapping, stages: Stages
) -> tuple[dict, dict]:
    """Run ``tension`` or ``shear`` with every file in ``folder``.

    Its report, which tells whether the solver finished, and that of the cell that was loaded.
    """
    case = _prepared(kind, row, settings, folder, mesh, stages)
    jobs: list[Job] = []
    decks = _decks(case, "calculix")
    states = [len(loads) for loads in _loads(case)]
    watch = CaseWatch(states, len(case.cell.mesh.hexahedra), solver.listen)
    for number, deck in enumerate(decks):
        with stages(f"solve {deck.stem}"):
            jobs.append(run_job(deck, case.cell.mesh, solver, watch.job(number)))
        if not jobs[-1].run.finished:
            break
    rows, found = _WORK[kind](case, jobs)
    report = case_report(case, row.names[0], jobs, rows, found) | trace(row, case.cell.options)
    write_rows(case.path(".csv"), rows)
    write_traced(report, case.path(".json"))
    return report, case.cell.report


def _prepared(kind: str, row: Family, settings: Settings, folder: Path, mesh: Mapping, stages: Stages) -> Case:
    """The row's cell, meshed; its own files are dropped."""
    with tempfile.TemporaryDirectory(prefix="scratch-", dir=folder) as scratch:
        return Case(kind, loaded_cell(row, settings, mesh, Path(scratch), stages), settings, folder, stages)


def _loads(case: Case) -> list[tuple[Load, ...]]:
    """The states that every job of a case goes through."""
    settings, period = case.settings, case.cell.fabric.period
    if case.kind == "tension":
        return [tension_loads(period, path) for path in paths(settings.tension, settings.contact)]
    return [shear_loads(period, settings.shear)]


def _decks(case: Case, dialect: str) -> list[Path]:
    """Write the case's decks; their places."""
    cell, settings, lattice = case.cell, case.settings, case.cell.fabric.lattice
    runs, decks = _loads(case), []
    with case.stages("write deck"):
        for at, loads in enumerate(runs, 1):
            deck = case.path(f"_{at}.inp" if len(runs) > 1 else ".inp")
            title = f"{case.kind} of the elementary cell of {cell.fabric.name}"
            write_model(deck, cell.mesh, lattice, settings, loads, title, dialect)
            decks.append(deck)
    return decks


def _tension(case: Case, jobs: list[Job]) -> tuple[list[dict], dict]:
    """Table, report, series and pictures of a tension case."""
    mesh, period, tension = case.cell.mesh, case.cell.fabric.period, case.settings.tension
    computed = zip(paths(tension, case.settings.contact), jobs)
    states = [(0.0, 0.0), *(state for path, job in computed for state in path[: len(job.reached)])]
    reached = [at_rest(mesh), *(each for job in jobs for each in job.reached)]
    vectors = [(1 + np.array(state))[:, None] * cell_vectors(period, 0.0) for state in states]
    conditions = _conditions(case, reached, vectors)

    rows, in_order = [], []
    for number, ratio in by_curve(states, tension):
        row = tension_row(mesh, period, states[number], reached[number], conditions[number])
        rows.append(row | {"k": ratio})
        in_order.append(reached[number])
    labels = [state_label(row) for row in rows]
    write_states(case, range(len(rows)), labels, in_order, rows)

    loaded = [number for number in _valid(case, rows) if rows[number]["E11"] or rows[number]["E22"]]
    if loaded:
        draw_tension(case, rows)
        largest = max(loaded, key=lambda number: sorted((rows[number]["E11"], rows[number]["E22"])))
        draw_state(case, in_order[largest], labels[largest])
        draw_crushing(case, in_order[largest], labels[largest])
    ends = {row["k"]: row for row in rows if not math.isnan(row["k"])}  # the last state of every curve
    return rows, {"largest": [plain(row) for row in ends.values()]}


def _shear(case: Case, jobs: list[Job]) -> tuple[list[dict], dict]:
    """Table, report, series and pictures of a shear case."""
    mesh, period, shear = case.cell.mesh, case.cell.fabric.period, case.settings.shear
    states, reached = list(angles(shear)[: len(jobs[0].reached)]), list(jobs[0].reached)
    if not shear.strain:
        states, reached = [0.0, *states], [at_rest(mesh), *reached]
    conditions = _conditions(case, reached, [cell_vectors(period, angle, shear.strain) for angle in states])
    rows = [shear_row(mesh, period, angle, shear.strain, *of) for angle, *of in zip(states, reached, conditions)]
    labels = [shear_label(angle, shear.strain) for angle in states]
    write_states(case, states, labels, reached, rows)

    if len(rows) > 1:
        draw_shear(case, rows)
        if valid := _valid(case, rows):
            draw_state(case, reached[valid[-1]], labels[valid[-1]])
    depths = [row["penetration_mm"] for row in rows]
    return rows, {
        "valid_up_to_deg": valid_until(states, depths, case.penetration_bound) if states else 0.0,
        "largest": plain(rows[-1]) if rows else None,
    }


_WORK: dict[str, Callable[[Case, list[Job]], tuple[list[dict], dict]]] = {"tension": _tension, "shear": _shear}
"""Table, report, series and pictures of each kind of case."""


def _conditions(case: Case, reached: list[Reached], vectors: list[np.ndarray]) -> list[dict[str, float]]:
    with case.stages("penetration"):
        return [condition(case.cell.mesh, case.settings.yarn, *of) for of in zip(reached, vectors)]


def _valid(case: Case, rows: list[dict[str, float]]) -> list[int]:
    """Numbers of the states whose yarns keep out of each other."""
    return [number for number, row in enumerate(rows) if row["penetration_mm"] <= case.penetration_bound]
