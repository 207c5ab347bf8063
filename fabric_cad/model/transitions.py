"""Transitions of a yarn from one float to the next: where they lie along it. (A.1)-(A.12)

Seen along a weft, from the middle of its low float (Fig. 16), lengths in projection::

                                               .----  high plateau
                                            .-'
                                          /
          low plateau                   /     slope s
                 ----.___________..--'
                     | u_low |  gap | u_high |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..measured.family import Family
from ..weave.directions import DIRECTIONS, Direction
from .lengths import excess_length, slope_from_crimp
from .measured_values import Measured


@dataclass(frozen=True, eq=False)
class Transitions:
    """Geometry of one direction's transitions; arrays of shape (rows,), mm.

    ``spacing`` is that of the yarns it crosses, ``projected`` the yarn length in projection per
    transition; ``low_float`` and ``high_float`` are mean lengths in crossed yarns.
    """

    spacing: np.ndarray
    projected: np.ndarray
    low_float: np.ndarray
    high_float: np.ndarray
    u_low: np.ndarray
    u_high: np.ndarray
    gap: np.ndarray

    def slope(self, crimp: np.ndarray) -> np.ndarray:
        """The slope that gives the yarn a crimp. (A.11), (A.12)"""
        return slope_from_crimp(crimp, self.projected, self.u_low + self.u_high, self.gap)

    def crimp(self, slope: np.ndarray) -> np.ndarray:
        """The crimp of a yarn with a slope. (A.11)-(A.24)"""
        return excess_length(slope, self.u_low + self.u_high, self.gap) / self.projected

    @property
    def rise(self) -> np.ndarray:
        """Amplitude per unit of slope, A = s rise. (A.27)-(A.29)"""
        return self.u_low / 2 + self.gap + self.u_high / 2


def transitions(table: Family, measured: Measured) -> dict[Direction, Transitions]:
    """Those of both directions."""
    floats = _mean_floats(table)
    return {
        direction: _of_direction(measured, direction, *floats[direction])
        for direction in DIRECTIONS
    }


def _of_direction(
    measured: Measured, direction: Direction, low_float: np.ndarray, high_float: np.ndarray
) -> Transitions:
    crossed = direction.other
    spacing = 1 / measured.density[crossed]

    # on its low plateau a yarn touches the bottom of the one it crosses, which is high there
    half_low, half_high = (measured.half_chord(crossed, plateau) for plateau in ("high", "low"))
    return Transitions(
        spacing=spacing,
        projected=(low_float + high_float) / 2 * spacing,  # (A.9), (A.10)
        low_float=low_float,
        high_float=high_float,
        u_low=half_low - measured.offset[crossed, "high"],
        u_high=half_high - measured.offset[crossed, "low"],
        gap=spacing - half_low - half_high,
    )


def _mean_floats(table: Family) -> Mapping[Direction, np.ndarray]:
    """Mean lengths of a direction's low and high floats, each of shape (2, rows), in crossed yarns."""
    weaves = {id(weave): weave for weave in table.weaves}  # many rows share one
    known = {
        key: [weave.floats(direction) for direction in DIRECTIONS] for key, weave in weaves.items()
    }

    floats = np.array([known[id(weave)] for weave in table.weaves], dtype=float).reshape(-1, 2, 2)
    return {direction: floats[:, direction.axis].T for direction in DIRECTIONS}
