"""One solver job: a deck through a row of loads, and what its output files say of every state.

mesh, loads --model--> <stem>.inp --ccx--> <stem>.frd, .dat, .log --readers--> Job
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..decks.faces import area_vectors, face_quads, touching_faces
from ..decks.keywords import EngineeringConstants, write_keywords
from ..decks.model import Load, Touch, model_keywords
from ..meshing.mesh import Mesh
from ..support.cores import cores
from ..weave.directions import DIRECTIONS
from ..weave.lattice import Lattice
from .progress import CaseProgress
from .reached import Reached
from .results import State, read_dat, read_frd
from .settings import Settings
from .solver import Progress, Run, find_solver, run_solver

_STRESS_FREE = 1e-6  # MPa: contact pressure above which a node counts as touching


@dataclass(frozen=True)
class Solver:
    """Which ccx to run, on how many threads, for how many seconds a job, and who hears of a case's progress.

    By default the one on the PATH, on all processors. Raises :class:`SolverError` where there is
    none.
    """

    path: Path = field(default_factory=find_solver)
    threads: int = field(default_factory=cores)
    time_limit: float = 3600.0
    listen: Callable[[CaseProgress], None] | None = None


@dataclass(frozen=True)
class Job:
    """A finished or stopped job: how it ran and every load it reached, in the loads' order."""

    run: Run
    reached: tuple[Reached, ...]


def write_model(
    path: Path,
    mesh: Mesh,
    lattice: Lattice,
    settings: Settings,
    loads: tuple[Load, ...],
    title: str,
    dialect: str = "calculix",
) -> None:
    """Write the deck of a cell that goes through loads. Raises :class:`BuildError` where its ends do not match."""
    law, contact = settings.yarn, settings.contact
    constants = EngineeringConstants(
        *(
            law.E1_MPa,
            law.E2_MPa,
            law.E3_MPa,
            law.nu12,
            law.nu13,
            law.nu23,
            law.G12_MPa,
            law.G13_MPa,
            law.G23_MPa,
        )
    )
    rings = 0 if contact.kind == "tie" else contact.rings
    touch = Touch(
        contact.kind, contact.stiffness_N_per_mm3, contact.friction, contact.stick_N_per_mm3, rings
    )
    write_keywords(
        model_keywords(mesh, lattice, constants, law.hardening, touch, loads, title), path, dialect
    )


def run_job(
    deck: Path, mesh: Mesh, solver: Solver, listen: Callable[[Progress], None] | None = None
) -> Job:
    """Run a deck of :func:`write_model` and read what it reached; of a job that stops early, what came before.

    ``listen`` hears of its increments.
    Raises :class:`SolverError` where the solver cannot be started.
    """
    run = run_solver(
        deck, solver.path, threads=solver.threads, time_limit=solver.time_limit, listen=listen
    )
    for useless in (deck.with_suffix(".12d"), deck.with_name("spooles.out")):
        useless.unlink(missing_ok=True)
    if not run.increments:
        return Job(run, ())
    forces: dict[int, dict[str, np.ndarray]] = {}
    for each in read_dat(deck.with_suffix(".dat")):
        step = round(each.time)  # every step takes a time of 1 and prints at its end
        if each.quantity == "RF":
            forces.setdefault(step, {})[each.name.lower()] = each.values

    weights = _patch_areas(mesh)
    reached = []
    for state in read_frd(deck.with_suffix(".frd")):
        if abs(state.time - state.step) > 1e-4:
            continue  # a step's load reached in part
        pulls = np.array(
            [forces[state.step].get(f"{name}_ends", np.full(3, np.nan)) for name in DIRECTIONS]
        )
        reached.append(_reached(mesh, state, pulls, weights))

    return Job(run, tuple(reached))


def _reached(mesh: Mesh, state: State, forces: np.ndarray, weights: np.ndarray) -> Reached:
    count = len(mesh.points)
    contact = state.fields.get("CONTACT")
    pressure = np.full(count, np.nan)
    overclosure = share = float("nan")
    if contact is not None:
        columns = state.components("CONTACT")
        opening = contact[:count, columns.index("COPEN")]
        touching = weights > 0
        pressure[touching] = contact[:count, columns.index("CPRESS")][touching]
        overclosure = max(0.0, float(-np.nanmin(opening)))
        share = 1 - float(weights[~(pressure > _STRESS_FREE)].sum() / weights.sum())
    displacement, strain = state.fields["DISP"][:count], state.fields["TOSTRAIN"][:count]
    return Reached(forces, displacement, strain, pressure, overclosure, share)


def _patch_areas(mesh: Mesh) -> np.ndarray:
    """Area (nodes,) of the wefts' contact patches, mm2, shared among the corners of their faces."""
    areas, patches = np.zeros(len(mesh.points)), touching_faces(mesh)
    for name in ("weft_top", "weft_bottom"):
        quads = face_quads(mesh, patches[name])
        np.add.at(areas, quads, np.linalg.norm(area_vectors(mesh, quads), axis=1)[:, None] / 4)
    return areas
