"""A fabric's yarns as triangles: a few tiles, and where each of them stands.

What a yarn is over one crossing, from the middle of the gap before it to the middle of the gap
after it, is told by five bits, whatever the weave::

        gap | crossing, seen along the yarn | gap
    before -+-        it is high or low    -+- after         the yarn itself changes sides there, or floats on
                 left  <- crossed ->  right                  the yarn it crosses changes sides there, or floats on

So each direction has at most 32 tiles. Those in use are evaluated on the exact skin
(:mod:`~fabric_cad.yarn.skin`), with their exact normals, and are the same for every crossing that
has these bits: a drawing needs no mesh of the cell, but tiles and places.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..section.sections import Section
from ..support.arrays import read_only
from ..weave.directions import DIRECTIONS, Direction
from ..weave.weaves import Yarn
from .planes import control_planes
from .sections import control_sections
from .skin import Patch, skin
from .tiles import Grid, evaluated
from .trajectory import Trajectory, trajectory

Shapes = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Points and normals, each (tiles, points, 3), and triangles (triangles, 3)."""

BITS = ("high", "turns_before", "turns_after", "turns_left", "turns_right")
"""What a tile depends on, from the lowest bit of its code."""


@dataclass(frozen=True, eq=False)
class Tiling:
    """Shapes, and where they stand, mm: the tiles of one direction, or the faces at its yarns' ends.

    ``points`` and ``normals`` (tiles, points, 3) are x, y, z from the yarn's axis and the middle of
    the gap before the crossing, and unit vectors outwards; ``triangles`` (triangles, 3) index the
    points of any tile, counter-clockwise from outside. Tile ``tile[k]`` stands at ``places[k]``
    (3,) and is of the yarn with index ``yarn[k]``.
    """

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    tile: np.ndarray
    places: np.ndarray
    yarn: np.ndarray

    def __post_init__(self) -> None:
        for values in vars(self).values():
            read_only(values)


@dataclass(frozen=True, eq=False)
class TiledYarns:
    """The tiles of one direction's yarns, and the faces that close them at either end of the cell."""

    direction: Direction
    tiles: Tiling
    caps: Tiling


def tile_codes(interlacement: np.ndarray, direction: Direction) -> np.ndarray:
    """The code of the tile at every crossing, shape (yarns, crossings): :data:`BITS` as a binary number.

    ``interlacement`` is that of :class:`~fabric_cad.weave.weaves.Weave`, shape (wefts, warps).
    """
    high = interlacement if direction is Direction.WEFT else ~interlacement.T
    turns = [high != np.roll(high, shift, axis) for axis in (1, 0) for shift in (1, -1)]
    return sum(
        (bit.astype(int) << place for place, bit in enumerate((high, *turns))),
        np.zeros(high.shape, int),
    )


def tessellate(fabric: SolvedFabric, grid: Grid | None = None) -> tuple[TiledYarns, ...]:
    """All yarns of a fabric's cell as tiles, wefts first.

    ``grid`` says how fine (default: :class:`Grid`).
    """
    grid = grid or Grid()
    return tuple(_tiled(fabric, direction, grid) for direction in DIRECTIONS)


@dataclass(frozen=True, eq=False)
class SweptTile:
    """A yarn over one crossing as it is swept.

    T (mm) counts from the middle of the gap before it.
    """

    trajectory: Trajectory
    sections: tuple[Section, ...]

    @property
    def patches(self) -> tuple[Patch, ...]:
        """The exact patches of its surface."""
        return skin(self.trajectory, self.sections).patches


def swept_tile(fabric: SolvedFabric, direction: Direction, code: int) -> SweptTile:
    """The tile of a code (:func:`tile_codes`)."""
    high, before, after, left, right = (bool(code >> place & 1) for place in range(len(BITS)))
    # a yarn of three crossings, of which the first is the tile's and the last the one before it
    yarn = Yarn(direction, 0, (high, high ^ after, high ^ before), (left,) * 3, (right,) * 3)

    planes = control_planes(fabric, yarn)
    gaps = [number for number, plane in enumerate(planes) if plane.crossing is None]
    own = planes[: gaps[1] + 1]
    return SweptTile(trajectory(fabric, yarn, own), control_sections(fabric, yarn, own))


def swept_tiles(fabric: SolvedFabric) -> Iterator[SweptTile]:
    """Every tile that a fabric's cell is made of, once."""
    for direction in DIRECTIONS:
        for code in np.unique(tile_codes(fabric.weave.interlacement(), direction)):
            yield swept_tile(fabric, direction, int(code))


def _tiled(fabric: SolvedFabric, direction: Direction, grid: Grid) -> TiledYarns:
    codes = tile_codes(fabric.weave.interlacement(), direction)
    used = np.unique(codes)
    tile = np.searchsorted(used, codes)
    shape = evaluated([swept_tile(fabric, direction, int(code)).patches for code in used], grid)

    along = fabric.directions[direction].crossed_spacing
    axis = (np.arange(len(codes)) + 0.5) * fabric.crossed(direction).crossed_spacing
    yarn, crossing = np.meshgrid(*map(np.arange, codes.shape), indexing="ij")

    def tiling(shapes: Shapes, tile: np.ndarray, crossing: np.ndarray, yarn: np.ndarray) -> Tiling:
        places = np.column_stack([crossing * along, axis[yarn], np.zeros(yarn.size)])
        return Tiling(*_turned(direction, *shapes), tile, _in_plan(direction, places), yarn)

    crossings = tile.ravel(), crossing.ravel(), yarn.ravel()
    number = np.tile(np.arange(len(codes), dtype=np.int64), 2)
    end = np.repeat([0, -1], len(codes))  # the first crossing's start, the last one's end
    capped = tile[number, end] + np.where(end == 0, 0, len(used))
    return TiledYarns(
        direction,
        tiles=tiling((shape.points, shape.normals, shape.triangles), *crossings),
        caps=tiling(shape.caps(), capped, crossing[number, end], number),
    )


def _in_plan(direction: Direction, vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) along a yarn, across it and upwards as x, y, z."""
    return vectors if direction is Direction.WEFT else np.ascontiguousarray(vectors[..., [1, 0, 2]])


def _turned(
    direction: Direction, points: np.ndarray, normals: np.ndarray, triangles: np.ndarray
) -> Shapes:
    """Tiles in plan: x and y exchanged for warps is a reflection, so that their triangles turn round."""
    if direction is Direction.WARP:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
    return _in_plan(direction, points), _in_plan(direction, normals), triangles
