"""``fabric-cad cell``: CAD, mesh, deck, picture and report of rows."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

from ..options import Command, MeshedRowOptions, declare_deck, declare_mesh, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice

_KINDS = ("step", "msh", "inp", "vtu", "png")


@dataclass(frozen=True, kw_only=True)
class CellOptions(MeshedRowOptions):
    """Rows, their meshes and the dialect of the deck."""

    deck: str = "calculix"


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``cell``."""
    declare_rows(parser)
    declare_mesh(parser)
    declare_deck(
        parser,
        "dialect of the .inp; abaqus adds the *DISTRIBUTION TABLE that CalculiX does not know "
        "(default: calculix)",
        default="calculix",
    )


def run(options: CellOptions, voice: Voice) -> int:
    """Make the cells of rows."""
    return work_on_rows(options, voice, lambda name: make(name, options, voice))


def make(name: str, options: CellOptions, voice: Voice) -> None:
    """Make the cell of one row in OUT/<row>."""
    from ...cell.pipeline import Stages, make_cell
    from ...cell.summary import summary
    from ...meshing.count import hexahedra
    from ...meshing.options import mesh_options
    from ...model.identification import identify

    row = find_row(name, options, voice)
    if not voice.quiet:
        fabric = identify(row)[name]
        count = hexahedra(fabric, mesh_options(fabric, **options.mesh))
        voice.remark(f"  {count} hexahedra to make")

    report = make_cell(row, options.out, options.mesh, options.deck, Stages(voice.stage))
    voice.warn(report["warnings"])
    if voice.quiet:
        return

    files = (*(f"{name}.{kind}" for kind in _KINDS), "solved.csv", "report.json")
    voice.written(summary(report), (Path(options.out) / name / file for file in files))


COMMAND = Command(
    name="cell",
    text="make the STEP, mesh, deck, picture and report of rows, each in OUT/<row>",
    options=CellOptions,
    run=run,
    declare=declare,
)
