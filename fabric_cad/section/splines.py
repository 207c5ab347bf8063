"""Quadratic splines in closed form: poles are the polynomial's own polar values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Quadratic:
    """The polynomial z0 + slope (x - x0) + p (x - x0)^2."""

    x0: float
    z0: float
    slope: float = 0.0
    p: float = 0.0

    def polar(self, s: float, t: float) -> float:
        """The polar form: symmetric, affine in s and t, and the polynomial itself for s = t."""
        s, t = s - self.x0, t - self.x0
        return self.z0 + self.slope * (s + t) / 2 + self.p * s * t


@dataclass(frozen=True, eq=False)
class Spline:
    """A polynomial spline: ``knots`` with multiplicities, ``poles`` (n,), ``degree``."""

    knots: np.ndarray
    poles: np.ndarray
    degree: int

    @property
    def abscissae(self) -> np.ndarray:
        """Greville abscissae: the poles of the parameter itself over the same knots."""
        return greville(self.knots, self.degree)


def greville(knots: np.ndarray, degree: int) -> np.ndarray:
    """Means of ``degree`` consecutive inner knots: the poles of the identity."""
    return np.lib.stride_tricks.sliding_window_view(knots[1:-1], degree).mean(axis=1)


def quadratic_knots(breaks: Sequence[float]) -> np.ndarray:
    """Knots of a once differentiable quadratic spline over increasing ``breaks``."""
    return np.array([breaks[0]] * 3 + list(breaks[1:-1]) + [breaks[-1]] * 3)


def quadratic_spline(breaks: Sequence[float], pieces: Sequence[Quadratic]) -> Spline:
    """The spline that is ``pieces[k]`` between ``breaks[k]`` and ``breaks[k + 1]``.

    The pieces must join with a common tangent; one piece given stands for all.
    """
    if len(pieces) == 1:
        pieces = list(pieces) * (len(breaks) - 1)
    poles = [pieces[0].polar(breaks[0], breaks[0])]
    poles += [piece.polar(*ends) for piece, ends in zip(pieces, zip(breaks, breaks[1:]))]
    poles += [pieces[-1].polar(breaks[-1], breaks[-1])]
    return Spline(quadratic_knots(breaks), np.array(poles), 2)


def line(start: float, end: float, z_start: float, z_end: float) -> Spline:
    """A straight piece."""
    return Spline(np.array([start, start, end, end]), np.array([z_start, z_end]), 1)


def as_cubic(straight: Spline) -> Spline:
    """The same straight piece as a cubic without inner knots."""
    (start, *_, end), (z_start, z_end) = straight.knots, straight.poles
    share = np.array([0, 1 / 3, 2 / 3, 1.0])
    return Spline(np.array([start] * 4 + [end] * 4), z_start + (z_end - z_start) * share, 3)
