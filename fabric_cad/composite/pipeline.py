"""From a measured row to the files of its composite cell."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..cell.pipeline import Stages
from ..cell.traces import renew_digests, trace, write_traced
from ..measured.tables import Family, expect_row
from ..model.identification import identify
from ..model.plausibility import implausible
from ..model.solved import SolvedFabric
from ..support.errors import InputError
from ..support.interrupts import uninterrupted
from ..support.staging import staged
from .cell import CompositeCell
from .constituents import read_constituents
from .fibres import fibre_sections
from .matrix import mesh_composite
from .options import USUAL, CompositeOptions
from .report import Figures, composite_report, doubts, figures_of, solids_report
from .spacing import composite_mesh_options

NAME = "composite"
"""What all files of a composite cell are called."""

KINDS = ("step", "msh", "inp", "vtu", "png", "json")


def make_composite(
    row: Family,
    families: str | Path,
    out: str | Path,
    mesh: Mapping[str, Any] | None = None,
    options: CompositeOptions = USUAL,
    *,
    dialect: str = "calculix",
    stages: Stages | None = None,
) -> dict[str, Any]:
    """Make every file of one row's composite cell in the folder ``out/<row name>`` and return its report.

    ``row`` is a table of one row; ``families`` the folder whose ``composite.toml`` holds, where it
    has one; ``mesh`` holds keywords of :func:`fabric_cad.composite.spacing.composite_mesh_options`.
    Raises :class:`FabricCadError`; the folder then is as it was.
    """
    expect_row(row)
    stages = stages or Stages()
    (name,) = row.names
    table = identify(row)
    fabric = table[name]
    fineness = composite_mesh_options(fabric, **(mesh or {}))

    with staged(Path(out) / name, renew_digests) as folder:
        with stages("mesh"):
            cell = mesh_composite(fabric, fineness, options)
        with stages("write msh"):
            written = _write_msh(cell, folder / f"{NAME}.msh")
        with stages("measure"):
            fractions, warnings = _fractions(row, families, fabric, cell)
            figures = figures_of(written, fractions)

        with stages("write deck"):
            _write_deck(cell, folder, f"composite cell of {name}", dialect)
        with stages("write vtu"):
            _write_vtu(cell, figures, folder / f"{NAME}.vtu")
        with stages("picture"):
            _draw(cell, folder / f"{NAME}.png", name)

        volumes = _write_step(fabric, cell, folder / f"{NAME}.step", stages)

        report = composite_report(fabric, options, cell, written, figures)
        report |= solids_report(volumes, cell)
        report["seconds"] = {stage: round(seconds, 4) for stage, seconds in stages.seconds.items()}
        report |= trace(row, fineness)
        told = [*map(str, implausible(row, table.columns)), *warnings, *doubts(report)]
        report["warnings"] = told
        write_traced(report, folder / f"{NAME}.json")

    return report


def _fractions(
    row: Family, families: str | Path, fabric: SolvedFabric, cell: CompositeCell
) -> tuple[np.ndarray, list[str]]:
    """Fibre fraction (elements,) where it is known, and what to warn of where it cannot be."""
    with uninterrupted():
        from .materials import element_fractions

    try:
        sections = fibre_sections(row, read_constituents(families, fabric.name))
        return element_fractions(cell.mesh, fabric, sections), []
    except InputError as error:
        unknown = np.where(cell.in_matrix, 0.0, np.nan)
        return unknown, [f"no fibre fractions: {problem}" for problem in error.problems]


def _write_step(
    fabric: SolvedFabric, cell: CompositeCell, path: Path, stages: Stages
) -> dict[str, float]:
    """Write the solids of yarns and matrix; their volumes, mm3, as read back."""
    with stages("load CadQuery"), uninterrupted():
        from ..cad import read_step
        from ..cad.matrix import checked_volumes
        from .solids import build_composite

    with stages("solids"):
        solids = build_composite(fabric, cell.size)
    with stages("write STEP"):
        solids.write_step(path)
    with stages("inspect STEP"):
        return checked_volumes(read_step(path), cell.size)


def _write_msh(cell: CompositeCell, path: Path):
    """Write the mesh, and read it back."""
    with uninterrupted():
        from ..meshing import read_mesh
        from ..meshing.writing import write_mesh

    write_mesh(cell.mesh, path, cell.box)
    return read_mesh(path)


def _write_deck(cell: CompositeCell, folder: Path, title: str, dialect: str) -> None:
    with uninterrupted():
        from ..decks.composite import write_composite_deck

    write_composite_deck(cell.mesh, cell.box, folder / f"{NAME}.inp", title, dialect)


def _write_vtu(cell: CompositeCell, figures: Figures, path: Path) -> None:
    """Write the mesh for ParaView: ``body`` (0 matrix, 1 ... yarns), fibre axis and fraction, scaled Jacobian."""
    with uninterrupted():
        from ..meshing.grids import grid_of
        from ..meshing.mesh import yarn_numbers
        from ..pictures.vtu import write_grid

    grid = grid_of(cell.mesh)
    grid.cell_data["body"] = yarn_numbers(cell.mesh).astype(np.int32)[cell.mesh.body]
    grid.cell_data["fibre_axis"] = cell.mesh.fibre_axes()
    grid.cell_data["fibre_fraction"] = figures.fibre_fraction
    grid.cell_data["scaled_jacobian"] = figures.scaled_jacobian
    grid.field_data["yarn_names"] = [body.name for body in cell.mesh.yarns]
    write_grid(grid, path)


def _draw(cell: CompositeCell, path: Path, title: str) -> None:
    with uninterrupted():
        from ..pictures.composite import draw_composite

    draw_composite(cell.mesh, path, title)
