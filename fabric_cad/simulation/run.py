"""A row's cell under load, from the family table to the files in its folder.

row -> solved fabric -> STEP -> coarse hexahedra -> deck -> ccx -> table, pictures, report
"""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..cell.pipeline import Stages
from ..cell.report import CellReport
from ..cell.traces import renew_digests
from ..measured.tables import Family
from ..support.errors import SolverError
from ..support.staging import staged
from .case_run import CaseRun
from .case_table import case_table
from .cell import loaded_cell
from .job import Job, Solver, run_job, write_model
from .pictures import write_states
from .progress import CaseWatch
from .report import CaseReport, case_report
from .settings import Settings, read_settings

INCOMPLETE = "incomplete"


def make_tension(
    row: Family, families: str | Path, out: str | Path, solver: Solver | None = None, **options: Any
) -> dict[str, Any]:
    """Biaxial tension of one row's cell: every file of it in ``out/<row name>``; its report.

    ``families`` is the folder whose ``simulation.toml`` holds, where it has one. ``options``:
    ``mesh``, keywords of :func:`fabric_cad.mesh_options` that win over the settings', and
    ``stages``. Raises :class:`FabricCadError`; where the solver stopped early, what it reached is
    in ``out/<row name>/tension_incomplete`` until a later run finishes, and earlier results are as
    they were.
    """
    return make_case(
        "tension", row, read_settings(families, row.names[0]), out, solver=solver, **options
    ).content()


def make_shear(
    row: Family, families: str | Path, out: str | Path, solver: Solver | None = None, **options: Any
) -> dict[str, Any]:
    """Trellis shear of one row's cell; as :func:`make_tension`."""
    return make_case(
        "shear", row, read_settings(families, row.names[0]), out, solver=solver, **options
    ).content()


def write_case(
    name: str,
    row: Family,
    settings: Settings,
    out: str | Path,
    *,
    dialect: str,
    mesh: Mapping[str, Any] | None = None,
    stages: Stages | None = None,
) -> list[Path]:
    """Write the decks of a load case and run nothing.

    Their places in ``out/<row name>``. Options as above.
    """
    target = Path(out) / row.names[0]
    with staged(target, renew_digests) as folder:
        run = _prepared(name, row, settings, folder, mesh=mesh or {}, stages=stages or Stages())
        return [target / deck.name for deck in _write_decks(run, dialect)]


def make_case(
    name: str,
    row: Family,
    settings: Settings,
    out: str | Path,
    *,
    solver: Solver | None = None,
    mesh: Mapping[str, Any] | None = None,
    stages: Stages | None = None,
) -> CaseReport:
    """Run the load case of that name on one row's cell, any there is; as :func:`make_tension`."""
    target, incomplete = Path(out) / row.names[0], f"{name}_{INCOMPLETE}"
    finished: list[CaseReport] = []

    def seal(folder: Path) -> None:
        """Drop what earlier runs left and this one does not replace: a stopped one's folder, more states."""
        for report in finished:
            if (folder / incomplete).exists():
                shutil.rmtree(folder / incomplete)
            for file in _files_of(target / f"{name}.json") - {*report.files, f"{name}.json"}:
                (folder / file).unlink(missing_ok=True)
        renew_digests(folder)

    with staged(target, seal) as folder:
        solver, mesh, stages = solver or Solver(), mesh or {}, stages or Stages()
        report, _ = run_case(name, row, settings, folder, solver=solver, mesh=mesh, stages=stages)
        if report.solver.finished:
            finished.append(report)
        else:
            _set_aside(folder, incomplete)

    if not finished:
        place = target / incomplete
        raise SolverError(
            f"{row.names[0]}: the solver {report.solver.reason}; what it reached is in {place}"
        )

    return report


def _set_aside(folder: Path, name: str) -> None:
    """Move all files of a folder into one of that name within it."""
    files = list(folder.iterdir())
    (folder / name).mkdir()
    for file in files:
        file.rename(folder / name / file.name)


def _files_of(report: Path) -> set[str]:
    """Names of the files that the report of an earlier run lists, none where there is no such report."""
    try:
        names = json.loads(report.read_text(encoding="utf-8"))["files"]
        return {name for name in names if Path(name).name == name and name.startswith(report.stem)}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return set()


def run_case(
    name: str,
    row: Family,
    settings: Settings,
    folder: Path,
    *,
    solver: Solver,
    mesh: Mapping[str, Any],
    stages: Stages,
) -> tuple[CaseReport, CellReport]:
    """Run the load case of that name with every file in ``folder``.

    Its report, which tells whether the solver finished, and that of the cell that was loaded.
    """
    run = _prepared(name, row, settings, folder, mesh=mesh, stages=stages)
    jobs = _run_jobs(run, _write_decks(run, "calculix"), solver)

    table = case_table(run, run.case.paths(settings.contact), jobs)
    write_states(run, table)
    run.case.draw(run, table)

    report = case_report(run, row, jobs, table)
    table.write(run.path(".csv"))
    return report.written(run.path(".json")), run.cell.report


def _prepared(
    name: str,
    row: Family,
    settings: Settings,
    folder: Path,
    *,
    mesh: Mapping[str, Any],
    stages: Stages,
) -> CaseRun:
    """The row's cell, meshed; its own files are dropped."""
    with tempfile.TemporaryDirectory(prefix="scratch-", dir=folder) as scratch:
        cell = loaded_cell(row, settings, mesh, Path(scratch), stages)
    return CaseRun(settings.case(name), cell, settings, folder, stages)


def _write_decks(run: CaseRun, dialect: str) -> list[Path]:
    """Write a deck for every path of the case; their places."""
    cell, lattice = run.cell, run.cell.fabric.lattice
    paths, decks = run.case.paths(run.settings.contact), []
    with run.stages("write deck"):
        for number, path in enumerate(paths, 1):
            deck = run.path(f"_{number}.inp" if len(paths) > 1 else ".inp")
            loads = tuple(run.case.load(state, lattice) for state in path)
            title = f"{run.case.name} of the elementary cell of {cell.fabric.name}"
            write_model(deck, cell.mesh, lattice, run.settings, loads, title, dialect)
            decks.append(deck)
    return decks


def _run_jobs(run: CaseRun, decks: Sequence[Path], solver: Solver) -> list[Job]:
    """Run the decks one after the other, until one does not finish."""
    mesh, jobs = run.cell.mesh, []
    states = [len(path) for path in run.case.paths(run.settings.contact)]
    watch = CaseWatch(states, len(mesh.hexahedra), solver.listen)
    for number, deck in enumerate(decks):
        with run.stages(f"solve {deck.stem}"):
            jobs.append(run_job(deck, mesh, solver, watch.job(number)))
        if not jobs[-1].run.finished:
            break
    return jobs
