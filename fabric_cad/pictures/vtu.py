"""A mesh as a file for ParaView."""

from __future__ import annotations

from pathlib import Path

from ..meshing.grids import described
from ..meshing.mesh import Mesh
from ..meshing.quality import Quality
from ..support.vtk import grid_writer


def write_vtu(mesh: Mesh, quality: Quality, path: str | Path) -> None:
    """Write the mesh for ParaView.

    Cell data are the yarn's number (from 1), direction (0 weft, 1 warp), fibre axis and, of the
    quality, ``scaled_jacobian``, ``opposite_edge_ratio``, ``least_angle`` (deg) and ``aspect``.
    Raises OSError where the file cannot be written whole.
    """
    grid = described(mesh)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    for name in ("scaled_jacobian", "opposite_edge_ratio", "least_angle", "aspect"):
        grid.cell_data[name] = getattr(quality, name)
    write_grid(grid, path)


def write_grid(grid, path: str | Path) -> None:
    """Write a grid as ``.vtu``. Raises OSError where the file cannot be written whole."""
    Path(path).write_bytes(b"")  # raises where there is no writing at all, which VTK does not tell
    writer = grid_writer()
    writer.SetInputData(grid)
    writer.SetCompressionLevel(1)
    writer.SetFileName(str(path))
    if not writer.Write() or writer.GetErrorCode():
        raise OSError(f"{path}: the file could not be written")
