"""A yarn cut by planes across it, anywhere along it: the outline's strips, the section's area, the slope."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..section.splines import Spline
from .patches import basis_across, is_polynomial, level_of, segments_of, spline_along
from .skin import Patch
from .swept import SweptYarn

_NEWTON = 6
_GAUSS = {True: 4, False: 16}  # points a span: exact of polynomials, to rounding of arcs


@dataclass(frozen=True, eq=False)
class Profile:
    """A patch cut by planes: ``v`` and ``z`` (planes, shares), mm, and ``rate``, dv over the share across."""

    v: np.ndarray
    z: np.ndarray
    rate: np.ndarray


def cut(patch: Patch, places: np.ndarray, shares: np.ndarray) -> Profile:
    """A patch in the planes at ``places`` (planes,), mm along the yarn, at ``shares`` (shares,) across, 0 to 1.

    The places lie between the patch's control planes.
    """
    along, basis = spline_along(patch), basis_across(patch)
    across = basis(shares), basis.derivative()(shares)
    parameter = np.repeat(np.asarray(places, dtype=float)[:, None], len(shares), axis=1)
    if not is_polynomial(patch):
        parameter = _solved(along, across[0], parameter)

    point, onwards, sideways = _evaluated(along, across, parameter)
    turn = -sideways[..., 0] / onwards[..., 0]  # of the parameter along, for the place to stay
    rate = sideways[..., 1] + onwards[..., 1] * turn
    return Profile(point[..., 1], point[..., 2], rate)


def section_areas(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Area (places,), mm2, of a yarn's section in the vertical planes across it at ``places`` (mm along it)."""
    places = np.asarray(places, dtype=float)
    segments = segments_of(swept, places)
    areas = np.zeros(len(places))
    for patch in swept.skin.patches:
        sign = level_of(patch)
        within = np.flatnonzero(segments == patch.segment)
        if sign and len(within):
            shares, weights = _gauss(patch)
            profile = cut(patch, places[within], shares)
            areas[within] += sign * (profile.z * profile.rate) @ weights

    return areas


def slopes(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Slope dz/dt (places,) of a yarn's trajectory at ``places`` (mm along it)."""
    places = np.asarray(places, dtype=float)
    segments = segments_of(swept, places)
    found = np.empty(len(places))
    for number in np.unique(segments):
        within = segments == number
        found[within] = _derivative(swept.trajectory.pieces[number], places[within])

    return found


def _derivative(piece: Spline, places: np.ndarray) -> np.ndarray:
    from scipy.interpolate import BSpline

    return BSpline(piece.knots, piece.poles, piece.degree).derivative()(places)


def _gauss(patch: Patch) -> tuple[np.ndarray, np.ndarray]:
    """Shares across a patch, span by span, and their weights."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS[is_polynomial(patch)])
    knots = np.unique(patch.across[0])
    spans = np.diff(knots)[:, None]
    shares = knots[:-1, None] + spans * (points + 1) / 2
    return shares.ravel(), (spans * weights / 2).ravel()


def _evaluated(along, across, parameter) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (t, v, z) and their derivatives along and across, each (planes, shares, 3)."""
    rows, rates = along(parameter), along.derivative()(parameter)  # planes, shares, poles, 4
    basis, slopes_of_basis = across
    value = np.einsum("psac,sa->psc", rows, basis)
    onwards = np.einsum("psac,sa->psc", rates, basis)
    sideways = np.einsum("psac,sa->psc", rows, slopes_of_basis)

    weight, point = value[..., 3:], value[..., :3] / value[..., 3:]
    return point, *(
        (each[..., :3] - point * each[..., 3:]) / weight for each in (onwards, sideways)
    )


def _solved(along, basis: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Parameters along (planes, shares) at which a rational patch is at ``places``, by Newton's method."""
    rate = along.derivative()
    first, last = along.t[0], along.t[-1]
    parameter = places.copy()
    for _ in range(_NEWTON):
        value = np.einsum("psac,sa->psc", along(parameter), basis)
        slope = np.einsum("psac,sa->psc", rate(parameter), basis)
        place = value[..., 0] / value[..., 3]
        pace = (slope[..., 0] - place * slope[..., 3]) / value[..., 3]
        parameter = np.clip(parameter - (place - places) / pace, first, last)

    return parameter
