"""What yarns leave of a box, as one solid, exactly: its faces are the yarns' own, and no boolean is made.

Where yarns touch nothing is between them, so their faces there are left out. All others, seen from
outside, bound the matrix, with the floor, the ceiling and four sides of the box, which have the
yarns' ends as holes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain

import cadquery as cq
import numpy as np

from ..support.errors import BuildError
from ..weave.directions import DIRECTIONS, Direction
from ..weave.lattice import Lattice
from ..yarn.skin import Patch, Skin
from .solids import face_of, sew

FILLED = 1e-9
"""Relative error of the sum of all volumes up to which solids count as filling their box."""

_TOUCHING = 1e-9  # mm, distance up to which two faces are one
_IN_PLANE = 1e-7  # mm, as far as an edge may be from the side of the box in which it lies
_SHARES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])

# corners of the box's faces: 0 ... 3 the floor's, counter-clockwise from x = y = 0, 4 ... 7 the
# ceiling's
_SIDES = {(0, 0): (0, 3, 7, 4), (0, 1): (1, 2, 6, 5), (1, 0): (0, 1, 5, 4), (1, 1): (3, 2, 6, 7)}
_FLOOR, _CEILING = (0, 1, 2, 3), (4, 5, 6, 7)


def matrix_solid(skins: Sequence[Skin], size: np.ndarray, lattice: Lattice) -> cq.Solid:
    """The solid between the yarns' skins and the box 0 to X, 0 to Y, -H/2 to H/2, ``size`` (3,) = (X, Y, H) mm.

    The box is one in woven coordinates, and lies where ``lattice`` puts it. Raises
    :class:`BuildError` where OCCT does not close it to a valid solid.
    """
    patches = [(patch, skin) for skin in skins for patch in skin.patches]
    touching = _touching(patches)
    free = [face_of(*pair, lattice) for pair, touches in zip(patches, touching) if not touches]
    skin_shell, rim = sew(free)

    corners = _corners(size, lattice)
    holes = {
        side: _lying(rim, lattice.woven_coordinate(side[0]), side[1] * size[side[0]])
        for side in _SIDES
    }
    if sum(map(len, holes.values())) != len(rim):
        raise BuildError("the yarns' faces around the matrix do not fit each other")
    sides = [_planar(corners[list(numbers)], holes[side]) for side, numbers in _SIDES.items()]
    covers = [_planar(corners[list(numbers)], []) for numbers in (_FLOOR, _CEILING)]

    shell, _ = sew([*skin_shell.Faces(), *sides, *covers])
    solid = cq.Solid.makeSolid(shell) if isinstance(shell, cq.Shell) else None
    if solid is None or not solid.isValid():
        raise BuildError("the matrix does not close to a valid solid")
    return solid


def _touching(patches: Sequence[tuple[Patch, Skin]]) -> np.ndarray:
    """Which patches (patches,) lie on one of a yarn of the other direction.

    Beside the contacts themselves these are, beyond a chord, flat pieces of two yarns that both
    float on.
    """
    from scipy.spatial import cKDTree

    points = np.array([_sampled(patch, skin) for patch, skin in patches])
    touching = np.zeros(len(patches), dtype=bool)
    wefts, warps = (
        np.flatnonzero([skin.direction == direction for _, skin in patches])
        for direction in DIRECTIONS
    )
    pairs = cKDTree(points[wefts]).query_ball_tree(cKDTree(points[warps]), _TOUCHING)
    touching[wefts[[bool(found) for found in pairs]]] = True
    touching[warps[list(chain.from_iterable(pairs))]] = True

    return touching


def _sampled(patch: Patch, skin: Skin) -> np.ndarray:
    """Points of a patch in woven coordinates, u first, as one row of numbers, mm."""
    points = patch.at(_SHARES, _SHARES) + [0.0, skin.axis, 0.0]
    if skin.direction == Direction.WARP:
        points = points.swapaxes(0, 1)[..., [1, 0, 2]]
    return points.ravel()


def _corners(size: np.ndarray, lattice: Lattice) -> np.ndarray:
    """The corners (8, 3) of the box, mm."""
    plan = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * size[:2]
    levels = [np.column_stack([plan, np.full(4, z)]) for z in (-size[2] / 2, size[2] / 2)]
    return lattice.to_space(np.vstack(levels))


def _lying(edges: Sequence[cq.Edge], along: np.ndarray, place: float) -> list[cq.Edge]:
    """The edges in the plane where ``along`` (3,) times a point of space is ``place``, mm."""

    def lies_there(edge: cq.Edge) -> bool:
        ends = edge.startPoint(), edge.endPoint()
        return all(abs(along @ np.array(end.toTuple()) - place) < _IN_PLANE for end in ends)

    return [edge for edge in edges if lies_there(edge)]


def _planar(corners: np.ndarray, holes: list[cq.Edge]) -> cq.Face:
    """The face between four corners (4, 3), mm, with holes that some edges bound."""
    outline = cq.Wire.makePolygon([cq.Vector(*corner) for corner in corners.tolist()], close=True)
    return cq.Face.makeFromWires(outline, list(cq.Wire.combine(holes, _IN_PLANE)) if holes else [])


def checked_volumes(solids: Mapping[str, cq.Solid], size: np.ndarray) -> dict[str, float]:
    """The volume (mm3) of every solid of a composite, as read from its STEP file.

    Raises :class:`BuildError` where one is not valid, or they do not fill the box, ``size`` (3,) in
    mm.
    """
    if faulty := [name for name, solid in solids.items() if not solid.isValid()]:
        raise BuildError(f"{', '.join(faulty)}: no valid solid")
    volumes = {name: solid.Volume(FILLED) for name, solid in solids.items()}
    error = sum(volumes.values()) / float(size.prod()) - 1
    if abs(error) > FILLED:
        raise BuildError(
            f"the volumes of yarns and matrix are {error:.3g} of the box off its volume"
        )
    return volumes
