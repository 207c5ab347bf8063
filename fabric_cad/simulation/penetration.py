"""How deep deformed yarns lie inside one another: up to which state their contact is valid.

A finite element code only keeps those surfaces apart that it was told may touch. This check
knows nothing of contact: it looks for points of every yarn's skin inside every other yarn, its
continuation in the neighbouring cells included.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from itertools import product

import numpy as np
from scipy.spatial import cKDTree

from ..meshing.mesh import Mesh
from ..weave.bodies import Body, SurfaceKind, YarnBody
from .isoparametric import distance_to_quads, inside_hexahedra

KINDS = ("crossing", "parallel")
"""A weft and a warp, or two yarns of one direction."""


@dataclass(frozen=True, eq=False)
class Penetration:
    """The deepest place where a yarn lies inside another.

    ``depth`` mm: a point of the skin of yarn ``first``, at ``place`` (3,) mm in the deformed cell,
    lies so far below the skin of yarn ``second`` or of one of its periodic images. Where nothing
    penetrates, ``depth`` is 0, the yarns are None and ``place`` is NaN. ``by_pair`` maps pairs
    of yarns, in the order of the mesh, to the depth of either in the other, mm; a pair of equal
    ones is a yarn and its own image in the next cell.
    """

    depth: float = 0.0
    first: Body | None = None
    second: Body | None = None
    place: np.ndarray = field(default_factory=lambda: np.full(3, np.nan))
    by_pair: dict[tuple[Body, Body], float] = field(default_factory=dict)

    def deepest(self, kind: str) -> float:
        """Largest depth, mm, of the pairs of one of :data:`KINDS`."""
        return max(
            (depth for pair, depth in self.by_pair.items() if kind_of(pair) == kind), default=0.0
        )


def kind_of(pair: tuple[Body, Body]) -> str:
    """Which of :data:`KINDS` two yarns are."""
    return KINDS[pair[0].direction is pair[1].direction]


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
    yarns = mesh.yarns
    bodies = [_Body(mesh, points, period, yarn) for yarn in yarns]
    found = Penetration()
    by_pair: dict[tuple[Body, Body], float] = {}

    for (i, one), (j, other) in product(enumerate(bodies), repeat=2):
        if i == j and period is None:
            continue
        depth, place = _deepest(one, other, _shifts(period, one, other))
        pair = (yarns[min(i, j)], yarns[max(i, j)])
        by_pair[pair] = max(depth, by_pair.get(pair, 0.0))
        if depth > found.depth:
            found = Penetration(depth, yarns[i], yarns[j], place)

    return Penetration(found.depth, found.first, found.second, found.place, by_pair)


def _check(name: str, array: np.ndarray, shape: tuple[int, ...]) -> None:
    if np.shape(array) != shape:
        raise ValueError(f"{name} has shape {np.shape(array)}, not {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds a value that is not finite")


class _Boxed:
    """Faces or elements, corners (elements, 4 or 8, 3) mm, with their boxes and what finds the near ones."""

    def __init__(self, corners: np.ndarray) -> None:
        self.corners = corners
        self.low, self.high = corners.min(axis=1), corners.max(axis=1)
        self.middles = (self.low + self.high) / 2
        self.half = (self.high - self.low).max(axis=0) / 2 * (1 + 1e-9)


class _Body:
    """One yarn of the deformed cell.

    ``probes`` (probes, 3) mm are the points of its skin to be looked for in other yarns;
    ``elements`` are its hexahedra and ``skin`` its lateral faces, those of its continuation in
    the neighbouring cells included.
    """

    def __init__(
        self, mesh: Mesh, points: np.ndarray, period: np.ndarray | None, yarn: YarnBody
    ) -> None:
        self.direction = yarn.direction.axis
        quads = mesh.quads_of(yarn, SurfaceKind.CONTACT, SurfaceKind.FREE)
        edges = np.unique(
            np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)), axis=0
        )
        faces = points[quads]
        self.probes = np.vstack(
            [points[np.unique(quads)], points[edges].mean(axis=1), faces.mean(axis=1)]
        )
        self.elements = _Boxed(points[mesh.hexahedra[mesh.elements_of(yarn)]])
        along = (
            np.zeros((1, 3))
            if period is None
            else period[self.direction] * np.array([[-1], [0], [1]])
        )
        self.skin = _Boxed((faces + along[:, None, None]).reshape(-1, 4, 3))

    @cached_property
    def by_element(self) -> cKDTree:
        """Middles of the elements, in units of the largest half box."""
        return cKDTree(self.elements.middles / self.elements.half)

    @cached_property
    def by_face(self) -> cKDTree:
        """Middles of the faces of the skin, mm."""
        return cKDTree(self.skin.middles)

    @cached_property
    def by_corner(self) -> cKDTree:
        """Corners of the faces of the skin, mm."""
        return cKDTree(self.skin.corners.reshape(-1, 3))


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
    low, high = other.elements.low.min(axis=0), other.elements.high.max(axis=0)
    moved = one.probes - shifts[:, None]
    image, probe = np.nonzero(((moved >= low) & (moved <= high)).all(axis=2))
    places = moved[image, probe]
    inside = _inside(places, other) if len(places) else probe
    if not len(inside):
        return 0.0, np.full(3, np.nan)
    depths = _depths(places[inside], other)
    deepest = int(depths.argmax())
    return float(depths[deepest]), one.probes[probe[inside[deepest]]]


def _inside(places: np.ndarray, body: _Body) -> np.ndarray:
    """Indices of the places (places, 3) that lie in an element of a yarn."""
    elements = body.elements
    near = cKDTree(places / elements.half).sparse_distance_matrix(
        body.by_element, 1.0, p=np.inf, output_type="ndarray"
    )
    place, element = near["i"], near["j"]
    off = np.maximum(elements.low[element] - places[place], places[place] - elements.high[element])
    boxed = (off <= 1e-9 * elements.half).all(axis=1)
    place, element = place[boxed], element[boxed]
    return np.unique(place[inside_hexahedra(places[place], elements.corners[element])])


def _depths(places: np.ndarray, body: _Body) -> np.ndarray:
    """Distance (places,) of each place to the nearest face of a yarn's skin, mm."""
    skin = body.skin
    nearest = np.array(body.by_corner.query(places)[0])
    reach = nearest + np.linalg.norm(skin.half)
    near_faces = [
        np.array(faces, dtype=int) for faces in body.by_face.query_ball_point(places, reach)
    ]
    place = np.repeat(np.arange(len(places)), [len(faces) for faces in near_faces])
    face = np.concatenate(near_faces)

    off = np.maximum(
        np.maximum(skin.low[face] - places[place], places[place] - skin.high[face]), 0.0
    )
    near = np.linalg.norm(off, axis=1) <= nearest[place]
    place, face = place[near], face[near]
    np.minimum.at(nearest, place, distance_to_quads(places[place], skin.corners[face]))

    return nearest
