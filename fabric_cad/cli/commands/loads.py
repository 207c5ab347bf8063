"""``fabric-cad tension`` and ``fabric-cad shear``: the cell of rows under load, with CalculiX."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...support.numerals import number, whole
from ..options import Command, MeshedRowOptions, declare_mesh, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice


@dataclass(frozen=True, kw_only=True)
class LoadOptions(MeshedRowOptions):
    """Rows, their meshes and the solver; with ``deck``, a dialect, decks are written alone."""

    ccx: str | None = None
    threads: int | None = None
    time_limit: float = 3600.0
    deck: str | None = None


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of a load case."""
    declare_rows(parser)
    declare_mesh(parser, default=" (default: simulation.toml)")
    parser.add_argument(
        "--ccx",
        metavar="PATH",
        help="the CalculiX solver (default: ccx on the PATH)",
    )
    parser.add_argument(
        "--threads",
        type=_positive(whole),
        metavar="N",
        help="threads of the solver (default: all cores)",
    )
    parser.add_argument(
        "--time-limit",
        type=_positive(number),
        metavar="S",
        default=3600.0,
        help="seconds for a solver job (default 3600)",
    )
    parser.add_argument(
        "--deck",
        choices=("calculix", "abaqus"),
        help="write the deck in a solver's dialect and run nothing",
    )


def _positive(kind: Callable[[str], float]) -> Callable[[str], float]:
    """An option's reader: what ``kind`` reads, above 0."""

    def read(text: str) -> float:
        value = kind(text)
        if not value > 0:
            raise ValueError
        return value

    read.__name__ = f"{kind.__name__} above 0"  # argparse names it to the user
    return read


def run_tension(options: LoadOptions, voice: Voice) -> int:
    """Stretch the cells of rows."""
    from ...simulation.run import make_tension

    def work(name: str) -> None:
        _load(name, "tension", make_tension, options, voice)

    return work_on_rows(options, voice, work)


def run_shear(options: LoadOptions, voice: Voice) -> int:
    """Shear the cells of rows."""
    from ...simulation.run import make_shear

    def work(name: str) -> None:
        _load(name, "shear", make_shear, options, voice)

    return work_on_rows(options, voice, work)


Maker = Callable[..., dict[str, Any]]
"""Runs a load case of a row; its report."""


def _load(name: str, kind: str, make: Maker, options: LoadOptions, voice: Voice) -> None:
    """Run a case of one row, or write its decks alone."""
    from ...cell.pipeline import Stages
    from ...simulation.job import Solver
    from ...simulation.report import summary
    from ...simulation.run import write_case
    from ...simulation.solver import find_solver
    from ...support.cores import cores

    row = find_row(name, options, voice)
    how: dict[str, Any] = {"mesh": options.mesh, "stages": Stages(voice.stage)}
    if options.deck:
        decks = write_case(kind, row, options.families, options.out, options.deck, **how)
        voice.files(decks)
        return

    threads = options.threads or cores()
    solver = Solver(find_solver(options.ccx), threads, options.time_limit, voice.increment)
    report = make(row, options.families, options.out, solver, **how)
    voice.warn(report["warnings"])
    if voice.quiet:
        return

    voice.summary(summary(report))
    files = sorted([*report["files"], f"{kind}.json"])
    voice.files(Path(options.out) / name / file for file in files)
    voice.flush()


_PLACE = "materials and loads: FAMILIES/simulation.toml"

TENSION = Command(
    name="tension",
    text=f"stretch a row's cell biaxially with CalculiX: curves and surfaces of tension; {_PLACE}",
    options=LoadOptions,
    run=run_tension,
    declare=declare,
)
SHEAR = Command(
    name="shear",
    text=f"shear a row's cell with CalculiX: moment and force against the angle; {_PLACE}",
    options=LoadOptions,
    run=run_shear,
    declare=declare,
)
