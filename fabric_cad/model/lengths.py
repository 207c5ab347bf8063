"""The length of a transition and the slope that gives a yarn its crimp.

A transition is half a parabola, a straight segment and half a parabola (paper, Fig. 16),
between two flat plateaux. With the slope ``s`` of the segment as the only unknown, the
length equations (A.13)-(A.24) become

    excess(s) = (u_low + u_high)/2 (asinh(s)/s + sqrt(1 + s^2) - 2) + g (sqrt(1 + s^2) - 1)

the length of the transition beyond its projection; (A.11)/(A.12) ask excess(s) = e P, with
P the projected length of yarn per transition. Written so, a crimp of 1e-5 loses no digit.
"""

from __future__ import annotations

import numpy as np

# asinh(s)/s - 1 = sum over k >= 1 of (-1)^k (2k)! / (4^k (k!)^2 (2k + 1)) s^(2k)
_SERIES_LIMIT = 0.3
_SERIES = [0.0]
_coefficient = 1.0
for _k in range(1, 19):
    _coefficient *= -(2 * _k - 1) / (2 * _k)
    _SERIES.append(_coefficient / (2 * _k + 1))


def _asinh_ratio_minus_one(s: np.ndarray) -> np.ndarray:
    """asinh(s)/s - 1 for s >= 0 without cancellation."""
    small = s < _SERIES_LIMIT
    series = np.polynomial.polynomial.polyval(np.where(small, s, 0.0) ** 2, _SERIES)
    large = np.where(small, 1.0, s)
    return np.where(small, series, np.arcsinh(large) / large - 1.0)


def excess_length(slope, parabola, gap):
    """Length of a transition beyond its projection, same unit as ``parabola`` and ``gap``.

    ``slope`` is dimensionless, ``parabola`` = u_low + u_high the projected extent of both
    half parabolas, ``gap`` that of the straight segment; arrays broadcast. (A.13)-(A.24)
    """
    slope = np.asarray(slope, dtype=float)
    stretch = slope**2 / (1.0 + np.sqrt(1.0 + slope**2))  # sqrt(1 + s^2) - 1
    return parabola / 2 * (_asinh_ratio_minus_one(slope) + stretch) + gap * stretch


def _excess_derivative(slope, parabola, gap):
    """d excess_length / d slope."""
    root = np.sqrt(1.0 + slope**2)
    # d/ds (asinh(s)/s + root) = (root - asinh(s)/s) / s
    arcs = (slope**2 / (1.0 + root) - _asinh_ratio_minus_one(slope)) / slope
    return parabola / 2 * arcs + gap * slope / root


def slope_from_crimp(crimp, projected, parabola, gap):
    """Slope s of the segment for which a transition has the measured crimp. (A.11), (A.12)

    ``projected`` is the projected yarn length per transition (mm), the other lengths are as
    in :func:`excess_length`; arrays of one shape, solved together by Newton's method. The
    excess is convex and increasing, so the iteration cannot leave its root. Entries that
    do not converge (a crimp or length that is no positive number) come back as NaN.
    """
    crimp, projected, parabola, gap = np.broadcast_arrays(
        *(np.asarray(value, dtype=float) for value in (crimp, projected, parabola, gap))
    )
    target = crimp * projected

    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        slope = np.sqrt(2.0 * target / (gap + parabola / 3.0))
        moving = np.ones(slope.shape, dtype=bool)
        for _ in range(60):
            residual = excess_length(slope, parabola, gap) - target
            step = residual / _excess_derivative(slope, parabola, gap)
            # an entry's result is not its neighbours' business
            slope = np.where(moving, slope - step, slope)
            moving &= np.abs(step) > 4e-16 * slope
            if not moving.any():
                break

        residual = excess_length(slope, parabola, gap) - target
        converged = (slope > 0) & (np.abs(residual) <= 1e-12 * target)

    return np.where(converged, slope, np.nan)
