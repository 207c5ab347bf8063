"""How the nodes of a cell's mesh pair up: those in contact, and those of a yarn's two ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..meshing.mesh import Mesh
from ..weave.bodies import SurfaceKind
from ..weave.directions import DIRECTIONS
from ..weave.lattice import Lattice

COINCIDENT = 1e-9
"""Distance (mm) up to which two nodes, or two faces, count as at the same place."""


@dataclass(frozen=True)
class Pairing:
    """How nodes of a mesh pair up: of ``nodes``, ``paired`` have exactly one partner in place."""

    nodes: int
    paired: int


def contact_pairing(mesh: Mesh) -> Pairing:
    """Nodes on contact faces, and those that coincide with exactly one of the other direction."""
    from scipy.spatial import cKDTree

    weft, warp = (
        np.concatenate(
            [
                mesh.nodes_of(yarn, SurfaceKind.CONTACT)
                for yarn in mesh.yarns
                if yarn.direction is direction
            ]
        )
        for direction in DIRECTIONS
    )

    paired = 0
    for nodes, others in ((weft, warp), (warp, weft)):
        tree = cKDTree(mesh.points[others])
        partners = tree.query_ball_point(mesh.points[nodes], COINCIDENT, return_length=True)
        paired += int(np.count_nonzero(partners == 1))

    return Pairing(len(weft) + len(warp), paired)


def end_pairing(mesh: Mesh, lattice: Lattice) -> Pairing:
    """Nodes on the yarns' start sections, and those that match one on the end, a period further."""
    from scipy.spatial import cKDTree

    count = paired = 0
    for yarn in mesh.yarns:
        kinds = (SurfaceKind.START, SurfaceKind.END)
        start, end = (mesh.points[mesh.nodes_of(yarn, kind)] for kind in kinds)

        moved = start + lattice.vectors[yarn.direction.axis]
        partners = cKDTree(end).query_ball_point(moved, COINCIDENT, return_length=True)
        count += len(start)
        paired += int(np.count_nonzero(partners == 1)) if len(start) == len(end) else 0
    return Pairing(count, paired)
