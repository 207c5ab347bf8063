"""A mesh that gmsh did not make, as a file of gmsh's."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..support.errors import BuildError
from .gmsh_session import HEXAHEDRON, QUADRILATERAL, gmsh_session
from .mesh import Mesh


def write_mesh(mesh: Mesh, path: str | Path, others: Mapping[str, np.ndarray]) -> None:
    """Write a mesh as gmsh 4.1: a physical volume a body, a physical surface each of its own and of ``others``.

    ``others`` maps names to quadrilaterals (quads, 4). A face that several surfaces share is
    written once and belongs to all of them. Nodes and hexahedra have the mesh's numbers, from 1.
    Raises :class:`BuildError`.
    """
    surfaces = {surface.name: quads for surface, quads in mesh.surfaces.items()} | dict(others)
    with gmsh_session() as gmsh:
        try:
            _add_bodies(gmsh, mesh)
            _add_surfaces(
                gmsh,
                {name: quads for name, quads in surfaces.items() if len(quads)},
                len(mesh.hexahedra),
            )
            gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
            gmsh.option.setNumber("Mesh.Binary", 1)
            gmsh.write(str(path))
        except Exception as error:  # gmsh raises bare Exception
            raise BuildError(f"{path}: gmsh: {str(error) or 'no reason given'}") from error


def _add_bodies(gmsh: Any, mesh: Mesh) -> None:
    """Add a volume of hexahedra a body; all nodes belong to the first one's."""
    for number, body in enumerate(mesh.bodies, 1):
        gmsh.model.addDiscreteEntity(3, number)
        gmsh.model.addPhysicalGroup(3, [number], name=body.name)
    tags = np.arange(1, len(mesh.points) + 1)
    gmsh.model.mesh.addNodes(3, 1, tags, mesh.points.ravel())

    for number, body in enumerate(mesh.bodies, 1):
        elements = mesh.elements_of(body)
        nodes = mesh.hexahedra[elements].ravel() + 1
        gmsh.model.mesh.addElementsByType(number, HEXAHEDRON, elements + 1, nodes)


def _add_surfaces(gmsh: Any, surfaces: Mapping[str, np.ndarray], hexahedra: int) -> None:
    """Add one surface of quadrilaterals for all faces that belong to the same surfaces."""
    quads, members = _memberships(list(surfaces.values()))
    kinds, kind = np.unique(members, axis=0, return_inverse=True)
    kind = kind.ravel()
    order = np.argsort(kind, kind="stable")
    for number, faces in enumerate(np.split(order, np.cumsum(np.bincount(kind))[:-1]), 1):
        gmsh.model.addDiscreteEntity(2, number)
        gmsh.model.mesh.addElementsByType(
            number, QUADRILATERAL, hexahedra + 1 + faces, quads[faces].ravel() + 1
        )

    for number, name in enumerate(surfaces):
        entities = np.flatnonzero((kinds == number).any(axis=1)) + 1
        gmsh.model.addPhysicalGroup(2, entities.tolist(), name=name)


def _memberships(surfaces: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """All quadrilaterals once, (quads, 4), and the numbers of the surfaces each is in, (quads, most), then -1."""
    every = np.concatenate(surfaces)
    owner = np.repeat(np.arange(len(surfaces)), [len(quads) for quads in surfaces])
    _, first, face = np.unique(
        np.sort(every, axis=1), axis=0, return_index=True, return_inverse=True
    )
    face = face.ravel()

    order = np.lexsort((owner, face))
    times = np.bincount(face)
    place = np.arange(len(every)) - np.repeat(np.cumsum(times) - times, times)
    members = np.full((len(first), times.max()), -1)
    members[face[order], place] = owner[order]
    return every[first], members
