"""Loops that numpy has no word for, compiled by numba at their first use and kept in its cache.

Beside scipy's product of a block matrix with six vectors the one here takes a third to a fifth of
the time, and :func:`sweep` cannot be had from numpy without many small steps.
"""

from __future__ import annotations

from collections.abc import Callable

import numba
import numpy as np


def _compiled(function: Callable) -> Callable:
    """The function as machine code, which the next process finds ready where there is a place to keep it."""
    try:
        return numba.njit(cache=True)(function)
    except RuntimeError:  # neither the package's folder nor the user's can be written to
        return numba.njit(function)


@_compiled
def multiply(starts, columns, blocks, vectors, product):
    """A matrix of ``blocks`` (blocks, 3, 3) times ``vectors`` (rows, 3, 6), into ``product``.

    The blocks from ``starts[row]`` to ``starts[row + 1]`` are those of a row, in ``columns``.
    """
    for row in range(len(starts) - 1):
        total = np.zeros((3, 6))
        for place in range(starts[row], starts[row + 1]):
            column = columns[place]
            for i in range(3):
                first, second, third = blocks[place, i, 0], blocks[place, i, 1], blocks[place, i, 2]
                for load in range(6):
                    total[i, load] += (
                        first * vectors[column, 0, load]
                        + second * vectors[column, 1, load]
                        + third * vectors[column, 2, load]
                    )

        for i in range(3):
            for load in range(6):
                product[row, i, load] = total[i, load]


@_compiled
def sweep(order, follows, inverse, carried, vectors, result):
    """Solve a block-tridiagonal system along every line of ``order``, for ``vectors`` (rows, 3, 6), into ``result``.

    ``follows`` (rows,) is False where a line starts in ``order``; ``inverse`` (rows, 3, 3) are the
    pivots' inverses and ``carried`` (rows, 3, 3) those times the block to the next of the line,
    both in this order.
    """
    count = len(order)
    for place in range(count):
        row = order[place]
        for i in range(3):
            for load in range(6):
                value = vectors[row, i, load]
                if follows[place]:
                    before = order[place - 1]
                    for j in range(3):
                        value -= carried[place - 1, j, i] * result[before, j, load]

                result[row, i, load] = value

    scratch = np.empty((3, 6))
    for step in range(count):
        place = count - 1 - step
        row = order[place]
        for i in range(3):
            for load in range(6):
                value = 0.0
                for j in range(3):
                    value += inverse[place, i, j] * result[row, j, load]
                if place + 1 < count and follows[place + 1]:
                    after = order[place + 1]
                    for j in range(3):
                        value -= carried[place, i, j] * result[after, j, load]

                scratch[i, load] = value

        for i in range(3):
            for load in range(6):
                result[row, i, load] = scratch[i, load]
