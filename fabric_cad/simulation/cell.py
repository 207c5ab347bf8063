"""The cell that is loaded: built, meshed as its settings ask for, and measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from ..cell.pipeline import Stages, checked_report, make_mesh, make_step
from ..cell.report import CellReport
from ..measured.tables import Family
from ..meshing.mesh import Mesh
from ..meshing.options import MeshOptions, mesh_options
from ..model.solved import SolvedFabric
from .settings import Settings


@dataclass(frozen=True, eq=False)
class Cell:
    """The cell that is loaded: its fabric, its mesh and how fine it is, and what was measured on its files."""

    fabric: SolvedFabric
    mesh: Mesh
    options: MeshOptions
    report: CellReport


def loaded_cell(
    row: Family, settings: Settings, options: Mapping, folder: Path, stages: Stages
) -> Cell:
    """The cell of a table of one row, with its STEP and mesh file in ``folder``.

    ``options``, keywords of :func:`fabric_cad.mesh_options`, win over the settings' mesh. Raises
    :class:`InputError` where they do not fit, :class:`BuildError` where the cell is not consistent.
    """
    asked = (
        options
        if "size" in options
        else {k: v for k, v in asdict(settings.mesh).items() if v} | dict(options)
    )
    made = make_step(row, folder, stages)
    used = mesh_options(made.fabric, **asked)
    meshed = make_mesh(made, used, stages)

    return Cell(made.fabric, meshed.mesh, used, checked_report(made, meshed, stages))
