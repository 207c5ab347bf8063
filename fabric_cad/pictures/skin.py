"""The skin of a mesh: its smooth patches and the lines that bound them.

    start _______ crease (a section's corner) _______ end        drawn: the rims of both ends
         |   |   |   |   |   |   |   |   |   |   |   |           and creases, whole or not at all
         |___|___|___|___|___|___|___|___|___|___|___|
                 along the yarn

A yarn's section has the same corners from its start to its end. A steep fold *across* a yarn, as
in the narrow gap under a float, is no edge of it and is shaded, not drawn.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..meshing.hexahedron import LENGTHWISE
from ..meshing.mesh import Mesh
from ..weave.bodies import Body, SurfaceKind

CREASE_DEGREES = 60
"""Angle between the faces on both sides of a section's corner from which it is a crease."""


@dataclass(frozen=True, eq=False)
class Skin:
    """``quads`` (faces, 4) and ``lines`` (edges, 2) of mesh nodes.

    ``patch`` (faces,) numbers smooth patches.
    """

    quads: np.ndarray
    patch: np.ndarray
    lines: np.ndarray


def skin_of(mesh: Mesh, yarns: Iterable[Body]) -> Skin:
    """The skin of some yarns.

    Creases are those of the mesh as it is, so that they do not depend on a load.
    """
    wanted = set(yarns)
    chosen = {surface: quads for surface, quads in mesh.surfaces.items() if surface.body in wanted}
    quads = np.vstack(list(chosen.values()))
    ends = [surface.kind in (SurfaceKind.START, SurfaceKind.END) for surface in chosen]
    is_end = np.repeat(ends, [len(faces) for faces in chosen.values()])

    edges, first, second, same_way = _shared_edges(quads, len(mesh.points))
    rim = is_end[first] != is_end[second]
    crease = (
        _creases(mesh, edges, _angles(mesh, quads, first, second, same_way))
        & ~is_end[first]
        & ~is_end[second]
    )

    smooth = ~(rim | crease)
    joined = coo_matrix(
        (np.ones(smooth.sum()), (first[smooth], second[smooth])), shape=(len(quads), len(quads))
    )
    _, patch = connected_components(joined, directed=False)

    return Skin(quads, patch, edges[~smooth])


def _shared_edges(
    quads: np.ndarray, nodes: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Edges (edges, 2) of two faces, smaller node first, and both faces.

    And whether both run through it the same way.
    """
    ways = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    edges = np.sort(ways, axis=1)
    faces = np.repeat(np.arange(len(quads)), 4)
    upward = ways[:, 0] < ways[:, 1]

    keys = _keys(edges, nodes)
    order = np.argsort(keys, kind="stable")
    pairs = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    one, other = order[pairs], order[pairs + 1]
    return edges[one], faces[one], faces[other], upward[one] == upward[other]


def _keys(edges: np.ndarray, nodes: int) -> np.ndarray:
    return edges[:, 0].astype(np.int64) * nodes + edges[:, 1]


def _angles(mesh: Mesh, quads: np.ndarray, first, second, same_way) -> np.ndarray:
    """Degrees between the normals of two faces, whichever way round each lists its corners."""
    corners = mesh.points[quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    cosines = (normals[first] * normals[second]).sum(axis=1) * np.where(same_way, -1, 1)
    return np.degrees(np.arccos(np.clip(cosines, -1, 1)))


def _creases(mesh: Mesh, edges: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """The edges (edges,) bool on lines along a yarn most of which is a crease."""
    nodes = len(mesh.points)
    along = np.sort(np.vstack([mesh.hexahedra[:, ends] for ends in LENGTHWISE]), axis=1)
    lengthwise = np.isin(_keys(edges, nodes), _keys(along, nodes))
    lines = edges[lengthwise]
    joined = coo_matrix((np.ones(len(lines)), lines.T), shape=(nodes, nodes))
    _, line_of_node = connected_components(joined, directed=False)
    line = line_of_node[lines[:, 0]]

    sharp = angles[lengthwise] > CREASE_DEGREES
    share = np.bincount(line, sharp, minlength=nodes) / np.maximum(
        np.bincount(line, minlength=nodes), 1
    )
    creases = np.zeros(len(edges), dtype=bool)
    creases[lengthwise] = share[line] > 0.5

    return creases
