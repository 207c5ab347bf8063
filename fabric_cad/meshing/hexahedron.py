"""The hexahedron: corners, edges, faces, slopes, in the one order that gmsh, VTK and C3D8 share.

::

            7-------6          corner   natural coordinates      face   corners, seen from outside
           /|      /|                                            S1     0 1 2 3   (clockwise)
          4-------5 |          0        -1 -1 -1                 S2     4 7 6 5   (clockwise)
          | |     | |          1         1 -1 -1                 S3     0 4 5 1   (clockwise)
          | 3-----|-2          2         1  1 -1                 S4     1 5 6 2   (clockwise)
      t   |/      |/           3        -1  1 -1                 S5     2 6 7 3   (clockwise)
      | s 0-------1            4 ... 7  the same at t = 1        S6     3 7 4 0   (clockwise)
      |/
      +--- r                   A yarn's hexahedra have their first face (S1) towards its start.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from ..support.arrays import read_only

CORNERS = read_only(
    np.array(
        [
            [-1, -1, -1],
            [1, -1, -1],
            [1, 1, -1],
            [-1, 1, -1],
            [-1, -1, 1],
            [1, -1, 1],
            [1, 1, 1],
            [-1, 1, 1],
        ]
    )
)
"""Natural coordinates r, s, t of the corners, shape (8, 3)."""

EDGES = read_only(
    np.array(
        [
            [(0, 1), (3, 2), (4, 5), (7, 6)],
            [(0, 3), (1, 2), (4, 7), (5, 6)],
            [(0, 4), (1, 5), (2, 6), (3, 7)],
        ]
    )
)
"""The four edges along r, s and t, each from its lower to its upper end; shape (3, 4, 2)."""

FACES = read_only(
    np.array(
        [
            [0, 1, 2, 3],
            [4, 7, 6, 5],
            [0, 4, 5, 1],
            [1, 5, 6, 2],
            [2, 6, 7, 3],
            [3, 7, 4, 0],
        ]
    )
)
"""Corners of the faces S1 ... S6 of C3D8, shape (6, 4)."""

LENGTHWISE = EDGES[2]
"""The four edges that follow a yarn, from its start on; shape (4, 2)."""

GAUSS_POINTS = read_only(np.array(list(product((-1.0, 1.0), repeat=3))) / np.sqrt(3))
"""Natural coordinates of the 2 x 2 x 2 Gauss points of C3D8, each of weight 1; shape (8, 3)."""


def shape_slopes(place: np.ndarray) -> np.ndarray:
    """Derivatives (8, 3) of the corners' trilinear shape functions by r, s, t at a natural ``place`` (3,)."""
    factors = 1 + CORNERS * place
    slopes = [CORNERS[:, i] * factors[:, (i + 1) % 3] * factors[:, (i + 2) % 3] for i in range(3)]
    return np.stack(slopes, axis=1) / 8


def hexahedra_volumes(corners: np.ndarray) -> np.ndarray:
    """Volumes (elements,) of trilinear hexahedra from their ``corners`` (elements, 8, 3).

    The Jacobian's determinant is quadratic in each natural coordinate: two Gauss points are exact.
    """
    volumes = np.zeros(len(corners))
    for place in GAUSS_POINTS:
        jacobian = np.einsum("eni,nj->eij", corners, shape_slopes(place))
        volumes += np.linalg.det(jacobian)
    return volumes
