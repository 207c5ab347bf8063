"""Stokes's equations of a cell whose flow is driven by a uniform force, as sparse matrices.

With unit viscosity, velocity u (mm2 under a unit pressure gradient) and pressure p (mm),

    integral of grad u : grad v  -  p div v  =  f . integral of v,     integral of q div u = 0,

for all v that vanish on the walls and all q. One scalar Laplacian serves the three components.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array

from .lines import lines_of, vertical_links
from .quadratic import CORNER_NODES, QuadraticMesh


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations in the free unknowns.

    ``laplacian`` (nodes, nodes), mm; ``divergence`` (corners, 3 nodes), mm2, components of a node side by side;
    ``weights`` (nodes,): the integral of every node's basis function, mm3; ``masses`` (corners,) that of a corner's.
    ``free`` (nodes, 3) tells which components may move, ``line`` (nodes,) on which vertical line a node stands;
    ``node`` (nodes of the mesh,) and ``corner`` (corners of the mesh,) are the numbers here, -1 for none.
    """

    laplacian: csr_array
    divergence: csr_array
    weights: np.ndarray
    masses: np.ndarray
    free: np.ndarray
    line: np.ndarray
    node: np.ndarray
    corner: np.ndarray


def assemble(mesh: QuadraticMesh, fixed: np.ndarray) -> Equations:
    """The equations of a mesh, where ``fixed`` (nodes of the mesh, 3) are velocities that vanish.

    Raises :class:`~fabric_cad.support.errors.BuildError` where faces that repeat do not match or elements are folded.
    """
    held = np.zeros((mesh.unknowns.max() + 1, 3), dtype=bool)
    np.logical_or.at(held, mesh.unknowns, fixed)
    number = np.where(held.all(axis=1), -1, np.cumsum(~held.all(axis=1)) - 1)
    node = number[mesh.unknowns]
    corners = np.unique(mesh.unknowns[: len(mesh.mesh.points)], return_inverse=True)[1]
    count, corner_count = int(node.max()) + 1, int(corners.max()) + 1

    laplacian = csr_array((count, count))
    divergence = csr_array((corner_count, 3 * count))
    weights, masses = np.zeros(count + 1), np.zeros(corner_count)
    for chunk in mesh.chunks():
        own = node[mesh.nodes[chunk.elements]]
        ends = corners[mesh.nodes[chunk.elements][:, CORNER_NODES]]
        scaled = (chunk.gradients * np.sqrt(chunk.weights)[..., None, None]).transpose(0, 2, 1, 3)
        scaled = scaled.reshape(len(own), 27, -1)
        laplacian = laplacian + _matrix(np.matmul(scaled, scaled.transpose(0, 2, 1)), own, own, (count, count))

        local = np.einsum("nq,nqb,nqac->nbac", chunk.weights, chunk.linear, chunk.gradients, optimize=True)
        components = np.where(own[..., None] < 0, -1, 3 * own[..., None] + np.arange(3)).reshape(len(own), 81)
        divergence = divergence + _matrix(local.reshape(len(own), 8, 81), ends, components, divergence.shape)
        np.add.at(weights, own, np.einsum("nq,nqa->na", chunk.weights, chunk.values))
        np.add.at(masses, ends, np.einsum("nq,nqb->nb", chunk.weights, chunk.linear))

    free = np.empty((count, 3), dtype=bool)
    free[number[number >= 0]] = ~held[number >= 0]
    links = node[vertical_links(mesh)]
    line = lines_of(links[(links >= 0).all(axis=1)], count)
    return Equations(laplacian, divergence, weights[:count], masses, free, line, node, corners)


def _matrix(local: np.ndarray, rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]) -> csr_array:
    """The sum of local matrices (elements, m, n) over ``rows`` (elements, m) and ``columns``; -1 are left out."""
    row, column = np.broadcast_arrays(rows[:, :, None], columns[:, None, :])
    kept = (row >= 0) & (column >= 0)
    return coo_array((local[kept], (row[kept], column[kept])), shape=shape).tocsr()
