"""Conjugate gradients for several loads at once, which share every product with the matrix.

M. R. Hestenes and E. Stiefel, *Methods of conjugate gradients for solving linear systems*, Journal
of Research of the National Bureau of Standards 49 (1952) 409-436, preconditioned. The matrix of a
periodic cell does not see a translation; loads that are in equilibrium have no part in one, nor
have the iterates.
"""

from __future__ import annotations

import numpy as np

from ...support.iterative import Operator, Solution, not_solved

TOLERANCE = 1e-7
"""Residual over load at which a column is solved.

An energy is then right to its square, some 1e-10.
"""

MOST_ITERATIONS = 5000
_LEAST_LOAD = 1e-5  # of what the elements' own forces add up to: what is solved to TOLERANCE of less is rounding


def solve(
    multiply: Operator,
    loads: np.ndarray,
    scale: float,
    precondition: Operator,
    tolerance: float = TOLERANCE,
    most: int = MOST_ITERATIONS,
) -> Solution:
    """Solve K x = ``loads`` (unknowns, loads) to a residual of ``tolerance`` times every column's load.

    ``multiply`` is K as a function, ``precondition`` an approximate inverse of it. ``scale`` is
    what the elements' forces add up to before they cancel; loads that are nothing beside it count
    as rounding. Raises :class:`SolverError` with the residual where ``most`` iterations do not do.
    """
    norms = np.maximum(np.linalg.norm(loads, axis=0), _LEAST_LOAD * scale)
    values, residual = np.zeros_like(loads), loads.copy()
    direction = np.zeros_like(loads)
    before = np.ones(loads.shape[1])

    for iteration in range(most + 1):
        reached = np.sqrt(np.einsum("nc,nc->c", residual, residual)) / norms
        going = reached > tolerance  # a column that is solved stays as it is
        if not going.any():
            return Solution(values, float(reached.max()), iteration)
        if iteration == most or not np.isfinite(reached).all():
            break

        conditioned = precondition(residual)
        product = np.einsum("nc,nc->c", residual, conditioned)
        direction *= np.where(going, product / before, 0.0)
        direction += conditioned

        image = multiply(direction)
        step = np.where(going, product / np.einsum("nc,nc->c", direction, image), 0.0)
        values += step * direction
        residual -= step * image
        before = np.where(going, product, 1.0)

    raise not_solved("the equations were", iteration, reached.max(), tolerance)
