"""Trajectories of the models criticised: how far a midline has fallen from its plateau.

Each takes the distance ``u`` (0 to a/2) along the yarn from the centre of a crossing, beyond which
the yarn changes sides, and gives the fall, of u's shape; mm.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..model.solved import SolvedDirection
from ..support.errors import BuildError
from .profiles import lens_radius

Fall = Callable[[np.ndarray, SolvedDirection, SolvedDirection], np.ndarray]


def sinusoidal(u: np.ndarray, solved: SolvedDirection, crossed: SolvedDirection) -> np.ndarray:
    """A/2 (1 - cos(pi u / a)), mm."""
    return solved.amplitude / 2 * (1 - np.cos(np.pi * u / solved.crossed_spacing))


def circular(u: np.ndarray, solved: SolvedDirection, crossed: SolvedDirection) -> np.ndarray:
    """Arc, then its tangent to the mid-gap plane, mm. Raises :class:`BuildError`.

    The arc has the radius R of the crossed yarn's lens, so a lens is touched all along it.
    The segment is the inner common tangent of two circles whose centres are a apart along
    the yarn and A - 2 R across it; where 2 R > a, these leave room for a rise up to that of
    two arcs alone.
    """
    a, rise, radius = solved.crossed_spacing, solved.amplitude, lens_radius(crossed)
    room = 2 * radius - np.sqrt(max(4 * radius**2 - a**2, 0.0))
    if 2 * radius > a and rise > room:
        raise BuildError(
            f"a circular trajectory cannot rise by {rise:.4g} mm over a spacing of {a:.4g} mm: "
            f"its arcs, of the radius {radius:.4g} mm of the crossed yarn's lens, "
            f"have room for {room:.4g} mm"
        )

    centres = rise - 2 * radius
    angle = np.arctan2(centres, a) + np.arcsin(2 * radius / np.hypot(a, centres))
    end = radius * np.sin(angle)  # of the arc, where the tangent begins

    on_arc = radius - np.sqrt(radius**2 - np.minimum(u, end) ** 2)
    return on_arc + np.tan(angle) * np.maximum(u - end, 0.0)


def straight_bars(u: np.ndarray, solved: SolvedDirection, crossed: SolvedDirection) -> np.ndarray:
    """A u / a, mm."""
    return solved.amplitude * u / solved.crossed_spacing
