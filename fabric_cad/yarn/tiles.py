"""Patches evaluated all at once: points, exact normals and triangles of tiles that share their topology.

A tile's strips, from the section's ASCII drawing in :mod:`~fabric_cad.section.sections`, are grids
of points::

    across   left_lower | bottom | right_lower          every strip has points of its own where it meets the
             left_upper |  top   | right_upper          next, so that an edge is a crease with two normals
    along    mid-gap -> (chord shorter than the width: lateral zone ->) crossing -> ... -> mid-gap

The number of points does not depend on how many control planes a tile has: 3 or 5 segments share
the same intervals along, so that high and low tiles, with different chords, have one topology.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from ..support.arrays import read_only
from .skin import Patch

UPPER, LOWER = ("left_upper", "top", "right_upper"), ("left_lower", "bottom", "right_lower")
UPRIGHT = ("left", "right")
SIDES = (*LOWER, *UPPER, *UPRIGHT)
"""Every side a section may have, in the order of a tile's points."""

_OUTWARDS = {"top": 1, "left": 1, "bottom": -1, "right": -1} | {
    f"{edge}_{level}": sign
    for edge in ("left", "right")
    for level, sign in (("upper", 1), ("lower", -1))
}
"""Sign of (along x across) for it to point out of a yarn.

Strips run from left to right, upright ones upwards.
"""


@dataclass(frozen=True)
class Grid:
    """Intervals of a tile: along its segments, of which there are 3 or 5 and the sums agree, and across its sides.

    ``along`` maps the number of segments, ``across`` that of strips in a side, to intervals one
    after the other.
    """

    along: dict[int, tuple[int, ...]] = field(
        default_factory=lambda: {3: (4, 6, 4), 5: (3, 2, 4, 2, 3)}
    )
    across: dict[int, tuple[int, ...]] = field(default_factory=lambda: {1: (12,), 3: (3, 6, 3)})

    def intervals(self, sides: Sequence[str]) -> dict[str, int]:
        """Intervals across every strip of a section that has these sides."""
        found = dict.fromkeys((side for side in UPRIGHT if side in sides), 1)
        for level in (LOWER, UPPER):
            strips = [side for side in level if side in sides]
            found |= dict(zip(strips, self.across[len(strips)]))
        return found


COARSE = Grid({3: (2, 4, 2), 5: (2, 1, 2, 1, 2)}, {1: (8,), 3: (2, 4, 2)})
"""For cells of very many crossings, and where no graphics processor draws."""


@dataclass(frozen=True, eq=False)
class Tiles:
    """``points`` and unit ``normals`` (tiles, points, 3) as t, v, z, and ``triangles`` (triangles, 3).

    ``rows`` maps a strip's side to the numbers of its points, shape (along, across).
    """

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    rows: dict[str, np.ndarray]

    def caps(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The faces at both ends: those at the start of every tile, then those at the end of every one.

        Points (2 tiles, points, 3), normals of that shape, and triangles; each is a fan of
        quadrilaterals between the lower and the upper outline, whose points lie over each other one
        by one.
        """
        lower, upper = (_outline(self.rows, level) for level in (LOWER, UPPER))
        faces = (np.hstack([upper[0], lower[0]]), np.hstack([lower[-1], upper[-1]]))
        points = np.concatenate([self.points[:, face] for face in faces])
        normals = np.zeros_like(points)
        normals[: len(self.points), :, 0], normals[len(self.points) :, :, 0] = -1.0, 1.0

        count = lower.shape[1]
        numbers = np.arange(2 * count).reshape(2, count)
        return points, normals, _triangles(numbers, outwards=-1)


def evaluated(tiles: Sequence[Sequence[Patch]], grid: Grid) -> Tiles:
    """Tiles from the patches of each; all of one section form, and so with the same sides."""
    there = {patch.side for patch in tiles[0]}
    sides = [side for side in SIDES if side in there]
    across, along = grid.intervals(sides), sum(grid.along[3]) + 1
    rows, count = {}, 0
    for side in sides:
        rows[side] = count + np.arange(along * (across[side] + 1)).reshape(along, -1)
        count += rows[side].size

    points, normals = np.empty((len(tiles), count, 3)), np.empty((len(tiles), count, 3))
    for (side, *_), members in _alike(tiles).items():
        segments = grid.along[members[0].segments]
        first, intervals = (
            sum(segments[: members[0].patch.segment]),
            segments[members[0].patch.segment],
        )
        own = rows[side][first : first + intervals + 1].ravel()
        numbers = np.array([member.tile for member in members])
        place, normal = _surface([member.patch for member in members], intervals, across[side])
        points[np.ix_(numbers, own)], normals[np.ix_(numbers, own)] = (
            place,
            normal * _OUTWARDS[side],
        )

    triangles = np.vstack([_triangles(rows[side], _OUTWARDS[side]) for side in sides])
    return Tiles(points, normals, triangles, rows)


@dataclass(frozen=True, eq=False)
class _Member:
    """A patch, the number of its tile, and how many segments that tile has."""

    tile: int
    segments: int
    patch: Patch


def _alike(tiles: Sequence[Sequence[Patch]]) -> dict[tuple, list[_Member]]:
    """Patches by side, segment and the knots of both parameters as shares: what is evaluated together."""
    groups: dict[tuple, list[_Member]] = {}
    for number, patches in enumerate(tiles):
        segments = 1 + max(patch.segment for patch in patches)
        for patch in patches:
            knots = [
                np.round(_shares(values), 12).tobytes() for values, _ in (patch.along, patch.across)
            ]
            key = (patch.side, segments, patch.segment, patch.along[1], patch.across[1], *knots)
            groups.setdefault(key, []).append(_Member(number, segments, patch))
    return groups


def _surface(patches: Sequence[Patch], along: int, across: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and unit normals (along x across) of patches with the same knots, each (patches, points, 3)."""
    (knots_along, degree_along), (knots_across, degree_across) = patches[0].along, patches[0].across
    poles = np.stack([patch.homogeneous for patch in patches])
    rows, row_rates = _even_basis(tuple(_shares(knots_along).tolist()), degree_along, along)
    columns, column_rates = _even_basis(
        tuple(_shares(knots_across).tolist()), degree_across, across
    )

    def over_grid(first: np.ndarray, second: np.ndarray) -> np.ndarray:
        tiles, poles_along, _, _ = poles.shape
        lines = (first @ poles.reshape(tiles, poles_along, -1)).reshape(tiles, along + 1, -1, 4)
        return (second @ lines).reshape(tiles, -1, 4)

    value = over_grid(rows, columns)
    weight, point = value[..., 3:], value[..., :3] / value[..., 3:]
    rates = (over_grid(row_rates, columns), over_grid(rows, column_rates))
    onwards, sideways = ((rate[..., :3] - point * rate[..., 3:]) / weight for rate in rates)

    normal = np.cross(onwards, sideways)
    return point, normal / np.linalg.norm(normal, axis=-1, keepdims=True)


@lru_cache(maxsize=256)
def _even_basis(knots: tuple[float, ...], degree: int, intervals: int) -> tuple[np.ndarray, ...]:
    """:func:`basis` at places that part a patch into equal intervals of its parameter."""
    places = np.linspace(knots[0], knots[-1], intervals + 1)
    return tuple(map(read_only, basis(np.array(knots), degree, places)))


def basis(knots: np.ndarray, degree: int, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """B-spline basis functions and their derivatives at places, each (places, functions). (de Boor)

    ``knots`` begin and end with ``degree`` + 1 equal ones, between which the places lie.
    """
    span = np.clip(
        np.searchsorted(knots, places, side="right") - 1, degree, len(knots) - degree - 2
    )
    values = (np.arange(len(knots) - 1) == span[:, None]).astype(float)
    lower = values

    for order in range(1, degree + 1):
        lower, width = values, knots[order:] - knots[:-order]
        share = (places[:, None] - knots[:-order]) / np.where(width > 0, width, 1.0)
        rising, falling = np.where(width > 0, share, 0.0), np.where(width > 0, 1 - share, 0.0)
        values = rising[:, :-1] * lower[:, :-1] + falling[:, 1:] * lower[:, 1:]

    width = knots[degree:] - knots[:-degree]
    slope = np.where(width > 0, degree / np.where(width > 0, width, 1.0), 0.0) * lower
    return values, slope[:, :-1] - slope[:, 1:]


def _shares(knots: np.ndarray) -> np.ndarray:
    return (knots - knots[0]) / (knots[-1] - knots[0])


def _outline(rows: dict[str, np.ndarray], level: Sequence[str]) -> np.ndarray:
    """Numbers (along, across) of a side's points from edge to edge, each joint of two strips once."""
    strips = [rows[side] for side in level if side in rows]
    return np.hstack([strips[0], *(strip[:, 1:] for strip in strips[1:])])


def _triangles(numbers: np.ndarray, outwards: int) -> np.ndarray:
    """Two triangles for every quadrilateral of a grid of points (along, across), shape (triangles, 3)."""
    a, b = numbers[:-1, :-1].ravel(), numbers[1:, :-1].ravel()
    d, c = numbers[:-1, 1:].ravel(), numbers[1:, 1:].ravel()
    found = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return found if outwards > 0 else found[:, ::-1]
