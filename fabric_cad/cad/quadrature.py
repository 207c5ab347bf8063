"""Points and weights at which two yarns are compared over a crossing, along one axis of the plan.

Between two knot lines the heights of polynomial faces are polynomials, of degree 3 along a yarn and
2 across it. Gauss's and Lobatto's rule with five points a cell is exact to degree 7 and has both
ends of the cell among its points, where heights of neighbouring faces meet::

    -1      -sqrt(3/7)       0       sqrt(3/7)      1        a cell
     *----------*------------*-----------*----------*
    1/10      49/90        32/45       49/90      1/10       weights, of a cell of length 2
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from .faces import PLAN

_NODES = (np.array([-1.0, -np.sqrt(3 / 7), 0.0, np.sqrt(3 / 7), 1.0]) + 1) / 2
_WEIGHTS = np.array([1 / 20, 49 / 180, 16 / 45, 49 / 180, 1 / 20])
"""Of a cell from 0 to 1."""


@dataclass(frozen=True, eq=False)
class PointsAlong:
    """Quadrature points along one axis, cell by cell: ``points`` and ``weights`` (points,), mm.

    ``cells`` (points, 2) are the ends of the cell in which each point lies.
    """

    points: np.ndarray
    weights: np.ndarray
    cells: np.ndarray

    @classmethod
    def between(cls, low: float, high: float, lines: Iterable[float]) -> PointsAlong:
        """Five points in every cell between two places, which ``lines`` part into cells; mm."""
        places = [low]
        for place in sorted(lines):
            if places[-1] + PLAN < place < high - PLAN:
                places.append(place)
        places.append(high)

        starts, lengths = np.array(places[:-1])[:, None], np.diff(places)[:, None]
        cells = np.column_stack([places[:-1], places[1:]])
        return cls(
            points=(starts + lengths * _NODES).ravel(),
            weights=(lengths * _WEIGHTS).ravel(),
            cells=np.repeat(cells, len(_NODES), axis=0),
        )

    def within(self, low: float, high: float) -> np.ndarray:
        """True (points,) for those of the cells that lie between two places, mm."""
        return (self.cells[:, 0] >= low - PLAN) & (self.cells[:, 1] <= high + PLAN)
