"""Stokes's equations of a cell whose flow is driven by a uniform force, as sparse matrices.

With unit viscosity, velocity u (mm2 under a unit pressure gradient) and pressure p (mm),

    integral of grad u : grad v  -  p div v  =  f . integral of v,     integral of q div u = 0,

for all v that vanish on the walls and all q. One scalar Laplacian serves the three components.
Where the space is porous the first line has Brinkman's drag, integral of v . k^-1 u, beside it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from scipy.sparse import coo_array, csr_array

from .lines import lines_of, vertical_links
from .quadratic import CORNER_NODES, Chunk, QuadraticMesh

_NO_DRAG = 1e-12  # of the largest: rounding


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations in the free unknowns.

    ``laplacian`` (nodes, nodes), mm; ``divergence`` (corners, 3 nodes), mm2, components of a node
    side by side; ``weights`` (nodes,): the integral of every node's basis function, mm3; ``masses``
    (corners,) that of a corner's. ``free`` (nodes, 3) tells which components may move, ``line``
    (nodes,) on which vertical line a node stands; ``node`` (nodes of the mesh,) and ``corner``
    (corners of the mesh,) are the numbers here, -1 for none. ``drag`` maps components (i, j), i <=
    j, to matrices (nodes, nodes), mm; ``seepage`` (corners, corners), mm3, is what pressure
    differences drive through pores, None without drag; ``volumes`` (elements,), mm3.
    """

    laplacian: csr_array
    divergence: csr_array
    weights: np.ndarray
    masses: np.ndarray
    free: np.ndarray
    line: np.ndarray
    node: np.ndarray
    corner: np.ndarray
    volumes: np.ndarray
    drag: Mapping[tuple[int, int], csr_array]
    seepage: csr_array | None


def assemble(
    mesh: QuadraticMesh, fixed: np.ndarray, resistance: np.ndarray | None = None
) -> Equations:
    """The equations of a mesh, where ``fixed`` (nodes of the mesh, 3) are velocities that vanish.

    ``resistance`` (elements, 3, 3), 1/mm2, is the inverse of the permeability where the space is
    porous, else 0. Raises :class:`~fabric_cad.support.errors.BuildError` where faces that repeat do
    not match or elements are folded.
    """
    held = np.zeros((mesh.unknowns.max() + 1, 3), dtype=bool)
    np.logical_or.at(held, mesh.unknowns, fixed)
    number = np.where(held.all(axis=1), -1, np.cumsum(~held.all(axis=1)) - 1)
    node = number[mesh.unknowns]
    corner = np.unique(mesh.unknowns[: len(mesh.mesh.points)], return_inverse=True)[1]
    count, corner_count = int(node.max()) + 1, int(corner.max()) + 1

    sums = _Sums(len(mesh.nodes), count, corner_count)
    porous = _Porous(mesh, resistance, (count, corner_count))
    for chunk in mesh.chunks():
        own = node[mesh.nodes[chunk.elements]]
        ends = corner[mesh.nodes[chunk.elements][:, CORNER_NODES]]
        sums.add(chunk, own, ends)
        porous.add(chunk, own, ends)

    free = np.empty((count, 3), dtype=bool)
    free[number[number >= 0]] = ~held[number >= 0]
    links = node[vertical_links(mesh)]
    return Equations(
        laplacian=sums.laplacian,
        divergence=sums.divergence,
        weights=sums.weights[:count],
        masses=sums.masses,
        free=free,
        line=lines_of(links[(links >= 0).all(axis=1)], count),
        node=node,
        corner=corner,
        volumes=sums.volumes,
        drag=MappingProxyType(porous.drag),
        seepage=porous.seepage,
    )


class _Sums:
    """The matrices and weights of viscous flow while elements are summed."""

    def __init__(self, elements: int, nodes: int, corners: int) -> None:
        self.laplacian = csr_array((nodes, nodes))
        self.divergence = csr_array((corners, 3 * nodes))
        self.weights = np.zeros(nodes + 1)  # the last is that of held nodes, number -1
        self.masses = np.zeros(corners)
        self.volumes = np.empty(elements)

    def add(self, chunk: Chunk, own: np.ndarray, ends: np.ndarray) -> None:
        """Add some elements with their nodes ``own`` (n, 27) and corners ``ends`` (n, 8)."""
        weights, gradients = chunk.weights, chunk.gradients
        scaled = (gradients * np.sqrt(weights)[..., None, None]).transpose(0, 2, 1, 3)
        scaled = scaled.reshape(len(own), 27, -1)
        products = np.matmul(scaled, scaled.transpose(0, 2, 1))
        self.laplacian = self.laplacian + _matrix(products, own, own, self.laplacian.shape)

        local = np.einsum("nq,nqb,nqac->nbac", weights, chunk.linear, gradients, optimize=True)
        components = np.where(own[..., None] < 0, -1, 3 * own[..., None] + np.arange(3))
        self.divergence = self.divergence + _matrix(
            local.reshape(len(own), 8, 81),
            ends,
            components.reshape(len(own), 81),
            self.divergence.shape,
        )

        np.add.at(self.weights, own, np.einsum("nq,nqa->na", weights, chunk.values))
        np.add.at(self.masses, ends, np.einsum("nq,nqb->nb", weights, chunk.linear))
        self.volumes[chunk.elements] = weights.sum(axis=1)


class _Porous:
    """The matrices of drag and seepage while elements are summed."""

    def __init__(
        self, mesh: QuadraticMesh, resistance: np.ndarray | None, counts: tuple[int, int]
    ) -> None:
        self.drag: dict[tuple[int, int], csr_array] = {}
        self.seepage: csr_array | None = None
        self._resistance, self._counts = resistance, counts
        if resistance is None:
            return

        size = np.abs(resistance).max(axis=(0, 1, 2))
        for i in range(3):
            for j in range(i, 3):
                if np.abs(resistance[:, i, j]).max() > _NO_DRAG * size:
                    self.drag[i, j] = csr_array((counts[0], counts[0]))

        self.seepage = csr_array((counts[1], counts[1]))
        is_porous = resistance.any(axis=(1, 2))
        # so far off the pores that it hardly counts
        free = np.eye(3) * mesh.mesh.vectors[2, 2] ** 2
        self._permeability = np.broadcast_to(free, resistance.shape).copy()
        self._permeability[is_porous] = np.linalg.inv(resistance[is_porous])

    def add(self, chunk: Chunk, own: np.ndarray, ends: np.ndarray) -> None:
        """Add some elements with their nodes ``own`` (n, 27) and corners ``ends`` (n, 8)."""
        if self._resistance is None or self.seepage is None:
            return

        mass = np.einsum(
            "nq,nqa,nqb->nab", chunk.weights, chunk.values, chunk.values, optimize=True
        )
        for (i, j), matrix in self.drag.items():
            local = self._resistance[chunk.elements, i, j, None, None] * mass
            self.drag[i, j] = matrix + _matrix(local, own, own, matrix.shape)

        slopes = chunk.linear_gradients
        flux = np.einsum("nij,nqcj->nqci", self._permeability[chunk.elements], slopes)
        local = np.einsum("nq,nqbi,nqci->nbc", chunk.weights, slopes, flux, optimize=True)
        self.seepage = self.seepage + _matrix(local, ends, ends, self.seepage.shape)


def _matrix(
    local: np.ndarray, rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]
) -> csr_array:
    """The sum of local matrices (elements, m, n) over ``rows`` (elements, m) and ``columns``.

    -1 are left out.
    """
    row, column = np.broadcast_arrays(rows[:, :, None], columns[:, None, :])
    kept = (row >= 0) & (column >= 0)
    return coo_array((local[kept], (row[kept], column[kept])), shape=shape).tocsr()
