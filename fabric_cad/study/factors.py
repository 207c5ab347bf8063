"""What varies in a study: values, a range or a distribution of one column of the base row."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch

import numpy as np


@dataclass(frozen=True)
class Values:
    """Given values: numbers, or texts (``section``, ``thicker``, ``pattern``)."""

    values: tuple


@dataclass(frozen=True)
class Uniform:
    """Uniform between two numbers.

    ``steps`` evenly spaced ones of them where a design takes levels.
    """

    low: float
    high: float
    steps: int | None = None


@dataclass(frozen=True)
class Normal:
    """Normal with a mean and a standard deviation."""

    mean: float
    std: float


Factor = Values | Uniform | Normal


@singledispatch
def quantiles(factor: Factor, shares: np.ndarray) -> np.ndarray:
    """The factor's values, shape (n,), at ``shares`` (n,) between 0 and 1 of its distribution.

    Every one of given values is as likely as the others.
    """
    raise TypeError(factor)


@quantiles.register
def _(factor: Values, shares: np.ndarray) -> np.ndarray:
    return np.array(factor.values)[
        np.minimum((shares * len(factor.values)).astype(int), len(factor.values) - 1)
    ]


@quantiles.register
def _(factor: Uniform, shares: np.ndarray) -> np.ndarray:
    return factor.low + shares * (factor.high - factor.low)


@quantiles.register
def _(factor: Normal, shares: np.ndarray) -> np.ndarray:
    from scipy.special import ndtri

    # a Sobol sequence may hold 0
    inside = np.clip(shares, np.finfo(float).tiny, 1 - np.finfo(float).epsneg)
    return factor.mean + factor.std * ndtri(inside)


@singledispatch
def levels(factor: Factor) -> np.ndarray:
    """The few values of a factor that a grid combines and one-at-a-time visits."""
    raise TypeError(factor)


@levels.register
def _(factor: Values) -> np.ndarray:
    return np.array(factor.values)


@levels.register
def _(factor: Uniform) -> np.ndarray:
    return np.linspace(factor.low, factor.high, factor.steps or 2)


@levels.register
def _(factor: Normal) -> np.ndarray:
    """One standard deviation to either side."""
    return np.array([factor.mean - factor.std, factor.mean + factor.std])
