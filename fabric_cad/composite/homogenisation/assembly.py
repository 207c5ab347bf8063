"""Equations of a periodic cell: element integrals, summed into one sparse matrix of blocks.

::

    K[a i, b k] = sum over elements and j, l of c[i, k, j, l] M[a j, b l],   M = integral of dN_a/dx_j dN_b/dx_l

which serves elasticity (blocks 3 x 3, c = C_ijkl) and conduction (1 x 1, c = k_jl) alike. The
coefficients are constant over an element, so that M is made once an element for all blocks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from scipy.sparse import bsr_array

from .elements import Elements

VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
"""Number of a tensor's component among xx, yy, zz, yz, xz, xy."""


@dataclass(frozen=True, eq=False)
class Integrals:
    """Integrals over every element.

    ``gradients`` and ``moments`` (elements, 8, 3): of the basis functions' gradients, mm2, and of
    those times the height above the middle of the cell, mm3; ``volumes`` (3, elements): of 1, of
    that height and of its square; ``corners`` (elements, 8): the unknowns.
    """

    gradients: np.ndarray
    moments: np.ndarray
    volumes: np.ndarray
    corners: np.ndarray


def assemble(elements: Elements, coefficients: np.ndarray) -> tuple[bsr_array, Integrals]:
    """The matrix of ``coefficients`` (elements, n, n, 3, 3), c[i, k, j, l] above, and the integrals."""
    count, size = elements.count, coefficients.shape[1]
    from scipy.sparse import bsr_array

    corners = elements.unknowns[elements.mesh.hexahedra]
    rows, columns, places = _pattern(corners, count)
    blocks = np.zeros((len(columns), size, size))
    integrals = Integrals(
        np.empty((len(corners), 8, 3)),
        np.empty((len(corners), 8, 3)),
        np.empty((3, len(corners))),
        corners,
    )

    for chunk in elements.chunks():
        own, weights, gradients = chunk.elements, chunk.weights, chunk.gradients
        raised = weights * chunk.heights
        integrals.volumes[:, own] = (
            weights.sum(axis=1),
            raised.sum(axis=1),
            (raised * chunk.heights).sum(axis=1),
        )
        integrals.gradients[own] = np.einsum("nq,nqaj->naj", weights, gradients)
        integrals.moments[own] = np.einsum("nq,nqaj->naj", raised, gradients)

        local = _local(coefficients[own], gradients, weights)
        for i in range(size):
            for k in range(size):
                np.add.at(blocks[:, i, k], places[own].ravel(), local[:, i * size + k].ravel())

    matrix = bsr_array((blocks, columns, rows), shape=(count * size, count * size))
    return matrix, integrals


def elastic_coefficients(stiffness: np.ndarray) -> np.ndarray:
    """The coefficients c[i, k, j, l] = C_ijkl (elements, 3, 3, 3, 3) of stiffnesses (elements, 6, 6)."""
    i, k, j, l = np.ogrid[:3, :3, :3, :3]  # noqa: E741 (the indices' usual names)
    return stiffness[:, VOIGT[i, j], VOIGT[k, l]]


def forces(
    integrals: np.ndarray, stresses: np.ndarray, corners: np.ndarray, count: int
) -> np.ndarray:
    """Nodal forces (count, 3, loads) of ``stresses`` (elements, 6, loads), constant over an element.

    ``integrals`` (elements, 8, 3) are those of the gradients, or their moments where the stresses
    are a rate over the height.
    """
    total = np.zeros((count, 3, stresses.shape[2]))
    for i in range(3):
        own = np.einsum("naj,njm->nam", integrals, stresses[:, VOIGT[i]])
        for load in range(stresses.shape[2]):
            total[:, i, load] = np.bincount(
                corners.ravel(), own[..., load].ravel(), minlength=count
            )

    return total


def _local(coefficients: np.ndarray, gradients: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Blocks (elements, n n, 8, 8) of every element."""
    elements, points = weights.shape
    scaled = (gradients * np.sqrt(weights)[..., None, None]).reshape(elements, points, 24)
    products = np.matmul(scaled.transpose(0, 2, 1), scaled).reshape(elements, 8, 3, 8, 3)
    products = products.transpose(0, 2, 4, 1, 3).reshape(elements, 9, 64)  # jl, ab

    blocks = np.matmul(coefficients.reshape(elements, -1, 9), products)
    return blocks.reshape(elements, -1, 8, 8)


def _pattern(corners: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Row starts and columns of the blocks there are, and the place (elements, 8, 8) of every pair among them."""
    keys = corners[:, :, None] * count + corners[:, None, :]
    blocks, places = np.unique(keys, return_inverse=True)
    rows, columns = np.divmod(blocks, count)
    starts = np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=count))])
    return (
        starts.astype(np.int32),
        columns.astype(np.int32),
        places.reshape(keys.shape).astype(np.int32),
    )
