"""How deep deformed yarns lie inside one another: up to which state their contact is valid.

A finite element code only keeps those surfaces apart that it was told may touch. This check
knows nothing of contact: it looks for points of every yarn's skin inside every other yarn, its
continuation in the neighbouring cells included.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from scipy.spatial import cKDTree

from ..meshing.mesh import Mesh
from ..weaves import DIRECTIONS
from .isoparametric import distance_to_quads, inside_hexahedra

KINDS = ("crossing", "parallel")
"""A weft and a warp, or two yarns of one direction."""


@dataclass(frozen=True, eq=False)
class Penetration:
    """The deepest place where a yarn lies inside another.

    ``depth`` mm: a point of the skin of yarn ``first``, at ``place`` (3,) mm in the deformed cell,
    lies so far below the skin of yarn ``second`` or of one of its periodic images. Where nothing
    penetrates, ``depth`` is 0, the names are empty and ``place`` is NaN. ``by_pair`` maps pairs
    of names, in the order of the mesh, to the depth of either in the other, mm; a pair of equal
    names is a yarn and its own image in the next cell.
    """

    depth: float = 0.0
    first: str = ""
    second: str = ""
    place: np.ndarray = field(default_factory=lambda: np.full(3, np.nan))
    by_pair: dict[tuple[str, str], float] = field(default_factory=dict)

    def deepest(self, kind: str) -> float:
        """Largest depth, mm, of the pairs of one of :data:`KINDS`."""
        return max((depth for pair, depth in self.by_pair.items() if kind_of(pair) == kind), default=0.0)


def kind_of(pair: tuple[str, str]) -> str:
    """Which of :data:`KINDS` two yarns are."""
    return KINDS[_direction(pair[0]) == _direction(pair[1])]


def penetration(mesh: Mesh, points: np.ndarray, period: np.ndarray | None = None) -> Penetration:
    """The deepest penetration of any two yarns of a deformed cell, crossing or side by side.

    ``points`` (nodes, 3) are the deformed places, mm, of the nodes of ``mesh``; ``period`` (2, 3)
    the deformed cell's vectors, mm, from the start to the end of the wefts and of the warps, or
    None for yarns that do not go on beyond the cell. Nodes, edge middles and face centres of every
    skin are looked for inside the elements of the other yarns and of their images one cell further
    on. A depth is the distance to the other yarn's nearest ``contact`` or ``free`` face, bilinear
    as the elements are; ``start`` and ``end`` do not bound a yarn.

    Raises ValueError where an array has another shape or holds a value that is not finite.
    """
    _check("points", points, mesh.points.shape)
    if period is not None:
        _check("period", period, (2, 3))
    bodies = [_body(mesh, points, period, index) for index in range(len(mesh.yarns))]
    found, by_pair = Penetration(), {}
    for (i, one), (j, other) in product(enumerate(bodies), repeat=2):
        if i == j and period is None:
            continue
        depth, place = _deepest(one, other, _shifts(period, one, other))
        pair = (mesh.yarns[min(i, j)], mesh.yarns[max(i, j)])
        by_pair[pair] = max(depth, by_pair.get(pair, 0.0))
        if depth > found.depth:
            found = Penetration(depth, mesh.yarns[i], mesh.yarns[j], place)
    return Penetration(found.depth, found.first, found.second, found.place, by_pair)


def valid_until(states: Sequence[float], depths: Sequence[float], allowed: float) -> float:
    """The state (an angle, a strain) at which the depth of penetration first exceeds ``allowed``.

    ``states`` ascend, ``depths`` and ``allowed`` are in one unit; between states the depth is taken
    as linear. The last state where it never exceeds, the first where it does from the start.
    """
    over = np.flatnonzero(np.asarray(depths) > allowed)
    if not len(over):
        return float(states[-1])
    if (n := over[0]) == 0:
        return float(states[0])
    share = (allowed - depths[n - 1]) / (depths[n] - depths[n - 1])
    return float(states[n - 1] + share * (states[n] - states[n - 1]))


def _check(name: str, array: np.ndarray, shape: tuple[int, ...]) -> None:
    if np.shape(array) != shape:
        raise ValueError(f"{name} has shape {np.shape(array)}, not {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds a value that is not finite")


def _direction(name: str) -> int:
    return DIRECTIONS.index(name.split("_")[0])


@dataclass(frozen=True, eq=False)
class _Body:
    """A yarn of the deformed cell, mm.

    ``probes`` (probes, 3) are the points of its skin to be looked for in other yarns; ``corners``
    (elements, 8, 3) of its hexahedra, in boxes from ``low`` to ``high`` (elements, 3); ``skin``
    (faces, 4, 3) of its lateral faces, those of its continuation in the neighbouring cells included.
    """

    direction: int
    probes: np.ndarray
    corners: np.ndarray
    low: np.ndarray
    high: np.ndarray
    skin: np.ndarray


def _body(mesh: Mesh, points: np.ndarray, period: np.ndarray | None, index: int) -> _Body:
    name = mesh.yarns[index]
    direction = _direction(name)
    quads = np.vstack([mesh.surfaces[f"{name}_{kind}"] for kind in ("contact", "free")])
    edges = np.unique(np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)), axis=0)
    faces = points[quads]
    corners = points[mesh.hexahedra[mesh.yarn == index]]
    along = np.zeros((1, 3)) if period is None else period[direction] * np.array([[-1], [0], [1]])
    return _Body(
        direction=direction,
        probes=np.vstack([points[np.unique(quads)], points[edges].mean(axis=1), faces.mean(axis=1)]),
        corners=corners,
        low=corners.min(axis=1),
        high=corners.max(axis=1),
        skin=(faces + along[:, None, None]).reshape(-1, 4, 3),
    )


def _shifts(period: np.ndarray | None, one: _Body, other: _Body) -> np.ndarray:
    """Vectors (images, 3), mm, from a yarn of the cell to its images one cell further on, to be met by ``one``."""
    if period is None:
        return np.zeros((1, 3))
    steps = np.array([[i, j] for i, j in product((-1, 0, 1), repeat=2)])
    if one is other:  # its own continuation is no other yarn
        steps = steps[steps[:, 1 - one.direction] != 0]
    return steps @ period


def _deepest(one: _Body, other: _Body, shifts: np.ndarray) -> tuple[float, np.ndarray]:
    """Depth (mm) and place (3,) of the probe of ``one`` deepest inside ``other`` or its images."""
    moved = one.probes - shifts[:, None]
    near = ((moved >= other.low.min(axis=0)) & (moved <= other.high.max(axis=0))).all(axis=2)
    shift, probe = np.nonzero(near)
    if not len(probe):
        return 0.0, np.full(3, np.nan)
    places = moved[shift, probe]
    inside = _inside(places, other)
    if not len(inside):
        return 0.0, np.full(3, np.nan)
    depths = _distances(places[inside], other.skin)
    deepest = int(depths.argmax())
    return float(depths[deepest]), one.probes[probe[inside[deepest]]]


def _inside(places: np.ndarray, body: _Body) -> np.ndarray:
    """Indices of the places (places, 3) that lie in an element of a yarn."""
    middles, reach = (body.low + body.high) / 2, (body.high - body.low).max(axis=0) / 2 * (1 + 1e-9)
    pairs = cKDTree(places / reach).sparse_distance_matrix(
        cKDTree(middles / reach), 1.0, p=np.inf, output_type="ndarray"
    )
    place, element = pairs["i"], pairs["j"]
    margin = 1e-9 * reach
    boxed = ((places[place] >= body.low[element] - margin) & (places[place] <= body.high[element] + margin)).all(axis=1)
    place, element = place[boxed], element[boxed]
    return np.unique(place[inside_hexahedra(places[place], body.corners[element])])


def _distances(places: np.ndarray, quads: np.ndarray) -> np.ndarray:
    """Distance (places,) of each place to the nearest of the quadrilaterals (quads, 4, 3), mm."""
    nearest, _ = cKDTree(quads.reshape(-1, 3)).query(places)
    middles = quads.mean(axis=1)
    reach = np.linalg.norm(quads - middles[:, None], axis=2).max()
    found = cKDTree(middles).query_ball_point(places, nearest + reach)
    place = np.repeat(np.arange(len(places)), [len(each) for each in found])
    quad = np.concatenate([np.asarray(each, dtype=int) for each in found])
    low, high = quads.min(axis=1)[quad], quads.max(axis=1)[quad]
    off = np.maximum(np.maximum(low - places[place], places[place] - high), 0.0)
    kept = np.linalg.norm(off, axis=1) <= nearest[place]
    place, quad = place[kept], quad[kept]
    np.minimum.at(nearest, place, distance_to_quads(places[place], quads[quad]))
    return nearest
