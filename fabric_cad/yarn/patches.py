"""A face of a yarn as splines, and which of its faces a place lies under.

Of pointed and flat sections a patch's parameter along is the place along the yarn; where two round
sections with different arcs blend, it is not quite, since a rational spline's weights pull it, and
is solved for.
"""

from __future__ import annotations

import numpy as np

from .skin import Patch
from .swept import SweptYarn


def segments_of(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Between which control planes, by the number of the first, each place is."""
    bounds = np.array([plane.place for plane in swept.planes])
    return np.clip(np.searchsorted(bounds, places, side="right") - 1, 0, len(bounds) - 2)


def level_of(patch: Patch) -> int:
    """1 where a patch is above the section's area, -1 where below it, 0 where upright."""
    if patch.side in ("left", "right"):
        return 0

    return 1 if patch.side == "top" or patch.side.endswith("_upper") else -1


def is_polynomial(patch: Patch) -> bool:
    """True where all weights are 1: no arc."""
    return bool((patch.poles[..., 3] == 1.0).all())


def spline_along(patch: Patch):
    """Homogeneous poles over the parameter along."""
    from scipy.interpolate import BSpline

    knots, degree = patch.along
    return BSpline(knots, patch.homogeneous, degree)


def basis_across(patch: Patch):
    """Basis functions over the parameter across, as a spline whose values are (..., poles)."""
    from scipy.interpolate import BSpline

    knots, degree = patch.across
    return BSpline(knots, np.eye(patch.poles.shape[1]), degree)
