"""The space of a composite cell in which fluid flows, and where it may not move."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from ..composite.cell import CompositeCell
from ..composite.homogenisation.periodicity import PeriodicMesh
from ..model.solved import SolvedFabric
from ..weave.bodies import SurfaceKind
from ..yarn.swept import swept_yarns
from .quadratic import QuadraticMesh
from .walls import Skin, curved

_ON_FACE = 1e-7  # of the cell's height


class Top(StrEnum):
    """What lies above and below the cell.

    ``periodic``: the same cell, layer upon layer in phase; ``plates``: rigid plates; ``open``: a
    plate below, above a level surface without friction (free, or the mirror plane between two
    layers).
    """

    PERIODIC = "periodic"
    PLATES = "plates"
    OPEN = "open"


def space_between(cell: CompositeCell, fabric: SolvedFabric, top: Top) -> QuadraticMesh:
    """What is not yarn of a composite cell, with its nodes on the yarns' exact faces."""
    return _space(cell, fabric, top, cell.in_matrix)


def whole_space(cell: CompositeCell, fabric: SolvedFabric, top: Top) -> QuadraticMesh:
    """All of a composite cell, its elements in the cell's order, with nodes on the yarns' exact faces."""
    return _space(cell, fabric, top, np.ones(len(cell.mesh.hexahedra), dtype=bool))


def _space(
    cell: CompositeCell, fabric: SolvedFabric, top: Top, chosen: np.ndarray
) -> QuadraticMesh:
    used, corners = np.unique(cell.mesh.hexahedra[chosen], return_inverse=True)
    number = np.full(len(cell.mesh.points), -1)
    number[used] = np.arange(len(used))

    mesh = PeriodicMesh(
        cell.mesh.points[used],
        corners.reshape(-1, 8),
        *cell.repeats(fabric.lattice),
        periodic=(True, True, top is Top.PERIODIC),
    )

    yarns = swept_yarns(fabric)
    skins = [
        Skin(yarn, number[cell.mesh.quads_of(yarn.yarn.body, SurfaceKind.MATRIX)]) for yarn in yarns
    ]
    return curved(QuadraticMesh.straight(mesh), fabric, skins, cell.shift)


def held(mesh: QuadraticMesh, top: Top) -> np.ndarray:
    """Velocities (nodes, 3) that vanish: on walls all, on a surface without friction that across it."""
    fixed = np.zeros((len(mesh.points), 3), dtype=bool)
    faces = mesh.boundary
    if top is not Top.OPEN:
        fixed[faces] = True
        return fixed

    ceiling = mesh.mesh.origin[2] + mesh.mesh.vectors[2, 2]
    above = (mesh.points[faces, 2] > ceiling - _ON_FACE * mesh.mesh.vectors[2, 2]).all(axis=1)
    fixed[faces[~above]] = True
    fixed[faces[above], 2] = True
    return fixed
