"""What iterative solvers of linear equations share, whatever their method."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .errors import SolverError

Operator = Callable[[np.ndarray], np.ndarray]
"""A matrix, or an approximate inverse of one, as a function of vectors (unknowns, loads)."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Unknowns (unknowns, loads), the largest relative residual of a load, and the iterations it took."""

    values: np.ndarray
    residual: float
    iterations: int


def not_solved(what: str, iterations: int, reached: float, tolerance: float) -> SolverError:
    """The error of a solver that stopped short; ``what`` says what was not solved."""
    residual = f"the residual is {reached:.3g} of the load, above {tolerance:g}"
    return SolverError(
        f"{what} not solved: after {iterations} iterations {residual}; nothing is written"
    )
