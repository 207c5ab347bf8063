"""A composite cell: yarns and the matrix between them, as one conforming mesh of hexahedra."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..meshing.mesh import Mesh
from ..weave.bodies import Body, BodyKind
from ..weave.lattice import Lattice

BOX_FACES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")
"""The faces of the box, as files call them."""

MATRIX = Body(BodyKind.MATRIX)


@dataclass(frozen=True, eq=False)
class CompositeCell:
    """A composite cell in its box 0 <= x <= X, 0 <= y <= Y, -H/2 <= z <= H/2; lengths mm.

    ``mesh`` has the yarns in their order as bodies, and the matrix at the end. The surfaces of a
    yarn are its interface with the matrix (``weft_1_matrix``), what touches other yarns
    (``weft_1_contact``) and its ends. Nodes match across the box: the image of a node on x = 0 has
    exactly its y and z, and x = X; so in y and z.

    ``box`` maps :data:`BOX_FACES` to quadrilaterals (quads, 4) of the mesh; ``size`` (3,) is (X, Y,
    H), ``margin`` the clearance above and below the yarns, ``shift`` how far the yarns were moved
    up to stand at mid-height, ``closed_wedge`` the largest distance between two yarns that was
    closed (both moved to the middle).
    """

    mesh: Mesh
    box: Mapping[str, np.ndarray]
    size: np.ndarray
    margin: float
    shift: float
    closed_wedge: float

    def repeats(self, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
        """The box's edges as vectors of space, (3, 3), and the corner (3,) they start from, mm."""
        height = self.size[2] * lattice.axes[2, 2]
        vectors = np.vstack([lattice.vectors, [0.0, 0.0, height]])
        return vectors, np.array([0.0, 0.0, -height / 2])

    @property
    def in_matrix(self) -> np.ndarray:
        """True (elements,) for the hexahedra of the matrix."""
        return self.mesh.body == self.mesh.bodies.index(MATRIX)
