"""Heights of a yarn's lower and upper face over a plan, in closed form."""

from __future__ import annotations

import numpy as np

from .patches import basis_across, is_polynomial, level_of, segments_of, spline_along
from .skin import Patch
from .swept import SweptYarn

_TURNS = 8


def heights(
    swept: SweptYarn, places: np.ndarray, across: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper face of a yarn, z (places, across), mm, over a grid in plan; NaN beside the yarn.

    ``places`` are along the yarn, ``across`` from its axis, mm.
    """
    places, across = np.asarray(places, dtype=float), np.asarray(across, dtype=float)
    faces = {side: np.full((len(places), len(across)), np.nan) for side in (-1, 1)}
    segments = segments_of(swept, places)

    for patch in swept.skin.patches:
        within = np.flatnonzero(segments == patch.segment)
        if (side := level_of(patch)) and len(within):
            z = _heights(patch, places[within], across)
            there = ~np.isnan(z)
            faces[side][within] = np.where(there, z, faces[side][within])

    return faces[-1], faces[1]


def _heights(patch: Patch, places: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Heights (places, across) of a patch, NaN where it does not reach."""
    rows = spline_along(patch)(places)
    ends = rows[:, [0, -1], 1]  # an arc's weights are 1 at its ends too
    first, last = ends[:, :1], ends[:, 1:]
    plane, column = np.nonzero((across >= first) & (across <= last))
    heights = np.full((len(places), len(across)), np.nan)
    if not len(plane):
        return heights

    if not is_polynomial(patch):
        heights[plane, column] = _height_of_arc(patch, places[plane], across[column])
        return heights

    poles = rows[..., 2]  # all weights are 1, so that v is linear in the share across
    if (patch.poles[..., 1] == patch.poles[:1, :, 1]).all():
        columns = np.unique(column)
        basis = basis_across(patch)((across[columns] - ends[0, 0]) / (ends[0, 1] - ends[0, 0]))
        heights[:, columns] = poles @ basis.T
    else:
        basis = basis_across(patch)(
            (across[column] - ends[plane, 0]) / (ends[plane, 1] - ends[plane, 0])
        )
        heights[plane, column] = np.einsum("na,na->n", poles[plane], basis)

    return heights


def _height_of_arc(patch: Patch, places: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Heights (points,) of an arc at ``places`` and ``across`` (points,).

    In a plane of its parameter along it is a conic, whose share across is the root of a quadratic
    equation; by how much the place differs from that parameter depends on the share, hardly, so
    that both are found by turns.
    """
    along, across_basis = spline_along(patch), basis_across(patch)
    rate = along.derivative()
    parameter = places.copy()

    for _ in range(_TURNS):
        poles = along(parameter)
        shares = _root_of_conic(poles[..., 1] - across[:, None] * poles[..., 3])
        basis = across_basis(shares)
        value, slope = (np.einsum("nac,na->nc", each, basis) for each in (poles, rate(parameter)))
        place = value[:, 0] / value[:, 3]
        pace = (slope[:, 0] - place * slope[:, 3]) / value[:, 3]
        parameter = np.clip(parameter - (place - places) / pace, along.t[0], along.t[-1])

    return value[:, 2] / value[:, 3]


def _root_of_conic(coefficients: np.ndarray) -> np.ndarray:
    """Where (points,) from 0 to 1 a quadratic of Bernstein ``coefficients`` (points, 3) comes up to zero."""
    first, middle, last = coefficients.T
    rise = middle - first
    root = np.sqrt(np.maximum(rise**2 - first * (first - 2 * middle + last), 0.0))
    return np.clip(
        np.divide(-first, rise + root, out=np.zeros_like(first), where=rise + root > 0), 0.0, 1.0
    )
