"""``fabric-cad show``: a row's cell in a window."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..options import Command, RowOptions, declare_rows
from ..rows import work_on_rows
from ..voice import Voice
from . import cell


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``show``."""
    declare_rows(parser, with_all=False)


def run(options: RowOptions, voice: Voice) -> int:
    """Show the cells of rows, one window after the other."""
    return work_on_rows(options, voice, lambda name: _show(name, options, voice))


def _show(name: str, options: RowOptions, voice: Voice) -> None:
    """Show the cell of one row; it is made, with the default mesh, where it is not there."""
    mesh_file = Path(options.out) / name / f"{name}.msh"
    if not mesh_file.exists():
        as_made = cell.CellOptions(families=options.families, out=options.out, rows=options.rows)
        cell.make(name, as_made, voice)

    from ...meshing import read_mesh
    from ...pictures import show_cell

    show_cell(read_mesh(mesh_file), name)


COMMAND = Command(
    name="show",
    text="show a row's cell in a window; makes it first if it is not there",
    options=RowOptions,
    run=run,
    declare=declare,
)
