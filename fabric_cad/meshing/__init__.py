"""Hexahedra of a cell; gmsh stays behind :mod:`fabric_cad.meshing.mesher`."""

from .mesh import Mesh
from .mesher import mesh_cell, read_mesh
from .options import MeshOptions, mesh_options

__all__ = ["Mesh", "MeshOptions", "mesh_cell", "mesh_options", "read_mesh"]
