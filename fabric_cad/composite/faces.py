"""The named surfaces of a composite cell: faces of the box, interfaces, contacts and ends."""

from __future__ import annotations

import numpy as np

from ..meshing.hexahedron import FACES
from ..meshing.mesh import Mesh
from ..weave.bodies import Surface, SurfaceKind
from .cell import BOX_FACES


def box_faces(points: np.ndarray, hexahedra: np.ndarray, size: np.ndarray) -> dict[str, np.ndarray]:
    """Quadrilaterals (quads, 4) on the six faces of the box, by name; ``size`` (3,) in mm."""
    low, high = np.array([0.0, 0.0, -size[2] / 2]), np.array([size[0], size[1], size[2] / 2])
    planes = [(axis, ends[axis]) for axis in range(3) for ends in (low, high)]
    return {
        name: _faces_on(points[:, axis] == place, hexahedra)
        for name, (axis, place) in zip(BOX_FACES, planes)
    }


def _faces_on(lies: np.ndarray, hexahedra: np.ndarray) -> np.ndarray:
    """The faces of hexahedra all of whose corners lie (nodes,) on a plane."""
    near = hexahedra[np.count_nonzero(lies[hexahedra], axis=1) == 4]
    faces = near[:, FACES]
    return faces[lies[faces].all(axis=2)]


def yarn_faces(yarns: Mesh, crossing: np.ndarray) -> dict[Surface, np.ndarray]:
    """The yarns' surfaces in a composite, in the nodes of their own mesh.

    ``crossing`` (nodes,) is the crossing in whose contact a node lies, -1 in none. What of a yarn's
    skin lies in a contact touches another yarn, all else the matrix.
    """
    surfaces = {}
    for yarn in yarns.yarns:
        skin = yarns.quads_of(yarn, SurfaceKind.CONTACT, SurfaceKind.FREE)
        met = crossing[skin]
        touching = (met[:, 0] >= 0) & (met == met[:, :1]).all(axis=1)
        surfaces[Surface(yarn, SurfaceKind.MATRIX)] = skin[~touching]
        surfaces[Surface(yarn, SurfaceKind.CONTACT)] = skin[touching]
        for end in (SurfaceKind.START, SurfaceKind.END):
            surfaces[Surface(yarn, end)] = yarns.quads_of(yarn, end)

    return surfaces
