"""The present model's yarns as height fields: the patches that their solids are made of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.weaves import Yarn
from ..yarn.skin import Patch
from ..yarn.swept import SweptYarn

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

_SHEETS = {"bottom": 0, "left_lower": 0, "right_lower": 0}
_SHEETS |= {"top": 1, "left_upper": 1, "right_upper": 1}
"""Whether a side of the section is of a yarn's bottom or its top; upright ones are of neither."""

_BISECTIONS = 60
"""After as many halvings an interval has the width of a rounding error."""


def heights_of_skin(
    fabric: SolvedFabric,
    yarn: Yarn,
    t: np.ndarray,
    v: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Bottom and top of a yarn, each (len(t), len(v)), at ``t`` along and ``v`` across it; mm."""
    sheets = np.full((2, len(t), len(v)), np.nan)
    for patch in SweptYarn(fabric, yarn).skin.patches:
        knots, _ = patch.along
        rows = np.flatnonzero((t >= knots[0]) & (t <= knots[-1]))
        if patch.side in _SHEETS and len(rows):
            _fill(sheets[_SHEETS[patch.side]], patch, (rows, t), v)

    bottom, top = sheets
    return bottom, top


def _fill(
    sheet: np.ndarray,
    patch: Patch,
    along: tuple[np.ndarray, np.ndarray],
    v: np.ndarray,
) -> None:
    """Write a patch's heights into a sheet (t, v), at those rows and places t of it, mm."""
    from scipy.interpolate import BSpline

    rows, t = along
    knots, degree = patch.along
    across, across_degree = patch.across
    poles = BSpline(knots, patch.homogeneous, degree)(t[rows])  # of the section in every row

    one_section = np.ptp(patch.poles[..., [1, 3]], axis=0).max() == 0
    for group in [np.arange(len(rows))] if one_section else np.arange(len(rows))[:, None]:
        curves = BSpline(across, poles[group].transpose(1, 0, 2), across_degree)
        parameters, columns = _across_parameters(curves, v)
        points = curves(parameters)
        sheet[np.ix_(rows[group], columns)] = (points[..., 2] / points[..., 3]).T


def _across_parameters(curves: BSpline, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of a strip at the places v that it covers, and the numbers of those places."""

    def places(parameters: np.ndarray) -> np.ndarray:
        points = curves(parameters)[:, 0]
        return points[:, 1] / points[:, 3]

    start, end = ends = places(np.array([0.0, 1.0]))
    slack = 1e-12 * max(1.0, np.ptp(ends))
    covered = np.flatnonzero((v >= start - slack) & (v <= end + slack))
    wanted = np.clip(v[covered], start, end)

    parameters = (wanted - start) / np.ptp(ends)  # right wherever v is linear in it
    if len(parameters) and np.max(np.abs(places(parameters) - wanted)) > slack:  # an arc: bisect
        low, high = np.zeros(len(wanted)), np.ones(len(wanted))
        for _ in range(_BISECTIONS):
            parameters = (low + high) / 2
            beyond = places(parameters) > wanted
            low, high = np.where(beyond, low, parameters), np.where(beyond, parameters, high)

    return parameters, covered
