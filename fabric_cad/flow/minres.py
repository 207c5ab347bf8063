"""MINRES for several loads at once, which share every product with the matrix.

C. C. Paige and M. A. Saunders, *Solution of sparse indefinite systems of linear equations*, SIAM
Journal on Numerical Analysis 12 (1975) 617-629, preconditioned as in H. Elman, D. Silvester and A.
Wathen, *Finite elements and fast iterative solvers* (2014), algorithm 4.1.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..support.iterative import Operator, Solution, not_solved

MOST_ITERATIONS = 20000


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
    values = np.zeros_like(loads)
    steps = _lanczos(multiply, loads, precondition)
    start = next(steps).length
    if not (start > 0).any():
        return Solution(values, 0.0, 0)

    remaining, reached = start.copy(), np.inf
    older_way, way = np.zeros_like(loads), np.zeros_like(loads)
    sines, cosines = np.zeros((2, len(start))), np.ones((2, len(start)))  # of two rotations before
    for iteration, step in zip(range(1, most + 1), steps):
        going = np.abs(remaining) > tolerance * start

        head = cosines[1] * step.diagonal - cosines[0] * sines[1] * step.before
        second = sines[1] * step.diagonal + cosines[0] * cosines[1] * step.before
        third = sines[0] * step.before
        inverse = _inverse(np.hypot(head, step.length))
        older_way, way = way, (step.unit - third * older_way - second * way) * inverse
        sines = np.stack([sines[1], step.length * inverse])
        cosines = np.stack([cosines[1], head * inverse])

        # a load that is solved stays as it is
        values += np.where(going, cosines[1] * remaining, 0.0) * way
        remaining = np.where(going, -sines[1] * remaining, remaining)
        if not np.isfinite(remaining).all():
            break

        reached = float(np.max(np.abs(remaining) / np.where(start > 0, start, 1.0)))
        if reached <= tolerance:
            return Solution(values, reached, iteration)

    raise not_solved("the flow was", iteration, reached, tolerance)


@dataclass(frozen=True, eq=False)
class _Step:
    """A step of Lanczos' process: the entries (loads,) of its tridiagonal matrix, and the basis vector ``unit``."""

    unit: np.ndarray
    diagonal: np.ndarray
    before: np.ndarray
    length: np.ndarray


def _lanczos(multiply: Operator, loads: np.ndarray, precondition: Operator) -> Iterator[_Step]:
    """Lanczos' preconditioned process; the first step has the loads' norms as its ``length``."""
    older, basis = np.zeros_like(loads), loads.copy()
    conditioned = precondition(basis)
    before, length = np.ones(loads.shape[1]), np.sqrt(_products(conditioned, basis))
    yield _Step(conditioned, length, before, length)

    while True:
        scale = _inverse(length)
        unit = conditioned * scale
        image = multiply(unit)
        diagonal = _products(image, unit)
        image -= diagonal * scale * basis
        image -= length / before * older

        older, basis = basis, image
        conditioned = precondition(basis)
        before = np.where(length > 0, length, 1.0)
        length = np.sqrt(np.maximum(_products(conditioned, basis), 0.0))
        yield _Step(unit, diagonal, before, length)


def _inverse(values: np.ndarray) -> np.ndarray:
    """One over values above 0, 0 for others."""
    return np.where(values > 0, 1 / np.where(values > 0, values, 1.0), 0.0)


def _products(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Inner products (loads,) of columns."""
    return np.einsum("nl,nl->l", first, second)
