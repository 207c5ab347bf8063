"""A mesh as VTK's unstructured grid, and files for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...meshing.mesh import Mesh
from ...meshing.quality import Quality
from ...support.interrupts import uninterrupted
from ...weave.weaves import DIRECTIONS, direction_of
from .library import pyvista


def grid_of(mesh: Mesh):
    """The mesh as VTK's unstructured grid."""
    vtk = pyvista()
    return vtk.UnstructuredGrid({vtk.CellType.HEXAHEDRON: mesh.hexahedra}, mesh.points)


def write_vtu(mesh: Mesh, quality: Quality, path: str | Path) -> None:
    """Write the mesh for ParaView with yarn number (from 1), direction (0 weft, 1 warp), fibre axis and quality.

    Of the quality: ``scaled_jacobian``, ``opposite_edge_ratio``, ``least_angle`` (deg) and ``aspect``.
    Raises OSError where the file cannot be written whole.
    """
    grid = described(mesh)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    for name in ("scaled_jacobian", "opposite_edge_ratio", "least_angle", "aspect"):
        grid.cell_data[name] = getattr(quality, name)
    write_grid(grid, path)


def described(mesh: Mesh):
    """The mesh with yarn number and direction of every element."""
    grid = grid_of(mesh)
    direction = np.array([DIRECTIONS.index(direction_of(name)) for name in mesh.yarns])
    grid.cell_data["yarn"] = mesh.yarn.astype(np.int32) + 1
    grid.cell_data["direction"] = direction[mesh.yarn].astype(np.int8)
    return grid


def pyvista_grid(mesh: Mesh):
    """The hexahedra as :meth:`fabric_cad.meshing.Mesh.to_pyvista` describes them."""
    grid = described(mesh)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    grid.field_data["yarn_names"] = list(mesh.yarns)
    return grid


def pyvista_blocks(mesh: Mesh):
    """The hexahedra as ``yarns`` and every surface under its name, in one MultiBlock."""
    vtk = pyvista()
    blocks = vtk.MultiBlock({"yarns": pyvista_grid(mesh)})
    for name, quads in mesh.surfaces.items():
        nodes, corners = np.unique(quads, return_inverse=True)
        blocks[name] = vtk.PolyData.from_regular_faces(mesh.points[nodes], corners.reshape(-1, 4))
        blocks[name].point_data["node"] = nodes
    return blocks


def write_grid(grid, path: str | Path) -> None:
    """Write a grid as ``.vtu``. Raises OSError where the file cannot be written whole."""
    with uninterrupted():
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    Path(path).write_bytes(b"")  # raises where there is no writing at all, which VTK does not tell
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetCompressionLevel(1)
    writer.SetFileName(str(path))
    if not writer.Write() or writer.GetErrorCode():
        raise OSError(f"{path}: the file could not be written")
