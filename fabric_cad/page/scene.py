"""A fabric's tiles as the numbers that the page's viewer draws, small enough for a link's answer or a file.

Points are 16 bits of their group's box, normals 8 bits: 12 bytes a point, an error of 1/65000 of a
yarn, which no picture shows. Nothing is computed from them.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.colours import COLOURS
from ..weave.directions import DIRECTIONS, Direction
from ..yarn.tessellation import BITS, TiledYarns, Tiling, tessellate, tile_codes
from ..yarn.tiles import COARSE, Grid

MANY, MANY_TILES = 128, 40
"""Crossings of a cell, and different tiles in it, from which on the tiles are coarse."""

_POINT, _NORMAL = 32767, 127
_LEVEL = 1e-9  # mm, by which points of a contact's rim may miss it


def scene(fabric: SolvedFabric) -> dict[str, Any]:
    """What ``viewer.js`` draws: JSON of a fabric's cell, arrays in base64.

    ``period`` (x, y) and ``thickness`` in mm; every group has ``tiles`` shapes of ``size`` points
    each. A point is middle + extent times its 16-bit numbers as -1 to 1; the fourth number of a
    normal says whether the crossed yarn touches there. Shape ``tile[k]`` stands at the k-th of
    ``places`` and is of ``yarn[k]``.
    """
    matrix = fabric.weave.interlacement()
    tiles = sum(len(np.unique(tile_codes(matrix, direction))) for direction in DIRECTIONS)
    grid = COARSE if matrix.size >= MANY or tiles >= MANY_TILES else Grid()
    groups = []

    for tiled in tessellate(fabric, grid):
        touching = _touching(fabric, tiled)
        groups += [
            _group(tiled.direction, tiled.tiles, touching),
            _group(tiled.direction, tiled.caps, np.zeros(tiled.caps.points.shape[:2], dtype=bool)),
        ]

    return {"period": fabric.period, "thickness": fabric.fabric_thickness, "groups": groups}


def _touching(fabric: SolvedFabric, tiled: TiledYarns) -> np.ndarray:
    """Boolean (tiles, points): the point is in its crossing's contact."""
    direction, tiles = tiled.direction, tiled.tiles
    codes = np.unique(tile_codes(fabric.weave.interlacement(), direction))
    high = (codes >> BITS.index("high") & 1).astype(bool)
    own, crossed = fabric.directions[direction], fabric.crossed(direction)

    plateaux = ["high" if each else "low" for each in high]
    half_across = np.array([own.contact[plateau].half_chord for plateau in plateaux])[:, None]
    facing = {"high": "low", "low": "high"}
    half_along = np.array([crossed.contact[facing[plateau]].half_chord for plateau in plateaux])[
        :, None
    ]

    along = tiles.points[..., direction.axis] - own.crossed_spacing / 2
    across = tiles.points[..., direction.other.axis]
    inside = (np.abs(along) < half_along + _LEVEL) & (np.abs(across) < half_across + _LEVEL)
    return inside & ((tiles.normals[..., 2] < 0) == high[:, None])


def _group(direction: Direction, tiling: Tiling, touching: np.ndarray) -> dict[str, Any]:
    low, high = tiling.points.min(axis=(0, 1)), tiling.points.max(axis=(0, 1))
    middle, extent = (low + high) / 2, np.maximum((high - low) / 2, 1e-12)

    points = np.zeros((*tiling.points.shape[:2], 4), dtype="<i2")
    points[..., :3] = np.round((tiling.points - middle) / extent * _POINT)
    normals = np.empty(points.shape, dtype="i1")
    normals[..., :3] = np.round(tiling.normals * _NORMAL)
    normals[..., 3] = np.where(touching, _NORMAL, 0)

    return {
        "direction": str(direction),
        "colour": COLOURS[direction],
        "tiles": len(points),
        "size": points.shape[1],
        "middle": middle.tolist(),
        "extent": extent.tolist(),
        "points": _text(points),
        "normals": _text(normals),
        "triangles": _text(tiling.triangles.astype("<u2")),
        "tile": tiling.tile.tolist(),
        "yarn": tiling.yarn.tolist(),
        "places": _text(tiling.places.astype("<f4")),
    }


def _text(values: np.ndarray) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
