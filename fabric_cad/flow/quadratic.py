"""Triquadratic hexahedra of a periodic cell: 27 nodes each, in three layers of nine.

::

     6---7---8    15--16--17    24--25--26      t
     3   4   5    12  13  14    21  22  23      | s
     0---1---2     9--10--11    18--19--20      |/
      t = -1        t = 0         t = 1         +-- r

Velocity lives on all nodes, pressure on the eight corners.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..composite.homogenisation.periodicity import PeriodicMesh, periodic_pairs
from ..meshing.hexahedron import CORNERS
from ..support.arrays import read_only
from ..support.errors import BuildError
from ..support.scikit_fem import scikit_fem

PLACES = read_only(
    np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)[:, ::-1]
)
"""Natural coordinates r, s, t of the 27 nodes, (27, 3)."""

CORNER_NODES = read_only(
    np.array([int(np.flatnonzero((PLACES == corner).all(axis=1))[0]) for corner in CORNERS])
)
"""The nodes (8,) that are the corners, in the order of VTK and C3D8."""

FACE_NODES = read_only(
    np.stack([np.flatnonzero(PLACES[:, axis] == end) for axis in range(3) for end in (-1, 1)]),
)
"""The nine nodes of each of the six faces, (6, 9); the fifth is its middle."""

_CHUNK = 2048  # elements, so that what is made of them stays in the cache
_ON_FACE = 1e-7  # of a period


@dataclass(frozen=True, eq=False)
class Chunk:
    """Some elements at 3 x 3 x 3 points.

    ``elements`` (n,) their indices; ``values`` (n, points, 27) and ``gradients`` (n, points, 27,
    3), 1/mm, of the nodes' basis functions, ``linear`` (n, points, 8) and ``linear_gradients`` (n,
    points, 8, 3) of the corners alone; ``weights`` (n, points), mm3.
    """

    elements: np.ndarray
    values: np.ndarray
    gradients: np.ndarray
    linear: np.ndarray
    linear_gradients: np.ndarray
    weights: np.ndarray


@dataclass(frozen=True, eq=False)
class QuadraticMesh:
    """A periodic mesh with nodes between its corners.

    ``points`` (nodes, 3) mm, the corners' first, in the order of ``mesh``; ``nodes`` (elements, 27)
    as drawn above.
    """

    mesh: PeriodicMesh
    points: np.ndarray
    nodes: np.ndarray = field(repr=False)

    @classmethod
    def straight(cls, mesh: PeriodicMesh) -> QuadraticMesh:
        """The mesh with nodes midway, so that its faces are those of trilinear hexahedra."""
        numbers = np.empty((len(mesh.hexahedra), 27), dtype=np.int64)
        points, count = [mesh.points], len(mesh.points)
        numbers[:, CORNER_NODES] = mesh.hexahedra

        for free in (1, 2, 3):  # edges, faces, middles
            own = np.flatnonzero(np.count_nonzero(PLACES == 0, axis=1) == free)
            keys = np.stack(
                [np.sort(mesh.hexahedra[:, _corners_around(PLACES[node])], axis=1) for node in own],
                axis=1,
            )
            corners, number = np.unique(keys.reshape(-1, 2**free), axis=0, return_inverse=True)
            numbers[:, own] = count + number.reshape(-1, len(own))
            points.append(mesh.points[corners].mean(axis=1))
            count += len(corners)

        return cls(mesh, np.concatenate(points), numbers)

    def moved(self, displacements: np.ndarray) -> QuadraticMesh:
        """The same with nodes moved by ``displacements`` (nodes, 3), mm."""
        return replace(self, points=self.points + displacements)

    @cached_property
    def unknowns(self) -> np.ndarray:
        """For every node (nodes,) the number of its unknown: nodes that are the same by a period have one."""
        stands_for = np.arange(len(self.points))
        slaves, masters = periodic_pairs(replace(self.mesh, points=self.points))
        stands_for[slaves] = masters
        return np.unique(stands_for, return_inverse=True)[1]

    @cached_property
    def boundary(self) -> np.ndarray:
        """Faces (faces, 9 nodes) that belong to one hexahedron, where the cell does not repeat."""
        faces = self.nodes[:, FACE_NODES].reshape(-1, 9)
        outer = faces[np.bincount(faces[:, 4])[faces[:, 4]] == 1]
        shares = (self.points[outer] - self.mesh.origin) @ np.linalg.inv(self.mesh.vectors)
        on_face = [(np.abs(shares - end) < _ON_FACE).all(axis=1) for end in (0.0, 1.0)]
        repeats = ((on_face[0] | on_face[1]) & np.array(self.mesh.periodic)).any(axis=1)
        return outer[~repeats]

    def folded(self) -> np.ndarray:
        """Indices of the hexahedra whose volume is not positive everywhere, as seen from 3 x 3 x 3 points."""
        skfem = scikit_fem()
        points = skfem.CellBasis(
            self._skfem, skfem.ElementHex1(), intorder=5, elements=[0], disable_doflocs=True
        ).X
        return np.flatnonzero(~(self._mapping().detDF(points) > 0).all(axis=1))

    def chunks(self) -> Iterator[Chunk]:
        """All elements, some at a time. Raises :class:`BuildError` where one is folded over."""
        skfem, order = scikit_fem(), _from_skfem()
        back = np.argsort(order)
        to_corner = [int(np.flatnonzero(order[:8] == node)[0]) for node in CORNER_NODES]

        for start in range(0, len(self.nodes), _CHUNK):
            elements = np.arange(start, min(start + _CHUNK, len(self.nodes)))
            options = {
                "mapping": self._mapping(),
                "intorder": 5,
                "elements": elements,
                "disable_doflocs": True,
            }
            basis = skfem.CellBasis(self._skfem, skfem.ElementHex2(), **options)
            linear = skfem.CellBasis(self._skfem, skfem.ElementHex1(), **options)
            if not (options["mapping"].detDF(basis.X, tind=elements) > 0).all():
                raise BuildError(
                    "a hexahedron of the space between the yarns is folded over; ask for a finer mesh"
                )

            shape = (len(elements), basis.X.shape[-1])
            yield Chunk(
                elements,
                np.stack([np.broadcast_to(basis.basis[node][0], shape) for node in back], axis=-1),
                np.stack([basis.basis[node][0].grad for node in back]).transpose(2, 3, 0, 1),
                np.stack(
                    [np.broadcast_to(linear.basis[node][0], shape) for node in to_corner], axis=-1
                ),
                np.stack([linear.basis[node][0].grad for node in to_corner]).transpose(2, 3, 0, 1),
                basis.dx,
            )

    @cached_property
    def _skfem(self):
        """The mesh as scikit-fem takes it; that numbers edges and faces itself."""
        skfem, order = scikit_fem(), _from_skfem()
        corners = np.ascontiguousarray(self.nodes[:, order[:8]].T.astype(np.int32))
        plain = skfem.MeshHex1(
            np.ascontiguousarray(self.mesh.points.T), corners, sort_t=False, validate=False
        )
        theirs = skfem.Dofs(plain, skfem.ElementHex2()).element_dofs
        places = np.empty((3, theirs.max() + 1))
        places[:, theirs] = self.points[self.nodes[:, order].T].transpose(2, 0, 1)
        return skfem.MeshHex2(places, corners, sort_t=False, validate=False)

    def _mapping(self):
        """From natural coordinates to places.

        It keeps what it is asked for, so that one serves one chunk.
        """
        skfem = scikit_fem()
        return skfem.MappingIsoparametric(self._skfem, skfem.ElementHex2(), skfem.ElementQuad2())


def _corners_around(place: np.ndarray) -> np.ndarray:
    """The corners (of the hexahedron's eight) between which a node at a natural ``place`` (3,) lies."""
    return np.flatnonzero(((CORNERS == place) | (place == 0)).all(axis=1))


def _from_skfem() -> np.ndarray:
    """Our node (27,) at each of scikit-fem's."""
    places = np.round(2 * scikit_fem().ElementHex2.doflocs - 1)
    return np.array([int(np.flatnonzero((PLACES == place).all(axis=1))[0]) for place in places])
