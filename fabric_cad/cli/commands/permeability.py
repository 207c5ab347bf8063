"""``fabric-cad permeability``: how a fluid flows between the yarns of rows."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

from ...support.numerals import number, whole
from ..composite_options import BoxOptions, declare_margin
from ..options import Command, UsageError, declare_mesh, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice

_TOPS = ("periodic", "plates", "open")


@dataclass(frozen=True, kw_only=True)
class PermeabilityOptions(BoxOptions):
    """Rows, their meshes and boxes, what lies above them, and what is asked for beside the tensor."""

    top: str = "periodic"
    yarns: str = "rigid"
    fibre_diameter: float | None = None
    margin_study: bool = False


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``permeability``."""
    declare_rows(parser)
    declare_mesh(parser, default=" (default: coarser than a cell's, 6 across)")
    declare_margin(parser)
    parser.add_argument(
        "--layers",
        type=whole,
        metavar="N",
        help="layers of elements between the yarns and either face of the box (default 6)",
    )
    parser.add_argument(
        "--grading",
        type=number,
        metavar="R",
        help="height of the layer at the box over that at the yarns (default 32, with plates 1)",
    )
    parser.add_argument(
        "--top",
        choices=_TOPS,
        default=_TOPS[0],
        help="what lies above and below: the same layer in phase, plates, or a plate below and a level "
        "surface above (default: periodic)",
    )
    parser.add_argument(
        "--yarns",
        choices=("rigid", "porous"),
        default="rigid",
        help="rigid: flow between the yarns alone; porous: between their fibres too (default: rigid)",
    )
    parser.add_argument(
        "--fibre-diameter",
        type=number,
        metavar="UM",
        help="of the fibres in porous yarns, micrometres (default 7: carbon)",
    )
    parser.add_argument(
        "--margin-study",
        action="store_true",
        help="the tensor at half and at twice the margin too: it decides the result",
    )


def run(options: PermeabilityOptions, voice: Voice) -> int:
    """Solve the flow through the cells of rows."""
    return work_on_rows(options, voice, lambda name: make(name, options, voice))


def make(name: str, options: PermeabilityOptions, voice: Voice) -> None:
    """Solve the flow through the cell of one row into OUT/<row>."""
    from ...cell.pipeline import Stages
    from ...flow.pores import FIBRE_DIAMETER
    from ...flow.report import summary
    from ...flow.run import KINDS, NAME, make_permeability
    from ...flow.space import Top

    if options.yarns == "rigid" and options.fibre_diameter is not None:
        raise UsageError("--fibre-diameter goes with --yarns porous")

    row = find_row(name, options, voice)
    diameter = FIBRE_DIAMETER if options.fibre_diameter is None else options.fibre_diameter
    report = make_permeability(
        row,
        options.families,
        options.out,
        mesh=options.mesh,
        margin=options.box.margin,
        layers=options.layers,
        grading=options.grading,
        top=Top(options.top),
        margin_study=options.margin_study,
        fibre_diameter=diameter if options.yarns == "porous" else None,
        stages=Stages(voice.stage),
    )
    voice.warn(report.warnings)
    files = (Path(options.out) / name / f"{NAME}.{kind}" for kind in KINDS)
    voice.written(summary(report), files)


COMMAND = Command(
    name="permeability",
    text="how a fluid flows between the yarns of rows: the permeability tensor of the cell",
    options=PermeabilityOptions,
    run=run,
    declare=declare,
)
