"""The dry cell as keywords: nodes, C3D8, sets, surfaces, fibre orientation; no material, no step."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..meshing.mesh import Mesh
from ..weave.weaves import DIRECTIONS
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
    for number, name in enumerate(mesh.yarns):
        elements = np.flatnonzero(mesh.yarn == number)
        yield Hexahedra(name, elements + 1, mesh.hexahedra[elements] + 1)
    for direction in DIRECTIONS:
        yield ElementSet(direction, tuple(name for name in mesh.yarns if name.startswith(direction)))
    for name in mesh.surfaces:
        yield NodeSet(name, mesh.nodes_of(name) + 1)
    for name, (elements, sides) in (element_faces(mesh) | touching_faces(mesh, rings)).items():
        if len(elements):
            yield Surface(name, elements + 1, sides + 1)
    yield FibreOrientation(ORIENTATION, np.hstack([mesh.fibre_axes(), mesh.across_axes()]))


def write_deck(mesh: Mesh, path: str | Path, title: str, dialect: str = "calculix") -> None:
    """Write a mesh as an input deck to include in a model, which adds materials, sections and steps."""
    head = Comment(f"{title}\nlengths in mm; include in a model that adds materials, sections and steps")
    write_keywords([head, *cell_keywords(mesh)], path, dialect)
