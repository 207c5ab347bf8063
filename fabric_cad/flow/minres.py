"""MINRES for several loads at once, which share every product with the matrix.

C. C. Paige and M. A. Saunders, *Solution of sparse indefinite systems of linear equations*, SIAM
Journal on Numerical Analysis 12 (1975) 617-629, preconditioned as in H. Elman, D. Silvester and A.
Wathen, *Finite elements and fast iterative solvers* (2014), algorithm 4.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..support.errors import SolverError

Operator = Callable[[np.ndarray], np.ndarray]

MOST_ITERATIONS = 20000


@dataclass(frozen=True, eq=False)
class Solution:
    """Unknowns (unknowns, loads), the largest relative residual of a load, and the iterations it took."""

    values: np.ndarray
    residual: float
    iterations: int


def solve(
    multiply: Operator,
    loads: np.ndarray,
    precondition: Operator,
    tolerance: float,
    most: int = MOST_ITERATIONS,
) -> Solution:
    """Solve S x = ``loads`` (unknowns, loads) for a symmetric S, ``precondition`` being positive definite.

    Stops where the residual of every load, in the norm of the preconditioner, is ``tolerance``
    times the load's. Raises :class:`SolverError` with the residual where ``most`` iterations do not
    do.
    """
    count = loads.shape[1]
    values = np.zeros_like(loads)
    older, basis = np.zeros_like(loads), loads.copy()
    older_way, way = np.zeros_like(loads), np.zeros_like(loads)
    conditioned = precondition(basis)
    before, length = np.ones(count), np.sqrt(_products(conditioned, basis))
    start, remaining = length.copy(), length.copy()
    sines, cosines = np.zeros((2, count)), np.ones((2, count))  # of the two rotations before

    for iteration in range(1, most + 1):
        if not (start > 0).any():
            return Solution(values, 0.0, 0)

        going = np.abs(remaining) > tolerance * start
        scale = np.where(length > 0, 1 / np.where(length > 0, length, 1.0), 0.0)
        unit = conditioned * scale
        image = multiply(unit)
        diagonal = _products(image, unit)
        image -= diagonal * scale * basis
        image -= length / before * older
        older, basis = basis, image
        conditioned = precondition(basis)
        before, length = (
            np.where(length > 0, length, 1.0),
            np.sqrt(np.maximum(_products(conditioned, basis), 0.0)),
        )

        head = cosines[1] * diagonal - cosines[0] * sines[1] * before
        pivot = np.hypot(head, length)
        second = sines[1] * diagonal + cosines[0] * cosines[1] * before
        third = sines[0] * before
        inverse = np.where(pivot > 0, 1 / np.where(pivot > 0, pivot, 1.0), 0.0)
        newest = (unit - third * older_way - second * way) * inverse
        older_way, way = way, newest
        sines, cosines = (
            np.stack([sines[1], length * inverse]),
            np.stack([cosines[1], head * inverse]),
        )

        values += (
            np.where(going, cosines[1] * remaining, 0.0) * way
        )  # a load that is solved stays as it is
        remaining = np.where(going, -sines[1] * remaining, remaining)
        if not np.isfinite(remaining).all():
            break
        reached = float(np.max(np.abs(remaining) / np.where(start > 0, start, 1.0)))
        if reached <= tolerance:
            return Solution(values, reached, iteration)

    largest = f"the residual is {reached:.3g} of the load, above {tolerance:g}"
    raise SolverError(
        f"the flow was not solved: after {iteration} iterations {largest}; nothing is written"
    )


def _products(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Inner products (loads,) of columns."""
    return np.einsum("nl,nl->l", first, second)
