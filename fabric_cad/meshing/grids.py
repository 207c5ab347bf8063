"""A mesh as VTK's unstructured grid."""

from __future__ import annotations

import numpy as np

from ..support.vtk import pyvista
from .mesh import Mesh, yarn_numbers


def grid_of(mesh: Mesh):
    """The mesh as VTK's unstructured grid."""
    vtk = pyvista()
    return vtk.UnstructuredGrid({vtk.CellType.HEXAHEDRON: mesh.hexahedra}, mesh.points)


def described(mesh: Mesh):
    """The mesh with yarn number and direction of every element."""
    grid = grid_of(mesh)
    direction = np.array(
        [-1 if body.direction is None else body.direction.axis for body in mesh.bodies]
    )
    grid.cell_data["yarn"] = yarn_numbers(mesh).astype(np.int32)[mesh.body]
    grid.cell_data["direction"] = direction.astype(np.int8)[mesh.body]
    return grid


def pyvista_grid(mesh: Mesh):
    """The hexahedra as :meth:`fabric_cad.meshing.Mesh.to_pyvista` describes them."""
    grid = described(mesh)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    grid.field_data["yarn_names"] = [body.name for body in mesh.yarns]
    return grid


def pyvista_blocks(mesh: Mesh):
    """The hexahedra as ``yarns`` and every surface under its name, in one MultiBlock."""
    vtk = pyvista()
    blocks = vtk.MultiBlock({"yarns": pyvista_grid(mesh)})
    for surface, quads in mesh.surfaces.items():
        name = surface.name
        nodes, corners = np.unique(quads, return_inverse=True)
        blocks[name] = vtk.PolyData.from_regular_faces(mesh.points[nodes], corners.reshape(-1, 4))
        blocks[name].point_data["node"] = nodes
    return blocks
