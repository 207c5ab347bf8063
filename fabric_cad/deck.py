"""The mesh as an Abaqus/CalculiX input deck: nodes, C3D8, sets, surfaces, fibre orientation.

The deck holds no material, section or step; a model includes it (``*INCLUDE``) and adds them.
The two solvers read the same text but for one block: Abaqus asks for the columns of a
distribution to be declared (``*DISTRIBUTION TABLE``), CalculiX complains about the card.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .meshing.mesh import Mesh
from .weaves import DIRECTIONS

DIALECTS = ("calculix", "abaqus")

# corners of the faces S1 ... S6 of C3D8
_FACES = np.array([[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]])
_CHUNK = 50_000


def write_deck(mesh: Mesh, path: str | Path, title: str, dialect: str = "calculix") -> None:
    """Write a mesh as an input deck; nodes and elements keep the mesh file's numbers.

    Per yarn: element set ``weft_1``, node sets and surfaces ``weft_1_contact``, ``_free``,
    ``_start``, ``_end``; element sets ``weft`` and ``warp`` of all yarns; the orientation
    ``fibres`` with the fibre axis as 1 and the direction across, in plane, as 2.
    """
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.writelines(_blocks(mesh, title, dialect))


def _blocks(mesh: Mesh, title: str, dialect: str) -> Iterable[str]:
    yield f"** {title}\n** lengths in mm; include in a model that adds materials, sections and steps\n"
    yield "*NODE, NSET=all_nodes\n"
    yield from _rows("%d, %.12g, %.12g, %.12g\n", np.arange(1, len(mesh.points) + 1), mesh.points)
    for number, name in enumerate(mesh.yarns):
        elements = np.flatnonzero(mesh.yarn == number)
        yield f"*ELEMENT, TYPE=C3D8, ELSET={name}\n"
        yield from _rows("%d" + ", %d" * 8 + "\n", elements + 1, mesh.hexahedra[elements] + 1)
    for direction in DIRECTIONS:
        yield f"*ELSET, ELSET={direction}\n"
        yield "".join(f"{name}\n" for name in mesh.yarns if name.startswith(direction))
    for name in mesh.surfaces:
        yield f"*NSET, NSET={name}\n"
        yield _listed(mesh.nodes_of(name) + 1)
    for name, (elements, sides) in element_faces(mesh).items():
        yield f"*SURFACE, NAME={name}, TYPE=ELEMENT\n"
        yield from _rows("%d, S%d\n", elements + 1, sides[:, None] + 1)
    if dialect == "abaqus":
        yield "*DISTRIBUTION TABLE, NAME=fibre_table\nCOORD3D, COORD3D\n"
    yield "*DISTRIBUTION, NAME=fibre_axes, LOCATION=ELEMENT, TABLE=fibre_table\n, 1., 0., 0., 0., 1., 0.\n"
    axes = np.hstack([mesh.fibre_axes(), mesh.across_axes()])
    yield from _rows("%d" + ", %.8g" * 6 + "\n", np.arange(1, len(axes) + 1), axes)
    yield "*ORIENTATION, NAME=fibres, SYSTEM=RECTANGULAR\nfibre_axes\n3, 0.\n"


def _rows(form: str, numbers: np.ndarray, values: np.ndarray) -> Iterable[str]:
    """One formatted line per number and row of values, in large pieces."""
    for start in range(0, len(numbers), _CHUNK):
        part = slice(start, start + _CHUNK)
        flat: list = []
        for number, row in zip(numbers[part].tolist(), values[part].tolist()):
            flat.append(number)
            flat += row
        yield form * len(numbers[part]) % tuple(flat)


def _listed(numbers: np.ndarray) -> str:
    """Numbers, sixteen a line."""
    lines = [numbers[start : start + 16] for start in range(0, len(numbers), 16)]
    return "".join(", ".join(map(str, line.tolist())) + "\n" for line in lines)


def element_faces(mesh: Mesh) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """For every surface, the elements (quads,) it bounds and which of their faces (0: S1 ... 5: S6).

    Raises ValueError where a quadrilateral is the face of no element.
    """
    on_surface = np.zeros(len(mesh.points), dtype=bool)
    for quads in mesh.surfaces.values():
        on_surface[quads] = True
    elements, sides = np.nonzero(on_surface[mesh.hexahedra[:, _FACES]].all(axis=2))
    keys = _face_keys(mesh.hexahedra[elements[:, None], _FACES[sides]], len(mesh.points))
    order = np.argsort(keys)
    found = {}
    for name, quads in mesh.surfaces.items():
        wanted = _face_keys(quads, len(mesh.points))
        at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(order) - 1)]
        if not np.array_equal(keys[at], wanted):
            raise ValueError(f"surface {name} has a quadrilateral that bounds no element")
        by_element = np.argsort(elements[at], kind="stable")
        found[name] = elements[at][by_element], sides[at][by_element]
    return found


def _face_keys(quads: np.ndarray, nodes: int) -> np.ndarray:
    """One number per quadrilateral, the same for any order of its corners.

    Two diagonally opposite corners name a face of a hexahedral mesh: the smallest node
    number and the one across from it.
    """
    smallest = quads.argmin(axis=1)
    rows = np.arange(len(quads))
    return quads[rows, smallest].astype(np.int64) * nodes + quads[rows, (smallest + 2) % 4]
