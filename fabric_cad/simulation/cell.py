"""The cell that is loaded: built, meshed as its settings ask for, and measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from ..meshing.mesh import Mesh
from ..pipeline import Stages, checked_report, make_mesh, make_step
from ..solved import SolvedFabric
from ..tables import Family
from .settings import Settings


@dataclass(frozen=True, eq=False)
class Cell:
    """The cell that is loaded: its fabric, its mesh, and the report of what was measured on its files."""

    fabric: SolvedFabric
    mesh: Mesh
    report: dict


def loaded_cell(row: Family, settings: Settings, options: Mapping, folder: Path, stages: Stages) -> Cell:
    """The cell of a table of one row, with its STEP and mesh file in ``folder``.

    ``options``, keywords of :func:`fabric_cad.mesh_options`, win over the settings' mesh. Raises
    :class:`InputError` where they do not fit, :class:`BuildError` where the cell is not consistent.
    """
    from ..meshing.options import mesh_options

    asked = options if "size" in options else {k: v for k, v in asdict(settings.mesh).items() if v} | dict(options)
    made = make_step(row, folder, stages)
    meshed = make_mesh(made, mesh_options(made.fabric, **asked), stages)
    return Cell(made.fabric, meshed.mesh, checked_report(made, meshed, stages))
