"""A mesh's faces as solvers number them, and the surfaces that touch."""

from __future__ import annotations

import numpy as np

from ..meshing.hexahedron import FACES
from ..meshing.mesh import Mesh
from ..weave.bodies import Surface, SurfaceKind
from ..weave.directions import DIRECTIONS

_UPRIGHT = 0.1  # sine up to which a face is one of the yarn's sides, neither top nor bottom


def element_faces(mesh: Mesh) -> dict[Surface, tuple[np.ndarray, np.ndarray]]:
    """For every surface, the elements (quads,) it bounds and which of their faces (0: S1 ... 5: S6).

    Raises ValueError where a quadrilateral is the face of no element.
    """
    on_surface = np.zeros(len(mesh.points), dtype=bool)
    for quads in mesh.surfaces.values():
        on_surface[quads] = True
    elements, sides = np.nonzero(on_surface[mesh.hexahedra[:, FACES]].all(axis=2))
    keys = _face_keys(mesh.hexahedra[elements[:, None], FACES[sides]], len(mesh.points))
    order = np.argsort(keys)
    found = {}
    for surface, quads in mesh.surfaces.items():
        wanted = _face_keys(quads, len(mesh.points))
        at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(order) - 1)]
        if not np.array_equal(keys[at], wanted):
            raise ValueError(f"surface {surface} has a quadrilateral that bounds no element")
        by_element = np.argsort(elements[at], kind="stable")
        found[surface] = elements[at][by_element], sides[at][by_element]
    return found


def _face_keys(quads: np.ndarray, nodes: int) -> np.ndarray:
    """One number per quadrilateral, the same for any order of its corners.

    Two diagonally opposite corners name a face of a hexahedral mesh: the smallest node
    number and the one across from it.
    """
    smallest = quads.argmin(axis=1)
    rows = np.arange(len(quads))
    return quads[rows, smallest].astype(np.int64) * nodes + quads[rows, (smallest + 2) % 4]


def touching_faces(mesh: Mesh, rings: int = 0) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """The contact patches by direction and side, ``weft_top``, ``weft_bottom``, ``warp_top``, ``warp_bottom``.

    Each as elements (quads,) and their faces (0: S1 ...), widened by ``rings`` of free faces of
    the same side. Tops and bottoms are apart because a solver's contact search confuses the two
    sides of a yarn in one surface.
    """
    faces = element_faces(mesh)
    found: dict[str, list] = {f"{direction}_{side}": [] for direction in DIRECTIONS for side in ("top", "bottom")}
    for yarn in mesh.yarns:
        touching, free = faces[Surface(yarn, SurfaceKind.CONTACT)], faces.get(Surface(yarn, SurfaceKind.FREE))
        _, upward = _quads(mesh, touching)
        for side, chosen in (("top", upward > 0), ("bottom", upward <= 0)):
            taken = touching[0][chosen], touching[1][chosen]
            if rings and free is not None:
                taken = _widened(mesh, taken, free, side == "top", rings)
            found[f"{yarn.direction}_{side}"].append(taken)
    none = np.empty(0, dtype=np.int64)
    return {name: tuple(map(np.concatenate, zip((none, none), *parts))) for name, parts in found.items()}


def face_quads(mesh: Mesh, faces: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Corner nodes (quads, 4) of faces given as elements and their sides (0: S1 ...)."""
    elements, sides = faces
    return mesh.hexahedra[elements[:, None], FACES[sides]]


def area_vectors(mesh: Mesh, quads: np.ndarray) -> np.ndarray:
    """Normals (quads, 3) of quadrilaterals, mm, as long as their area, mm2."""
    corners = mesh.points[quads]
    return np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2


def _quads(mesh: Mesh, faces: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Corner nodes (quads, 4) of element faces and how far they look up: the sine of their normal's rise."""
    quads = face_quads(mesh, faces)
    outward = mesh.points[quads].mean(axis=1) - mesh.points[mesh.hexahedra[faces[0]]].mean(axis=1)
    normal = area_vectors(mesh, quads)
    normal *= np.sign((normal * outward).sum(axis=1))[:, None]
    return quads, normal[:, 2] / np.linalg.norm(normal, axis=1)


def _widened(mesh: Mesh, touching, free, top: bool, rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Faces and the free ones of their side that share a node with them, and so on, ring by ring."""
    quads, upward = _quads(mesh, free)
    candidates = (upward if top else -upward) > _UPRIGHT
    reached = np.zeros(len(mesh.points), dtype=bool)
    reached[face_quads(mesh, touching)] = True
    chosen = np.zeros(len(quads), dtype=bool)
    for _ in range(rings if len(touching[0]) else 0):
        chosen |= candidates & reached[quads].any(axis=1)
        reached[quads[chosen]] = True
    return tuple(np.concatenate([inner, outer[chosen]]) for inner, outer in zip(touching, free))
