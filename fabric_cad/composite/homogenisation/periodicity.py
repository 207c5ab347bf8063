"""Which nodes of a cell are the same by its periods."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...support.errors import BuildError

_NEAR = 1e-7  # of a period: nodes nearer than this to a face, or to each other's image, are on it


@dataclass(frozen=True, eq=False)
class PeriodicMesh:
    """Hexahedra of a cell that repeats.

    ``points`` (nodes, 3) mm; ``hexahedra`` (elements, 8), corners as in VTK and C3D8; ``vectors``
    (3, 3): the cell's three edges as rows, mm, from its corner ``origin`` (3,); ``periodic`` says
    along which of them it repeats.
    """

    points: np.ndarray
    hexahedra: np.ndarray
    vectors: np.ndarray
    origin: np.ndarray
    periodic: tuple[bool, bool, bool] = (True, True, True)

    @property
    def volume(self) -> float:
        """Of the parallelepiped, mm3."""
        return float(abs(np.linalg.det(self.vectors)))


def periodic_pairs(mesh: PeriodicMesh) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (pairs,) on the far faces of the cell, and for each the node (pairs,) whose image it is.

    Of a node that lies on several far faces that is the one on none. Raises :class:`BuildError`
    where faces do not match node by node.
    """
    from scipy.spatial import cKDTree

    shares = (mesh.points - mesh.origin) @ np.linalg.inv(mesh.vectors)
    far = (np.abs(shares - 1.0) < _NEAR) & np.array(mesh.periodic)
    near = (np.abs(shares) < _NEAR) & np.array(mesh.periodic)
    slaves = np.flatnonzero(far.any(axis=1))
    masters = np.flatnonzero(near.any(axis=1) & ~far.any(axis=1))
    if not len(slaves):
        return slaves, slaves

    wanted = shares[slaves] - far[slaves]
    distance, partner = map(np.asarray, cKDTree(shares[masters]).query(wanted))
    if distance.max() > _NEAR:
        worst = mesh.points[slaves[int(np.argmax(distance))]]
        place = ", ".join(f"{value:.6g}" for value in worst)
        raise BuildError(
            f"the faces of the cell do not match: the node at ({place}) mm has no image a period away"
        )

    for axis in np.flatnonzero(
        mesh.periodic
    ):  # a plain count, so that no near face has nodes of its own
        if np.count_nonzero(far[:, axis]) != np.count_nonzero(near[:, axis]):
            counts = f"{np.count_nonzero(near[:, axis])} and {np.count_nonzero(far[:, axis])}"
            raise BuildError(
                f"the faces of the cell do not match: there are {counts} nodes on two faces that repeat"
            )

    return slaves, masters[partner]
