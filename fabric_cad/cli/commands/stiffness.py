"""``fabric-cad stiffness``: the homogenised properties of the composite of rows."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..composite_options import BoxOptions, declare_box
from ..options import Command, declare_deck, declare_mesh, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice


@dataclass(frozen=True, kw_only=True)
class StiffnessOptions(BoxOptions):
    """Rows, their meshes and boxes, and what is asked for beside the stiffness."""

    plate: bool = False
    deck: str | None = None


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``stiffness``."""
    declare_rows(parser)
    declare_mesh(parser, default=" (default: coarser than a cell's, 8 across)")
    declare_box(parser)
    parser.add_argument(
        "--plate",
        action="store_true",
        help="the cell as a plate with free floor and ceiling too: A, B and D",
    )
    declare_deck(
        parser, "write the same six load cases as a deck in a solver's dialect, and compute nothing"
    )


def run(options: StiffnessOptions, voice: Voice) -> int:
    """Homogenise the composites of rows."""
    return work_on_rows(options, voice, lambda name: make(name, options, voice))


def make(name: str, options: StiffnessOptions, voice: Voice) -> None:
    """Homogenise the composite of one row into OUT/<row>."""
    from ...cell.pipeline import Stages
    from ...composite.stiffness.run import KINDS, NAME, make_deck, make_stiffness
    from ...composite.stiffness.summary import summary

    row = find_row(name, options, voice)
    how: dict[str, Any] = {
        "mesh": options.mesh,
        "options": options.box,
        "stages": Stages(voice.stage),
    }
    if options.deck:
        voice.files([make_deck(row, options.families, options.out, dialect=options.deck, **how)])
        return

    report = make_stiffness(row, options.families, options.out, plate=options.plate, **how)
    voice.warn(report.warnings)
    files = (Path(options.out) / name / f"{NAME}.{kind}" for kind in KINDS)
    voice.written(summary(report), files)


COMMAND = Command(
    name="stiffness",
    text="homogenise the composite of rows: stiffness, expansion, conductivity; constituents: FAMILIES/composite.toml",
    options=StiffnessOptions,
    run=run,
    declare=declare,
)
