"""A cell's matrix and approximate inverses of it, each a function of vectors (unknowns, loads)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...support.iterative import Operator

if TYPE_CHECKING:
    from scipy.sparse import bsr_array

_SAME_LINE = 1e-6  # mm: nodes whose places in plan are nearer stand above each other


def product(matrix: bsr_array, loads: int) -> Operator:
    """The matrix itself, for vectors (unknowns, ``loads``)."""
    if matrix.blocksize != (3, 3) or loads != 6:
        return matrix.__matmul__

    from .kernels import multiply

    def multiplied(values: np.ndarray) -> np.ndarray:
        result = np.empty_like(values)
        multiply(
            matrix.indptr,
            matrix.indices,
            matrix.data,
            values.reshape(-1, 3, 6),
            result.reshape(-1, 3, 6),
        )
        return result

    return multiplied


def block_jacobi(matrix: bsr_array) -> Operator:
    """The inverse of the diagonal blocks."""
    size = matrix.blocksize[0]
    inverse = np.linalg.inv(_diagonal(matrix))

    def precondition(values: np.ndarray) -> np.ndarray:
        return np.matmul(inverse, values.reshape(-1, size, values.shape[1])).reshape(values.shape)

    return precondition


def vertical_lines(matrix: bsr_array, points: np.ndarray) -> Operator:
    """The inverse of the blocks of all nodes ``points`` (nodes, 3), mm, that stand above each other, and of them alone.

    Layers are thinner than elements are wide, so that neighbours on a vertical line are the ones
    that pull most. Of an element two nodes lie on a line, so that what is left of its own matrix,
    and with it the whole, stays positive definite. For matrices of blocks 3 x 3 and six vectors.
    """
    from .kernels import sweep

    order, follows = _lines(points)
    inverse, carried = _factors(_diagonal(matrix)[order], _onward(matrix, order, follows), follows)

    def precondition(values: np.ndarray) -> np.ndarray:
        result = np.empty_like(values)
        sweep(order, follows, inverse, carried, values.reshape(-1, 3, 6), result.reshape(-1, 3, 6))
        return result

    return precondition


def _diagonal(matrix: bsr_array) -> np.ndarray:
    """The diagonal blocks (rows, n, n)."""
    return matrix.data[matrix.indices == _rows(matrix)]


def _rows(matrix: bsr_array) -> np.ndarray:
    """The row of every block."""
    return np.repeat(np.arange(len(matrix.indptr) - 1), np.diff(matrix.indptr))


def _lines(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The nodes line by line, upwards, and for each whether it follows the one before on its line."""
    plan = np.round(points[:, :2] / _SAME_LINE).astype(np.int64)
    order = np.lexsort((points[:, 2], plan[:, 1], plan[:, 0]))
    follows = np.concatenate([[False], (np.diff(plan[order], axis=0) == 0).all(axis=1)])
    return order, follows


def _onward(matrix: bsr_array, order: np.ndarray, follows: np.ndarray) -> np.ndarray:
    """In the order of lines, the block (rows, 3, 3) of every node and the next of its line.

    Zero at a line's end.
    """
    following = np.full(len(order), -1)
    following[order[:-1]] = np.where(follows[1:], order[1:], -1)
    rows = _rows(matrix)
    chosen = matrix.indices == following[rows]
    blocks = np.zeros((len(order), *matrix.blocksize))
    blocks[rows[chosen]] = matrix.data[chosen]
    return blocks[order]


def _factors(
    diagonal: np.ndarray, onward: np.ndarray, follows: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Inverses of the pivots and those times the onward blocks, all lines a step at a time."""
    inverse, carried = np.empty_like(diagonal), np.empty_like(diagonal)
    places = np.flatnonzero(~follows)
    pivots = diagonal[places]
    ends = np.append(follows[1:], False)
    while len(places):
        inverse[places] = np.linalg.inv(pivots)
        carried[places] = inverse[places] @ onward[places]
        places = places[ends[places]] + 1
        pivots = diagonal[places] - onward[places - 1].transpose(0, 2, 1) @ carried[places - 1]

    return inverse, carried
