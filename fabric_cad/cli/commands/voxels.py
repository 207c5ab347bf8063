"""``fabric-cad voxels``: the composite cell of rows on a regular grid."""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from pathlib import Path

from ..composite_options import declare_margin
from ..options import Command, RowOptions, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice


@dataclass(frozen=True, kw_only=True)
class VoxelOptions(RowOptions):
    """Rows, the voxels along x, y and z, and the clearance above and below the yarns."""

    cells: tuple[int, ...] = (100, 100, 30)
    margin: str | None = None


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``voxels``."""
    declare_rows(parser)
    parser.add_argument(
        "--cells",
        type=_counts,
        metavar="NXxNYxNZ",
        default=(100, 100, 30),
        help="voxels along x, y and z (default 100x100x30)",
    )
    declare_margin(parser)


def _counts(text: str) -> tuple[int, int, int]:
    if not (match := re.fullmatch(r"(\d{1,9})x(\d{1,9})x(\d{1,9})", text.strip().lower())):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not three numbers of voxels, such as 200x200x60"
        )

    return int(match[1]), int(match[2]), int(match[3])


def run(options: VoxelOptions, voice: Voice) -> int:
    """Make the voxels of rows."""
    return work_on_rows(options, voice, lambda name: make(name, options, voice))


def make(name: str, options: VoxelOptions, voice: Voice) -> None:
    """Make the voxels of one row in OUT/<row>."""
    from ...cell.pipeline import Stages
    from ...composite.options import Margin
    from ...composite.voxel_run import make_voxels

    row = find_row(name, options, voice)
    margin = Margin() if options.margin is None else Margin.read(options.margin)
    counts = (options.cells[0], options.cells[1], options.cells[2])
    voxels = make_voxels(
        row, options.families, options.out, counts, margin=margin, stages=Stages(voice.stage)
    )

    share = sum(voxels.fractions().values())
    files = (Path(options.out) / name / f"voxels.{kind}" for kind in ("vti", "npz"))
    told = f"{name}: {'x'.join(map(str, counts))} voxels, {100 * share:.2f} % yarns"
    voice.written(told, files)


COMMAND = Command(
    name="voxels",
    text="put the composite cell of rows on a regular grid, for FFT and voxel solvers: yarn, fibre axis and fraction",
    options=VoxelOptions,
    run=run,
    declare=declare,
)
