"""What has to hold of the mesh of every composite cell."""

import numpy as np
import pytest

from fabric_cad.composite.cell import BOX_FACES
from fabric_cad.meshing.hexahedron import FACES, hexahedra_volumes


def face_counts(hexahedra):
    """Faces as sorted corners, and in how many hexahedra each is."""
    corners = np.sort(hexahedra[:, FACES].reshape(-1, 4), axis=1)
    return np.unique(corners, axis=0, return_counts=True)


def check_fills(cell):
    """The box is filled once: exact volumes, all positive, add up, and every face is in two elements or on the box."""
    mesh = cell.mesh
    volumes = hexahedra_volumes(mesh.points[mesh.hexahedra])
    assert volumes.min() > 0
    assert volumes.sum() == pytest.approx(cell.size.prod(), rel=1e-12)

    faces, times = face_counts(mesh.hexahedra)
    assert times.max() == 2
    outside = np.vstack(list(cell.box.values()))
    assert set(map(tuple, faces[times == 1])) == set(map(tuple, np.sort(outside, axis=1)))


def check_repeats(cell):
    """Nodes of opposite faces of the box match; the box is where it is said to be."""
    points = cell.mesh.points
    low = [0.0, 0.0, -cell.size[2] / 2]
    for axis, (one, other) in enumerate(zip(BOX_FACES[::2], BOX_FACES[1::2])):
        start, end = (points[np.unique(cell.box[name])] for name in (one, other))
        assert (start[:, axis] == low[axis]).all() and end[:, axis] == pytest.approx(
            low[axis] + cell.size[axis]
        )
        start, end = (np.delete(side, axis, axis=1) for side in (start, end))
        start, end = (side[np.lexsort(np.round(side, 9).T)] for side in (start, end))
        assert start == pytest.approx(end, abs=1e-12, rel=0)
