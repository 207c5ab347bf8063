"""A mesh as VTK's unstructured grid."""

from __future__ import annotations

import numpy as np

from ..support.vtk import pyvista
from ..weave.weaves import DIRECTIONS, direction_of
from .mesh import Mesh


def grid_of(mesh: Mesh):
    """The mesh as VTK's unstructured grid."""
    vtk = pyvista()
    return vtk.UnstructuredGrid({vtk.CellType.HEXAHEDRON: mesh.hexahedra}, mesh.points)


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
