"""``fabric-cad composite``: yarns and the matrix between them, meshed with hexahedra."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

from ..composite_options import BoxOptions, declare_box
from ..options import Command, declare_deck, declare_mesh, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice


@dataclass(frozen=True, kw_only=True)
class CompositeRowOptions(BoxOptions):
    """Rows, their meshes and boxes, how yarns meet, and the dialect of the deck."""

    contact: str = "bonded"
    deck: str = "calculix"


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``composite``."""
    declare_rows(parser)
    declare_mesh(parser)
    declare_box(parser)
    parser.add_argument(
        "--contact",
        choices=("bonded", "double"),
        default="bonded",
        help="yarns that touch share their nodes, or have nodes of their own inside their contact patches, the matrix "
        "bonded to them either way (default: bonded)",
    )
    declare_deck(parser, "dialect of the .inp (default: calculix)", default="calculix")


def run(options: CompositeRowOptions, voice: Voice) -> int:
    """Make the composite cells of rows."""
    return work_on_rows(options, voice, lambda name: make(name, options, voice))


def make(name: str, options: CompositeRowOptions, voice: Voice) -> None:
    """Make the composite cell of one row in OUT/<row>."""
    from ...cell.pipeline import Stages
    from ...composite.pipeline import KINDS, NAME, make_composite
    from ...composite.report import summary

    asked = replace(options.box, contact=options.contact)
    row = find_row(name, options, voice)
    report = make_composite(
        row,
        options.families,
        options.out,
        options.mesh,
        asked,
        dialect=options.deck,
        stages=Stages(voice.stage),
    )

    voice.warn(report["warnings"])
    files = (Path(options.out) / name / f"{NAME}.{kind}" for kind in KINDS)
    voice.written(summary(report), files)


COMMAND: Command[CompositeRowOptions] = Command(
    name="composite",
    text="make the composite cell of rows, the yarns and a matrix of hexahedra between them, each in OUT/<row>",
    options=CompositeRowOptions,
    run=run,
    declare=declare,
)
