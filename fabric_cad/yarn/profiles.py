"""A yarn cut by planes across it, anywhere along it: its outline's strips, and its area, in closed form.

A patch of the skin is z and v over two parameters. Of pointed and flat sections the parameter along is the
place along the yarn; where two round sections with different arcs blend, it is not quite, since a rational
spline's weights pull it, and it is solved for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..section.splines import Spline
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
    along, across = _spline(patch), _across(patch, shares)
    parameter = np.repeat(np.asarray(places, dtype=float)[:, None], len(shares), axis=1)
    if not _polynomial(patch):
        parameter = _solved(along, across[0], parameter)

    point, onwards, sideways = _evaluated(along, across, parameter)
    turn = -sideways[..., 0] / onwards[..., 0]  # of the parameter along, for the place to stay
    rate = sideways[..., 1] + onwards[..., 1] * turn
    return Profile(point[..., 1], point[..., 2], rate)


def section_areas(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Area (places,), mm2, of a yarn's section in the vertical planes across it at ``places`` (mm along it)."""
    places = np.asarray(places, dtype=float)
    bounds = np.array([plane.place for plane in swept.planes])
    segments = np.clip(np.searchsorted(bounds, places, side="right") - 1, 0, len(bounds) - 2)
    areas = np.zeros(len(places))
    for patch in swept.skin.patches:
        sign = _side(patch)
        within = np.flatnonzero(segments == patch.segment)
        if sign and len(within):
            shares, weights = _gauss(patch)
            profile = cut(patch, places[within], shares)
            areas[within] += sign * (profile.z * profile.rate) @ weights

    return areas


def slopes(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Slope dz/dt (places,) of a yarn's trajectory at ``places`` (mm along it)."""
    places = np.asarray(places, dtype=float)
    bounds = np.array([plane.place for plane in swept.planes])
    segments = np.clip(np.searchsorted(bounds, places, side="right") - 1, 0, len(bounds) - 2)
    found = np.empty(len(places))
    for number in np.unique(segments):
        within = segments == number
        found[within] = _derivative(swept.trajectory.pieces[number], places[within])

    return found


def _derivative(piece: Spline, places: np.ndarray) -> np.ndarray:
    from scipy.interpolate import BSpline

    return BSpline(piece.knots, piece.poles, piece.degree).derivative()(places)


def _side(patch: Patch) -> int:
    """1 where a patch is above the section's area, -1 where below it, 0 where upright."""
    if patch.side in ("left", "right"):
        return 0

    return 1 if patch.side == "top" or patch.side.endswith("_upper") else -1


def _polynomial(patch: Patch) -> bool:
    return bool((patch.poles[..., 3] == 1.0).all())


def _gauss(patch: Patch) -> tuple[np.ndarray, np.ndarray]:
    """Shares across a patch, span by span, and their weights."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS[_polynomial(patch)])
    knots = np.unique(patch.across[0])
    spans = np.diff(knots)[:, None]
    shares = knots[:-1, None] + spans * (points + 1) / 2
    return shares.ravel(), (spans * weights / 2).ravel()


def _spline(patch: Patch):
    """Homogeneous poles over the parameter along."""
    from scipy.interpolate import BSpline

    knots, degree = patch.along
    return BSpline(knots, patch.homogeneous, degree)


def _across(patch: Patch, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Basis functions over the parameter across, and their derivatives, each (shares, poles)."""
    from scipy.interpolate import BSpline

    knots, degree = patch.across
    basis = BSpline(knots, np.eye(patch.poles.shape[1]), degree)
    return basis(shares), basis.derivative()(shares)


def _evaluated(along, across, parameter) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (t, v, z) and their derivatives along and across, each (planes, shares, 3)."""
    rows, rates = along(parameter), along.derivative()(parameter)  # planes, shares, poles, 4
    basis, slopes_of_basis = across
    value = np.einsum("psac,sa->psc", rows, basis)
    onwards = np.einsum("psac,sa->psc", rates, basis)
    sideways = np.einsum("psac,sa->psc", rows, slopes_of_basis)

    weight, point = value[..., 3:], value[..., :3] / value[..., 3:]
    return point, *((each[..., :3] - point * each[..., 3:]) / weight for each in (onwards, sideways))


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
