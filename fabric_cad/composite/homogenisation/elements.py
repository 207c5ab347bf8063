"""Trilinear hexahedra by scikit-fem: basis functions, quadrature and the numbering over periodic faces.

Their corners stand in another order there; here it is that of VTK and C3D8::

        7-------6
       /|      /|
      4-------5 |      z
      | 3-----|-2      | y
      |/      |/       |/
      0-------1        o--- x
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...support.scikit_fem import scikit_fem
from .periodicity import PeriodicMesh, periodic_pairs

_UNIT_CUBE = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
)
_CHUNK = 2048  # elements, so that what is made of them stays in the cache


@dataclass(frozen=True, eq=False)
class Chunk:
    """Some elements at 2 x 2 x 2 points: ``elements`` (n,) their indices, ``corners`` (n, 8) their unknowns.

    ``gradients`` (n, points, 8, 3), 1/mm, of the corners' basis functions; ``weights`` (n, points),
    mm3; ``heights`` (n, points), mm, of the points above the cell's middle.
    """

    elements: np.ndarray
    corners: np.ndarray
    gradients: np.ndarray
    weights: np.ndarray
    heights: np.ndarray


@dataclass(frozen=True, eq=False)
class Elements:
    """The elements of a periodic mesh, chunk by chunk, with nodes that are the same by a period numbered as one.

    Raises :class:`~fabric_cad.support.errors.BuildError` where faces that repeat do not match,
    ValueError where an element reaches from one to the other.
    """

    mesh: PeriodicMesh

    @cached_property
    def unknowns(self) -> np.ndarray:
        """For every node (nodes,) the number of its unknown."""
        numbers = np.empty(len(self.mesh.points), dtype=np.int64)
        numbers[self.mesh.hexahedra] = self._dofs.T[:, _to_skfem()[1]]
        return numbers

    @property
    def count(self) -> int:
        """How many unknowns a scalar field has."""
        return int(self._dofs.max()) + 1

    @property
    def places(self) -> np.ndarray:
        """Where every unknown is, (unknowns, 3) mm.

        One of its places where it is on faces that repeat.
        """
        places = np.empty((self.count, 3))
        places[self.unknowns] = self.mesh.points
        return places

    def chunks(self) -> Iterator[Chunk]:
        """All elements, some at a time."""
        skfem = scikit_fem()
        _, back = _to_skfem()
        middle = self.mesh.origin[2] + self.mesh.vectors[2, 2] / 2

        for start in range(0, len(self.mesh.hexahedra), _CHUNK):
            elements = np.arange(start, min(start + _CHUNK, len(self.mesh.hexahedra)))
            mapping = skfem.MappingIsoparametric(
                self._skfem, skfem.ElementHex1(), skfem.ElementQuad1()
            )
            basis = skfem.CellBasis(
                self._skfem,
                skfem.ElementHex1(),
                mapping,
                intorder=2,
                elements=elements,
                disable_doflocs=True,
            )
            gradients = np.stack([basis.basis[corner][0].grad for corner in back])
            yield Chunk(
                elements,
                self._dofs[:, elements].T[:, back],
                np.ascontiguousarray(gradients.transpose(2, 3, 0, 1)),
                basis.dx,
                np.asarray(mapping.F(basis.X, tind=elements))[2] - middle,
            )

    @cached_property
    def _skfem(self):
        """The mesh as scikit-fem takes it, periodic where the cell is."""
        skfem = scikit_fem()
        to, _ = _to_skfem()
        points = np.ascontiguousarray(self.mesh.points.T)
        corners = np.ascontiguousarray(self.mesh.hexahedra[:, to].T.astype(np.int32))
        mesh = skfem.MeshHex1(points, corners, sort_t=False, validate=False)
        slaves, masters = periodic_pairs(self.mesh)
        return skfem.mesh.MeshHex1DG.periodic(mesh, slaves, masters) if len(slaves) else mesh

    @cached_property
    def _dofs(self) -> np.ndarray:
        """Unknowns (8, elements), corners in scikit-fem's order."""
        return np.asarray(self._skfem.t)


def _to_skfem() -> tuple[np.ndarray, np.ndarray]:
    """VTK's corner at each of scikit-fem's, and scikit-fem's at each of VTK's, (8,) each."""
    to = np.array(
        [
            int(np.flatnonzero((_UNIT_CUBE == corner).all(axis=1))[0])
            for corner in scikit_fem().refdom.RefHex.p.T
        ]
    )
    return to, np.argsort(to)
