"""The dry cell as keywords: mesh, sets, surfaces, fibre orientation; no material, no step."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..meshing.mesh import Mesh
from ..weave.directions import DIRECTIONS
from .faces import element_faces, touching_faces
from .keywords import (
    Comment,
    ElementSet,
    FibreOrientation,
    Hexahedra,
    Keyword,
    Nodes,
    NodeSet,
    Surface,
    write_keywords,
)

ORIENTATION = "fibres"


def cell_keywords(mesh: Mesh, rings: int = 0) -> Iterator[Keyword]:
    """The keywords of a mesh; nodes and elements keep the mesh file's numbers.

    Per yarn: element set ``weft_1``, node sets and surfaces ``weft_1_contact``, ``_free``,
    ``_start``, ``_end``; element sets ``weft`` and ``warp`` of all yarns; surfaces ``weft_top``,
    ``weft_bottom``, ``warp_top``, ``warp_bottom`` of all contact patches, for contact pairs,
    widened by ``rings`` of faces; the orientation ``fibres`` with the fibre axis as 1 and the
    direction across, in plane, as 2.
    """
    yield Nodes("all_nodes", mesh.points)
    for body in mesh.bodies:
        elements = mesh.elements_of(body)
        yield Hexahedra(body.name, elements + 1, mesh.hexahedra[elements] + 1)

    for direction in DIRECTIONS:
        yield ElementSet(
            direction, tuple(yarn.name for yarn in mesh.yarns if yarn.direction is direction)
        )

    for surface, quads in mesh.surfaces.items():
        yield NodeSet(surface.name, np.unique(quads) + 1)

    named = {surface.name: faces for surface, faces in element_faces(mesh).items()}
    for name, faces in (named | touching_faces(mesh, rings)).items():
        if len(faces):
            yield Surface(name, faces.elements + 1, faces.sides + 1)

    yield FibreOrientation(ORIENTATION, _axes(mesh))


def _axes(mesh: Mesh) -> np.ndarray:
    """Axes 1 and 2 of every element, (elements, 6): along and across the yarn, x and y off the yarns."""
    axes = np.hstack([mesh.fibre_axes(), mesh.across_axes()])
    axes[~axes.any(axis=1)] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    return axes


def write_deck(mesh: Mesh, path: str | Path, title: str, dialect: str = "calculix") -> None:
    """Write a mesh as an input deck to include in a model, which adds materials, sections and steps."""
    head = Comment(
        f"{title}\nlengths in mm; include in a model that adds materials, sections and steps"
    )
    write_keywords([head, *cell_keywords(mesh)], path, dialect)
