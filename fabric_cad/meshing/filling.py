"""Hexahedra between the meshed faces of a yarn, layer of nodes by layer, and their names."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..support.errors import BuildError
from ..weave.bodies import Surface, SurfaceKind
from ..weave.directions import Direction
from .gmsh_session import HEXAHEDRON, QUADRILATERAL
from .yarn_faces import YarnFaces


def fill(gmsh: Any, yarn: YarnFaces) -> None:
    """Add the inner nodes, the hexahedra, and the quadrilaterals of both end sections.

    Raises BuildError where the yarn's faces are not meshed as they were planned.
    """
    outline_tags, outline = _outline(gmsh, yarn)
    inner = _inner_nodes(yarn, outline)
    first = int(gmsh.model.mesh.getMaxNodeTag()) + 1
    inner_tags = np.arange(first, first + inner[..., 0].size).reshape(inner.shape[:2])

    for entity, layers in (
        ((3, yarn.solid), slice(1, -1)),
        ((2, yarn.start), slice(None, 1)),
        ((2, yarn.end), slice(-1, None)),
    ):
        gmsh.model.mesh.addNodes(*entity, inner_tags[layers].ravel(), inner[layers].ravel())

    # counter-clockwise seen against the direction of travel: a warp's sections are mirrored
    is_weft = yarn.plan.yarn.direction is Direction.WEFT
    quads = yarn.template.quads if is_weft else yarn.template.quads[:, ::-1]
    tags = np.hstack([outline_tags, inner_tags])
    start, end = tags[0][quads[:, ::-1]], tags[-1][quads]
    hexahedra = np.concatenate([tags[:-1][:, quads], tags[1:][:, quads]], axis=2)

    add = gmsh.model.mesh.addElementsByType
    add(yarn.start, QUADRILATERAL, [], start.ravel())
    add(yarn.end, QUADRILATERAL, [], end.ravel())
    add(yarn.solid, HEXAHEDRON, [], hexahedra.ravel())


def _inner_nodes(yarn: YarnFaces, outline: np.ndarray) -> np.ndarray:
    """Places (layers, inner, 3) of the inner nodes, mm, from those (layers, outline, 3) around."""
    inner = np.einsum("io,roc->ric", yarn.template.weights, outline)
    if yarn.plan.moved is not None:
        moved = np.zeros_like(inner)
        moved[..., [1 - yarn.plan.along_axis, 2]] = yarn.plan.moved
        inner += yarn.lattice.to_space(moved)
    return inner


def _outline(gmsh: Any, yarn: YarnFaces) -> tuple[np.ndarray, np.ndarray]:
    """Tags (layers, outline) and places (layers, outline, 3) of the nodes around every layer."""
    plan = yarn.plan
    shape = plan.rows[-1] + 1, yarn.template.outline
    tags = np.zeros(shape, dtype=np.uint64)
    places = np.full((*shape, 3), np.nan)

    for (segment, side), face in yarn.skin.items():
        (slots, columns), layers = plan.strips[side], plan.layers[segment]
        nodes, coordinates, parameters = gmsh.model.mesh.getNodes(
            2, face, includeBoundary=True, returnParametricCoord=True
        )
        low, high = gmsh.model.getParametrizationBounds(2, face)
        along, across = ((parameters.reshape(-1, 2) - low) / (high - low)).T
        row, column = _nearest(layers, along), _nearest(columns, across)

        planned, distinct = len(layers) * len(slots), np.unique(row * len(slots) + column)
        if not len(nodes) == planned == len(distinct):
            raise BuildError(f"gmsh did not mesh a face of {plan.yarn.name} transfinitely")

        layer = plan.rows[segment] + row
        tags[layer, slots[column]] = nodes
        places[layer, slots[column]] = coordinates.reshape(-1, 3)

    return tags, places


def _nearest(shares: np.ndarray, values: np.ndarray) -> np.ndarray:
    """For every value the number of the nearest of some ascending shares."""
    return np.searchsorted((shares[1:] + shares[:-1]) / 2, values)


def name_groups(gmsh: Any, yarn: YarnFaces) -> None:
    """Name the yarn, and its surfaces: the faces that touch, those that do not, both ends."""
    body = yarn.plan.yarn.body
    gmsh.model.addPhysicalGroup(3, [yarn.solid], name=body.name)

    contact = [yarn.skin[key] for key in yarn.plan.contacts]
    free = [face for face in yarn.skin.values() if face not in set(contact)]
    for kind, faces in (
        (SurfaceKind.CONTACT, contact),
        (SurfaceKind.FREE, free),
        (SurfaceKind.START, [yarn.start]),
        (SurfaceKind.END, [yarn.end]),
    ):
        gmsh.model.addPhysicalGroup(2, faces, name=Surface(body, kind).name)
