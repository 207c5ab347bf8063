"""Hexahedra of a cell; gmsh stays behind :mod:`fabric_cad.meshing.gmsh_session`."""

from . import edged, round  # noqa: F401 - the forms that can be meshed
from .mesh import Mesh
from .mesher import mesh_cell
from .options import MeshOptions, mesh_options
from .reading import read_mesh

__all__ = ["Mesh", "MeshOptions", "mesh_cell", "mesh_options", "read_mesh"]
