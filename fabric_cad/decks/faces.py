"""A mesh's faces as solvers number them, and the surfaces that touch."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..meshing.hexahedron import FACES
from ..meshing.mesh import Mesh
from ..weave.bodies import Surface, SurfaceKind
from ..weave.directions import DIRECTIONS


@dataclass(frozen=True, eq=False)
class Faces:
    """Faces of a mesh as solvers name them: ``elements`` (faces,) and their ``sides`` (0: S1 ... 5: S6)."""

    elements: np.ndarray
    sides: np.ndarray

    def __len__(self) -> int:
        return len(self.elements)

    def __getitem__(self, chosen: np.ndarray) -> Faces:
        """Those of a mask or of indices."""
        return Faces(self.elements[chosen], self.sides[chosen])

    @staticmethod
    def together(parts: Sequence[Faces]) -> Faces:
        """The faces of all parts, one after another."""
        none = np.empty(0, dtype=np.int64)
        return Faces(
            np.concatenate([none, *(part.elements for part in parts)]),
            np.concatenate([none, *(part.sides for part in parts)]),
        )


_UPRIGHT = 0.1  # sine up to which a face is one of the yarn's sides, neither top nor bottom


def element_faces(mesh: Mesh) -> dict[Surface, Faces]:
    """For every surface, the faces of the elements of its body that it bounds, in their order.

    Raises ValueError where a quadrilateral is the face of no element of the body.
    """
    count = len(mesh.bodies)
    every = _faces_on(mesh, mesh.surfaces.values())
    # bodies that are bonded share faces
    keys = _keys(mesh, every) * count + mesh.body[every.elements]
    wanted = {
        surface: _face_keys(quads, len(mesh.points)) * count + mesh.bodies.index(surface.body)
        for surface, quads in mesh.surfaces.items()
    }
    return {surface: _sought(surface.name, each, keys, every) for surface, each in wanted.items()}


def outer_faces(mesh: Mesh, surfaces: Mapping[str, np.ndarray]) -> dict[str, Faces]:
    """The same for quadrilaterals (quads, 4) on the outside of a mesh, which are the face of one element each."""
    every = _faces_on(mesh, surfaces.values())
    keys = _keys(mesh, every)
    return {
        name: _sought(name, _face_keys(quads, len(mesh.points)), keys, every)
        for name, quads in surfaces.items()
    }


def _faces_on(mesh: Mesh, surfaces: Iterable[np.ndarray]) -> Faces:
    """All faces of elements with no corner off the surfaces."""
    on_surface = np.zeros(len(mesh.points), dtype=bool)
    for quads in surfaces:
        on_surface[quads] = True
    return Faces(*np.nonzero(on_surface[mesh.hexahedra[:, FACES]].all(axis=2)))


def _keys(mesh: Mesh, faces: Faces) -> np.ndarray:
    return _face_keys(mesh.hexahedra[faces.elements[:, None], FACES[faces.sides]], len(mesh.points))


def _sought(name: str, wanted: np.ndarray, keys: np.ndarray, every: Faces) -> Faces:
    """The faces among ``every`` of which the ``keys`` are those ``wanted``, by element."""
    if not len(wanted):
        return every[np.empty(0, dtype=np.int64)]
    order = np.argsort(keys)
    at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(order) - 1)]
    if not np.array_equal(keys[at], wanted):
        raise ValueError(f"surface {name} has a quadrilateral that bounds no element")
    return every[at[np.argsort(every.elements[at], kind="stable")]]


def _face_keys(quads: np.ndarray, nodes: int) -> np.ndarray:
    """One number per quadrilateral, the same for any order of its corners.

    Two diagonally opposite corners name a face of a hexahedral mesh: the smallest node
    number and the one across from it.
    """
    smallest = quads.argmin(axis=1)
    rows = np.arange(len(quads))
    return quads[rows, smallest].astype(np.int64) * nodes + quads[rows, (smallest + 2) % 4]


def touching_faces(mesh: Mesh, rings: int = 0) -> dict[str, Faces]:
    """The contact patches by direction and side, ``weft_top``, ``weft_bottom``, ``warp_top``, ``warp_bottom``.

    Each is widened by ``rings`` of free faces of the same side. Tops and bottoms are apart because
    a solver's contact search confuses the two sides of a yarn in one surface.
    """
    faces = element_faces(mesh)
    names = [f"{direction}_{side}" for direction in DIRECTIONS for side in ("top", "bottom")]
    patches: dict[str, list[Faces]] = {name: [] for name in names}

    for yarn in mesh.yarns:
        touching, free = (
            faces[Surface(yarn, SurfaceKind.CONTACT)],
            faces.get(Surface(yarn, SurfaceKind.FREE)),
        )
        _, upward = _quads(mesh, touching)

        for side, chosen in (("top", upward > 0), ("bottom", upward <= 0)):
            taken = touching[chosen]
            if rings and free is not None:
                taken = _widened(mesh, taken, free, side == "top", rings)
            patches[f"{yarn.direction}_{side}"].append(taken)

    return {name: Faces.together(parts) for name, parts in patches.items()}


def face_quads(mesh: Mesh, faces: Faces) -> np.ndarray:
    """Corner nodes (faces, 4) of faces."""
    return mesh.hexahedra[faces.elements[:, None], FACES[faces.sides]]


def area_vectors(mesh: Mesh, quads: np.ndarray) -> np.ndarray:
    """Normals (quads, 3) of quadrilaterals, mm, as long as their area, mm2."""
    corners = mesh.points[quads]
    return np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]) / 2


def _quads(mesh: Mesh, faces: Faces) -> tuple[np.ndarray, np.ndarray]:
    """Corner nodes (quads, 4) of element faces and how far they look up: the sine of their normal's rise."""
    quads = face_quads(mesh, faces)
    outward = mesh.points[quads].mean(axis=1) - mesh.points[mesh.hexahedra[faces.elements]].mean(
        axis=1
    )
    normal = area_vectors(mesh, quads)
    normal *= np.sign((normal * outward).sum(axis=1))[:, None]
    return quads, normal[:, 2] / np.linalg.norm(normal, axis=1)


def _widened(mesh: Mesh, touching: Faces, free: Faces, top: bool, rings: int) -> Faces:
    """Faces and the free ones of their side that share a node with them, and so on, ring by ring."""
    quads, upward = _quads(mesh, free)
    candidates = (upward if top else -upward) > _UPRIGHT
    reached = np.zeros(len(mesh.points), dtype=bool)
    reached[face_quads(mesh, touching)] = True
    chosen = np.zeros(len(quads), dtype=bool)
    for _ in range(rings if len(touching) else 0):
        chosen |= candidates & reached[quads].any(axis=1)
        reached[quads[chosen]] = True
    return Faces.together([touching, free[chosen]])
