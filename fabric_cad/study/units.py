"""What one unit of a study does, in whichever process it runs."""

from __future__ import annotations

import faulthandler
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from ..cell.pipeline import Stages, checked_report, make_mesh, make_step, write_report
from ..cell.traces import trace
from ..composite.substances import Constituents
from ..measured.tables import Family
from ..simulation.loads import load_cases
from ..simulation.settings import Settings
from ..support.errors import FabricCadError, InputError, SolverError
from ..support.staging import output_errors, staged
from ..support.working import scratch_folder
from .figures import STIFFNESS, flat


@dataclass(frozen=True)
class Outcome:
    """What became of a unit: ``done``, ``refused`` (no fabric) or ``failed``, why, and its figures.

    ``costs`` are s by stage and in all (``total``), s of processor time (``processor``), and
    ``process_megabytes``, the most that the process it ran in has held so far.
    """

    status: str
    reason: str = ""
    figures: Mapping[str, object] = field(default_factory=dict)
    costs: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Work:
    """What is done with every unit: how far it goes, keywords of its mesh, s it may take, materials and loads.

    ``constituents`` are those of a composite, at depth stiffness.
    """

    depth: str
    mesh: Mapping[str, Any]
    limit_seconds: float
    settings: Settings | None = None
    constituents: Constituents | None = field(default=None, repr=False)

    @property
    def made_of(self) -> list[str]:
        """The constituents as text, for digests, wherever they were read from.

        Nothing at other depths.
        """
        return [repr(replace(self.constituents, path=""))] if self.constituents else []


def _cell(row: Family, work: Work, folder: Path, stages: Stages) -> dict:
    return checked_report(make_step(row, folder, stages), None, stages).content()


def _mesh(row: Family, work: Work, folder: Path, stages: Stages) -> dict:
    from ..meshing.options import mesh_options

    made = make_step(row, folder, stages)
    options = mesh_options(made.fabric, **work.mesh)
    report = checked_report(made, make_mesh(made, options, stages), stages)
    return report.content() | {"options": asdict(options)}


def _load(case: str, row: Family, work: Work, folder: Path, stages: Stages) -> dict:
    """The report of the cell that was loaded, and the case's figures under its name: ``tension.k=1.T11_N_per_yarn``."""
    from ..simulation.job import Solver
    from ..simulation.run import run_case

    settings = work.settings
    if settings is None:
        raise ValueError(f"a unit of depth {case} needs materials and loads")

    solver = Solver(threads=1, time_limit=0.8 * work.limit_seconds)  # before the unit's own end
    report, cell = run_case(
        case, row, settings, folder, solver=solver, mesh=work.mesh, stages=stages
    )
    if not report.solver.finished:
        raise SolverError(f"the solver {report.solver.reason}")
    figures = settings.case(case).figures(report.findings) | asdict(report.contact)

    return cell.content() | {case: figures, "options": report.origin["options"]}


def _stiffness(row: Family, work: Work, folder: Path, stages: Stages) -> dict:
    """The report of the cell, and what its composite is like from far away: ``stiffness.Ex`` ..."""
    from ..composite.stiffness.run import write_stiffness
    from ..composite.stiffness.summary import figures

    if work.constituents is None:
        raise ValueError("a unit of depth stiffness needs constituents")

    cell = _cell(row, work, folder, stages)
    report = write_stiffness(row, work.constituents, folder, mesh=work.mesh, stages=stages)
    return cell | {STIFFNESS: figures(report), "options": report.origin["options"]}


Depth = Callable[[Family, Work, Path, Stages], dict]
"""From a row, what is done, a folder for files and a stopwatch to a report."""


def depths() -> dict[str, Depth | None]:
    """How far a study may go, in order.

    At ``identify`` whole tables at once, see :mod:`fabric_cad.study.run`.
    """
    studied = [name for name, case in load_cases().items() if case.is_studied]
    loaded = {name: partial(_load, name) for name in studied}
    return {"identify": None, "cell": _cell, "mesh": _mesh, **loaded, STIFFNESS: _stiffness}


_ONE_AT_A_TIME = threading.Lock()
"""CadQuery and gmsh have one state a process: a worker of several threads runs one unit at a time."""


def run_unit(row: Family, work: Work, keep: str | None) -> Outcome:
    """Run a table of one row to its depth; ``keep`` names the folder for its files, which are dropped without it.

    A unit that takes longer than its limit ends its process, whatever that is doing.
    """
    with _ONE_AT_A_TIME, _ended_after(work.limit_seconds):
        stages, start, used = Stages(), time.perf_counter(), time.process_time()
        try:
            report = _kept(row, work, keep, stages)
        except InputError as error:
            return Outcome("refused", reason_of(error))
        except FabricCadError as error:
            return Outcome("failed", str(error))

        seconds = stages.seconds | {
            "total": time.perf_counter() - start,
            "processor": time.process_time() - used,
        }
        costs = {name: round(value, 4) for name, value in seconds.items()}
        return Outcome("done", "", flat(report), costs | _memory())


def _kept(row: Family, work: Work, keep: str | None, stages: Stages) -> dict:
    if keep is None:
        place = Path(tempfile.gettempdir())
        with output_errors(place), scratch_folder(place) as folder:
            return _reported(row, work, folder, stages)

    traced: dict = {}
    with staged(Path(keep) / row.names[0], partial(write_report, traced)) as folder:
        report = _reported(row, work, folder, stages)
        traced |= trace(row, None) | report
        return report


def _reported(row: Family, work: Work, folder: Path, stages: Stages) -> dict:
    depth = depths()[work.depth]
    if depth is None:
        raise ValueError(f"a unit is not run at depth {work.depth}")
    return depth(row, work, folder, stages)


def _memory() -> dict[str, float]:
    try:
        import resource
    except ImportError:  # not on Windows
        return {}
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {"process_megabytes": peak / (1e6 if sys.platform == "darwin" else 1e3)}


def reason_of(error: InputError) -> str:
    """Why a row is no fabric: its columns and what is wrong with them, without the place in a file."""
    return "; ".join(
        f"{each.column}: {each.message}" if each.column else each.message for each in error.problems
    )


@contextmanager
def _ended_after(limit: float):
    """End the process after so many seconds, from a thread of the interpreter's own that needs no turn of Python's."""
    with open(os.devnull, "w") as nowhere:
        faulthandler.dump_traceback_later(limit, exit=True, file=nowhere)
        try:
            yield
        finally:
            faulthandler.cancel_dump_traceback_later()
