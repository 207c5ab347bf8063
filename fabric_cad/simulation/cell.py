"""The cell that is loaded: built, meshed as its settings ask for, and measured."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from ..errors import BuildError
from ..meshing.mesh import Mesh
from ..pipeline import Stages
from ..solved import SolvedFabric
from ..tables import Family
from .settings import Settings


@dataclass(frozen=True, eq=False)
class Cell:
    """The cell that is loaded: its fabric, its mesh, and what was measured on the mesh."""

    fabric: SolvedFabric
    mesh: Mesh
    quality: dict[str, float]


def loaded_cell(row: Family, settings: Settings, options: dict[str, int | float], folder: Path, stages: Stages) -> Cell:
    """The cell of a table of one row; its STEP and mesh pass through files in ``folder``.

    ``options``, keywords of :func:`fabric_cad.mesh_options`, win over the settings' mesh. Raises
    :class:`InputError` where they do not fit, :class:`BuildError` where the mesh is unsound.
    """
    from ..identification import identify
    from ..meshing.options import mesh_options
    from ..report import contact_pairing, end_pairing

    with stages("identify"):
        fabric = identify(row)[row.names[0]]
    asked = options if "size" in options else {k: v for k, v in asdict(settings.mesh).items() if v} | options
    chosen = mesh_options(fabric, **asked)
    with stages("solids"):
        from ..masters import build_cell

        solids = build_cell(fabric)
    step, msh = folder / "cell.step", folder / "cell.msh"
    with stages("write STEP"):
        solids.write_step(step)
    with stages("mesh"):
        from ..meshing.mesher import mesh_cell, read_mesh

        mesh_cell(step, fabric, chosen, msh)
        mesh = read_mesh(msh)
    step.unlink()
    msh.unlink()
    with stages("quality"):
        from ..views import scaled_jacobians

        worst = float(scaled_jacobians(mesh).min())
        contact, ends = contact_pairing(mesh), end_pairing(mesh, fabric.period)
    if not worst > 0 or contact.nodes != contact.paired or ends.nodes != ends.paired:
        raise BuildError(f"{fabric.name}: the mesh has elements turned inside out or nodes without their partner")
    quality = {
        "nodes": len(mesh.points),
        "hexahedra": len(mesh.hexahedra),
        "min_scaled_jacobian": worst,
        "contact_nodes": contact.nodes,
        "coincident_contact_nodes": contact.paired,
    }
    return Cell(fabric, mesh, quality)
