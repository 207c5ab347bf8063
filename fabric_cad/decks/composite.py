"""A composite cell as keywords: mesh, sets, surfaces, fibre orientation; no material, no step."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from ..meshing.mesh import Mesh
from .cell import cell_keywords
from .faces import outer_faces
from .keywords import Comment, Keyword, NodeSet, Surface, write_keywords

_HEAD = """\
lengths in mm; include in a model that adds materials, sections and steps
element set matrix: what the yarns leave of the box
node sets and surfaces x_min ... z_max: the box's faces, whose nodes match those opposite"""


def composite_keywords(mesh: Mesh, box: Mapping[str, np.ndarray]) -> Iterator[Keyword]:
    """The keywords of a composite cell's mesh: those of its yarns and of the matrix, and the faces of its ``box``.

    Beside what :func:`~fabric_cad.decks.cell.cell_keywords` writes of yarns: element set
    ``matrix``, node sets and surfaces ``weft_1_matrix`` of the interfaces (of the yarn's faces) and
    ``x_min`` ... ``z_max`` of the box, given as quadrilaterals (quads, 4) by name.
    """
    yield from cell_keywords(mesh)
    for name, quads in box.items():
        yield NodeSet(name, np.unique(quads) + 1)
    for name, faces in outer_faces(mesh, box).items():
        yield Surface(name, faces.elements + 1, faces.sides + 1)


def write_composite_deck(
    mesh: Mesh,
    box: Mapping[str, np.ndarray],
    path: str | Path,
    title: str,
    dialect: str = "calculix",
) -> None:
    """Write a composite cell as an input deck to include in a model."""
    write_keywords([Comment(f"{title}\n{_HEAD}"), *composite_keywords(mesh, box)], path, dialect)
