"""Hexahedra of a cell; gmsh stays behind :mod:`fabric_cad.meshing.mesher`."""

from . import edged, round  # noqa: F401 - the forms that can be meshed
from .mesh import Mesh
from .mesher import mesh_cell, read_mesh
from .options import MeshOptions, mesh_options

__all__ = ["Mesh", "MeshOptions", "mesh_cell", "mesh_options", "read_mesh"]
