"""Sections of the models criticised: half their height at a distance ``v`` across from the axis."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..model.solved import SolvedDirection
from ..support.errors import BuildError

HalfHeight = Callable[[np.ndarray, SolvedDirection], np.ndarray]


def elliptic(v: np.ndarray, solved: SolvedDirection) -> np.ndarray:
    """b/2 sqrt(1 - (2 v / c)^2), mm."""
    return solved.thickness / 2 * np.sqrt(np.maximum(1 - (2 * v / solved.width) ** 2, 0.0))


def lenticular(v: np.ndarray, solved: SolvedDirection) -> np.ndarray:
    """b/2 - R + sqrt(R^2 - v^2), mm."""
    radius = lens_radius(solved)
    return solved.thickness / 2 - (radius - np.sqrt(np.maximum(radius**2 - v**2, 0.0)))


def lens_radius(solved: SolvedDirection) -> float:
    """Radius R (mm) of the two arcs of a lens, c wide and b thick. Raises :class:`BuildError`."""
    b, c = solved.thickness, solved.width
    if b > c:
        size = f"{b:.4g} mm thick and {c:.4g} mm wide"
        raise BuildError(f"no lens is {size}: its arcs would exceed half circles")
    return (b**2 + c**2) / (4 * b)
