"""Nodes between corners put on the yarns' exact faces, and layers that follow them.

The faces are evaluated in closed form; what is added to a node midway is by how much the face is
higher there than the mean of its values at the corners, fading along the vertical line to nothing
at the box::

    ---- +H/2 ----------- 0
     .   .   .
    *---.*.---*           all of it: face (middle) - mean of face (corners)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..yarn.heights import heights
from ..yarn.swept import SweptYarn
from .lines import lines_of, vertical_links
from .quadratic import FACE_NODES, QuadraticMesh

_ON_FACE = 0.02  # of a yarn's thickness: corners nearer than this to a face are on it
_TURNS = 4
_CORNERS = [0, 2, 6, 8]  # among a face's nine nodes
_BETWEEN = {
    1: [0, 2],
    3: [0, 6],
    5: [2, 8],
    7: [6, 8],
    4: _CORNERS,
}  # and those between which the others lie


@dataclass(frozen=True, eq=False)
class Skin:
    """What of a yarn's skin lies in a mesh: the yarn, and quadrilaterals (quads, 4) in the mesh's corners."""

    swept: SweptYarn
    quads: np.ndarray


def curved(
    mesh: QuadraticMesh, fabric: SolvedFabric, skins: list[Skin], shift: float
) -> QuadraticMesh:
    """The mesh with the nodes of its ``skins`` on the yarns' faces, which were moved up by ``shift``, mm.

    Sides of yarns that stand upright stay as they are.
    """
    places = fabric.lattice.to_woven(mesh.points)
    faces = mesh.nodes[:, FACE_NODES].reshape(-1, 9)
    corners = np.sort(faces[:, _CORNERS], axis=1)
    rise, on_skin = np.zeros(len(places)), np.zeros(len(places), dtype=bool)

    for skin in skins:
        own = faces[_among(corners, np.sort(skin.quads, axis=1))]
        face = _face_heights(skin.swept, places[own], shift)
        on_skin[own] = True
        for node, around in _BETWEEN.items():
            higher = face[:, node] - face[:, around].mean(axis=1)
            rise[own[:, node]] = np.nan_to_num(higher)

    return _unfolded(mesh, places, rise, on_skin)


def _same_by_a_period(mesh: QuadraticMesh, rise: np.ndarray) -> np.ndarray:
    """The mean over nodes that are the same."""
    totals = np.bincount(mesh.unknowns, rise)
    return (totals / np.bincount(mesh.unknowns))[mesh.unknowns]


def _unfolded(
    mesh: QuadraticMesh, places: np.ndarray, rise: np.ndarray, on_skin: np.ndarray
) -> QuadraticMesh:
    """The mesh raised, but for hexahedra that would fold over: those stay midway, at last with their lines."""
    line = lines_of(vertical_links(mesh), len(places))
    kept = np.ones(len(rise), dtype=bool)

    for turn in range(2 * _TURNS):
        moved = np.zeros_like(mesh.points)
        moved[:, 2] = kept * _same_by_a_period(mesh, _faded(line, places, rise, on_skin))
        raised = mesh.moved(moved)
        folded = raised.folded()
        if not len(folded):
            break

        same = np.ones(len(rise), dtype=bool)
        same[mesh.unknowns[mesh.nodes[folded]]] = False
        kept &= same[mesh.unknowns]
        if turn >= _TURNS:
            upright = np.ones(len(rise), dtype=bool)
            upright[line[~kept]] = False
            rise = np.where(upright[line], rise, 0.0)

    return raised


def _among(rows: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Which of ``rows`` (rows, n) are among those ``wanted`` (others, n)."""
    number = np.unique(np.vstack([wanted, rows]), axis=0, return_inverse=True)[1].ravel()
    return np.isin(number[len(wanted) :], number[: len(wanted)])


def _face_heights(swept: SweptYarn, places: np.ndarray, shift: float) -> np.ndarray:
    """Heights of the yarn's lower or upper face at ``places`` (faces, 9, 3), whichever the corners lie on; else NaN."""
    axis, solved = swept.yarn.direction.axis, swept.fabric.directions[swept.yarn.direction]
    half = solved.width / 2
    away = np.clip(places[..., 1 - axis] - swept.trajectory.axis, -half, half)
    along, row = np.unique(np.round(places[..., axis], 9), return_inverse=True)
    across, column = np.unique(away, return_inverse=True)
    shape = places.shape[:2]
    both = (
        np.stack(heights(swept, along, across))[:, row.reshape(shape), column.reshape(shape)]
        + shift
    )

    off = np.abs(both - places[..., 2])[:, :, _CORNERS].max(axis=2)
    off = np.where(np.isnan(off), np.inf, off)
    nearest = np.where((off[0] <= off[1])[:, None], *both)
    return np.where((off.min(axis=0) <= _ON_FACE * solved.thickness)[:, None], nearest, np.nan)


def _faded(
    line: np.ndarray, places: np.ndarray, rise: np.ndarray, on_skin: np.ndarray
) -> np.ndarray:
    """What (nodes,) every node rises: ``rise`` on skins, linear between a line's outermost, fading from those on."""
    height = places[:, 2]
    skin = np.flatnonzero(on_skin)
    skin = skin[np.lexsort((height[skin], line[skin]))]
    low, high = np.full(line.max() + 1, -1), np.full(line.max() + 1, -1)
    # the last one written is a line's outermost
    high[line[skin]], low[line[skin[::-1]]] = (
        skin,
        skin[::-1],
    )
    floor, ceiling = np.full(line.max() + 1, np.inf), np.full(line.max() + 1, -np.inf)
    np.minimum.at(floor, line, height)
    np.maximum.at(ceiling, line, height)

    risen = np.where(on_skin, rise, 0.0)
    others = np.flatnonzero(~on_skin & (low[line] >= 0))
    own = line[others]
    z, lower, upper = height[others], height[low[own]], height[high[own]]
    ends = [floor[own], lower, upper, ceiling[own]]
    values = [np.zeros(len(own)), rise[low[own]], rise[high[own]], np.zeros(len(own))]

    for i in range(3):
        within = (z >= ends[i]) & (z <= ends[i + 1]) & (ends[i + 1] > ends[i])
        share = (z - ends[i])[within] / (ends[i + 1] - ends[i])[within]
        risen[others[within]] = values[i][within] * (1 - share) + values[i + 1][within] * share

    return risen
