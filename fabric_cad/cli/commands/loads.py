"""A command for every load case, such as ``fabric-cad tension``: the cell of rows under load, with CalculiX."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...simulation.loads import LoadCase, load_cases
from ...support.numerals import number, whole
from ..options import Command, MeshedRowOptions, declare_deck, declare_mesh, declare_rows
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
    declare_deck(parser, "write the deck in a solver's dialect and run nothing")


def _positive(kind: Callable[[str], float]) -> Callable[[str], float]:
    """An option's reader: what ``kind`` reads, above 0."""

    def read(text: str) -> float:
        value = kind(text)
        if not value > 0:
            raise ValueError
        return value

    read.__name__ = f"{kind.__name__} above 0"  # argparse names it to the user
    return read


def load_command(case: type[LoadCase[Any]]) -> Command[LoadOptions]:
    """The command of a load case, called as the case is."""

    def run(options: LoadOptions, voice: Voice) -> int:
        return work_on_rows(options, voice, lambda row: load(row, case.name, options, voice))

    text = f"{case.text}; materials and loads: FAMILIES/simulation.toml"
    return Command(name=case.name, text=text, options=LoadOptions, run=run, declare=declare)


def load(name: str, case: str, options: LoadOptions, voice: Voice) -> None:
    """Run a load case of one row, or write its decks alone."""
    from ...cell.pipeline import Stages
    from ...simulation.job import Solver
    from ...simulation.run import make_case, write_case
    from ...simulation.settings import read_settings
    from ...simulation.solver import find_solver
    from ...simulation.summary import summary
    from ...support.cores import cores

    row = find_row(name, options, voice)
    stages = Stages(voice.stage)
    if options.deck:
        settings = read_settings(options.families, name)
        decks = write_case(
            case, row, settings, options.out, dialect=options.deck, mesh=options.mesh, stages=stages
        )
        voice.files(decks)
        return

    solver = Solver(
        find_solver(options.ccx), options.threads or cores(), options.time_limit, voice.increment
    )
    settings = read_settings(options.families, name)
    report = make_case(
        case, row, settings, options.out, solver=solver, mesh=options.mesh, stages=stages
    )
    voice.warn(report.warnings)
    if voice.quiet:
        return

    files = sorted([*report.files, f"{case}.json"])
    voice.written(
        summary(report, settings.case(case)), (Path(options.out) / name / file for file in files)
    )


def load_commands() -> tuple[Command[Any], ...]:
    """A command for every load case there is."""
    return tuple(map(load_command, load_cases().values()))
