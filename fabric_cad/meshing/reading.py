"""A mesh file back to arrays."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from ..support.errors import BuildError
from ..weave.bodies import Body, Surface
from .gmsh_session import HEXAHEDRON, QUADRILATERAL, gmsh_session
from .mesh import Mesh


def read_mesh(msh: str | Path) -> Mesh:
    """Read a mesh of a cell, or that of a composite cell, without the faces of its box.

    Raises :class:`BuildError` where it cannot be.
    """
    with gmsh_session() as gmsh:
        try:
            gmsh.open(str(msh))
            return _read(gmsh)
        except Exception as error:  # gmsh raises bare Exception
            raise BuildError(f"{msh}: gmsh: {error}") from error


def _read(gmsh: Any) -> Mesh:
    points, index = _nodes(gmsh)
    hexahedra: dict[Body, np.ndarray] = {}
    surfaces: dict[Surface, np.ndarray] = {}
    others = 0

    for dimension, group in gmsh.model.getPhysicalGroups():
        name = gmsh.model.getPhysicalName(dimension, group)
        if dimension == 3:
            body = Body.named(name)
            hexahedra[body], rest = _elements(gmsh, (dimension, group), HEXAHEDRON, 8)
            others += rest
        elif (surface := _surface(name)) is not None:
            surfaces[surface], _ = _elements(gmsh, (dimension, group), QUADRILATERAL, 4)

    blocks = list(hexahedra.values())
    return Mesh(
        points=points,
        hexahedra=index[np.vstack(blocks)],
        body=np.repeat(np.arange(len(blocks)), [len(block) for block in blocks]),
        bodies=tuple(hexahedra),
        surfaces=MappingProxyType({surface: index[tags] for surface, tags in surfaces.items()}),
        other_elements=others,
    )


def _surface(name: str) -> Surface | None:
    """The surface of a body that is called so.

    None where it is one of no body, as a face of the box.
    """
    try:
        return Surface.named(name)
    except ValueError:
        return None


def _nodes(gmsh: Any) -> tuple[np.ndarray, np.ndarray]:
    """Points (nodes, 3), mm, in the order of their tags, and for every tag its index from 0."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    index = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    index[tags[order]] = np.arange(len(tags))
    return coordinates.reshape(-1, 3)[order], index


def _elements(
    gmsh: Any,
    group: tuple[int, int],
    wanted: int,
    corners: int,
) -> tuple[np.ndarray, int]:
    """Tags (elements, corners) of the nodes of a group's elements of one type.

    And how many of other types there are.
    """
    blocks, others = [np.empty((0, corners), dtype=np.uint64)], 0
    for entity in gmsh.model.getEntitiesForPhysicalGroup(*group):
        for kind, elements, nodes in zip(*gmsh.model.mesh.getElements(group[0], entity)):
            if kind == wanted:
                blocks.append(nodes.reshape(-1, corners))
            else:
                others += len(elements)

    return np.vstack(blocks), others
