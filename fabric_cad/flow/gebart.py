"""Permeability of aligned fibres, for any number of fibre fractions at once.

B. R. Gebart, *Permeability of unidirectional reinforcements for RTM*, Journal of Composite
Materials 26 (1992) 1100-1133, hexagonal packing: with R the fibres' radius and V their fraction, at
most V0 = pi / (2 sqrt 3),

    along K = 8 R^2 / 53 (1 - V)^3 / V^2,     across K = 16 R^2 / (9 pi sqrt 6) (sqrt(V0 / V) -
    1)^(5/2).
"""

from __future__ import annotations

import numpy as np

from ..composite.transverse import second_order

_MOST = np.pi / (2 * np.sqrt(3))


def along(radius: float, fraction: np.ndarray) -> np.ndarray:
    """Along the fibres, mm2, of fibres of ``radius`` mm."""
    return 8 * radius**2 / 53 * (1 - fraction) ** 3 / fraction**2


def across(radius: float, fraction: np.ndarray) -> np.ndarray:
    """Across the fibres, mm2; 0 where they touch."""
    return 16 * radius**2 / (9 * np.pi * np.sqrt(6)) * (np.sqrt(_MOST / fraction) - 1) ** 2.5


def resistance(radius: float, fraction: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """The inverse of the permeability (yarns' elements, 3, 3), 1/mm2, of fibres along unit vectors ``axes``."""
    return second_order(1 / along(radius, fraction), 1 / across(radius, fraction), axes)
