"""The B-spline faces of a yarn's solid as height fields over the fabric's plane.

A face is the surface S(u, v) of poles in homogeneous coordinates. Seen from above it lies over a
rectangle parallel to x and y: u runs along one of the axes, linearly, and v along the other::

    across                    u: along the yarn, plan axis ``along`` (0: x, 1: y)
      |   v = 1 +---------+   v: across it, linear but for arcs, where the place across is a
      |         |         |      quotient of splines and v is found by bisection
      |   v = 0 +---------+
      +------ u = 0 --- u = 1 --- along
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_BSplineSurface

from ..support.errors import BuildError

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

PLAN = 1e-9
"""How far a face may be from a height field over a rectangle, mm."""

_BISECTIONS = 60
"""After as many halvings an interval has the width of a rounding error."""

Rectangle = tuple[float, float, float, float]
"""x from, x to, y from, y to, mm."""


@dataclass(frozen=True, eq=False)
class Face:
    """A B-spline face: knots and degrees along its parameters u, v; homogeneous poles (u, v, 4).

    u runs along the axis ``along`` (0: x, 1: y) of the plan, v across it.
    """

    knots: tuple[np.ndarray, np.ndarray]
    degrees: tuple[int, int]
    poles: np.ndarray
    along: int

    @property
    def corners(self) -> np.ndarray:
        """The poles as points (u, v, 3), mm."""
        return self.poles[..., :3] / self.poles[..., 3:]

    @property
    def rectangle(self) -> Rectangle:
        """Plan rectangle of its poles, which holds the face."""
        plan = self.corners[..., :2]
        low, high = plan.min(axis=(0, 1)), plan.max(axis=(0, 1))
        return low[0], high[0], low[1], high[1]

    def evaluate(
        self,
        u: np.ndarray,
        v: np.ndarray,
        orders: tuple[int, int] = (0, 0),
    ) -> np.ndarray:
        """Homogeneous points on the grid u x v, (u, v, 4), or their derivatives of some orders."""
        rows = _spline(self.knots[0], self.poles, self.degrees[0])(u, orders[0])
        columns = _spline(self.knots[1], rows.transpose(1, 0, 2), self.degrees[1])(v, orders[1])
        return columns.transpose(1, 0, 2)

    def heights(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Height z (mm) on the grid x x y (mm), and area of surface per area in plan there.

        Each of shape (x, y). The area is |n| / |n_z|, where the normal n is dS/du x dS/dv; it is
        infinite where the face stands upright, at the edge of a round section. Raises BuildError
        where the face is no height field over its rectangle.
        """
        along, across = (x, y) if self.along == 0 else (y, x)
        u, v = self._along_parameters(along), self._across_parameters(across)
        homogeneous = self.evaluate(u, v)
        points = homogeneous[..., :3] / homogeneous[..., 3:]
        self._check_plan(points, along, across)

        # S = P / w, hence dS = (dP - S dw) / w
        tangents = []
        for orders in ((1, 0), (0, 1)):
            rate = self.evaluate(u, v, orders)
            tangents.append((rate[..., :3] - points * rate[..., 3:]) / homogeneous[..., 3:])

        normal = np.cross(*tangents)
        with np.errstate(divide="ignore"):
            stretch = np.linalg.norm(normal, axis=-1) / np.abs(normal[..., 2])

        z = points[..., 2]
        return (z, stretch) if self.along == 0 else (z.T, stretch.T)

    def knot_lines(self, axis: int) -> list[float]:
        """Plan coordinates along an axis (0: x, 1: y) at which the face has knots, mm."""
        parameter = 0 if axis == self.along else 1
        row = self.poles[:, 0] if parameter == 0 else self.poles[0]
        curve = self._curve(parameter, row[:, [axis, 3]])
        return _quotient(curve(np.unique(self.knots[parameter]))).tolist()

    def _along_parameters(self, along: np.ndarray) -> np.ndarray:
        """Parameters u of places along, mm: the one is linear in the other."""
        knots, places = self.knots[0], self.corners[..., self.along]
        start, end = places[0, 0], places[-1, 0]
        return knots[0] + (along - start) / (end - start) * (knots[-1] - knots[0])

    def _across_parameters(self, across: np.ndarray) -> np.ndarray:
        """Parameters v of places across, mm: linear in them, or else found by bisection."""
        curve = self._curve(1, self.poles[0][:, [1 - self.along, 3]])
        low, high = (np.full(len(across), self.knots[1][end]) for end in (0, -1))
        start, end = curve(low)[:, 0], curve(high)[:, 0]  # of a polynomial: its weights are 1

        linear = low + (across - start) / (end - start) * (high - low)
        if np.max(np.abs(_quotient(curve(linear)) - across)) <= PLAN:
            return linear

        for _ in range(_BISECTIONS):
            middle = (low + high) / 2
            beyond = _quotient(curve(middle)) > across
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return (low + high) / 2

    def _curve(self, parameter: int, poles: np.ndarray) -> BSpline:
        return _spline(self.knots[parameter], poles, self.degrees[parameter])

    def _check_plan(self, points: np.ndarray, along: np.ndarray, across: np.ndarray) -> None:
        """Raise BuildError unless points (along, across, 3) lie where they were asked for."""
        off_along = np.abs(points[..., self.along] - along[:, None])
        off_across = np.abs(points[..., 1 - self.along] - across[None, :])
        if max(off_along.max(), off_across.max()) > 10 * PLAN:
            raise BuildError("a yarn's face is no height field over the fabric's plane")


def faces_of(solid: cq.Solid) -> tuple[Face, ...]:
    """Top and bottom faces of a yarn; its vertical sides and planar ends are left out."""
    faces = []
    for face in solid.Faces():
        surface = BRep_Tool.Surface_s(face.wrapped)
        if isinstance(surface, Geom_BSplineSurface):
            poles = _poles(surface)
            is_upright = np.ptp(poles[..., 0]) < PLAN or np.ptp(poles[..., 1]) < PLAN
            if not is_upright:
                faces.append(_face(surface, poles))

    return tuple(faces)


def _face(surface: Geom_BSplineSurface, points: np.ndarray) -> Face:
    """The face of a surface with poles (u, v, 4): x, y, z (mm) and weight."""
    along = int(np.ptp(points[:, 0, 1]) > np.ptp(points[:, 0, 0]))
    homogeneous = points.copy()
    homogeneous[..., :3] *= points[..., 3:]
    u_knots = _knots(surface.NbUKnots(), surface.UKnot, surface.UMultiplicity)
    v_knots = _knots(surface.NbVKnots(), surface.VKnot, surface.VMultiplicity)
    return Face((u_knots, v_knots), (surface.UDegree(), surface.VDegree()), homogeneous, along)


def _poles(surface: Geom_BSplineSurface) -> np.ndarray:
    """Poles (u, v, 4) as OCCT has them: x, y, z (mm) and weight."""
    rows, columns = range(1, surface.NbUPoles() + 1), range(1, surface.NbVPoles() + 1)
    poles = [[surface.Pole(i, j).Coord() for j in columns] for i in rows]
    weights = [[[surface.Weight(i, j)] for j in columns] for i in rows]
    return np.concatenate([poles, weights], axis=2)


def _knots(count: int, knot: Callable[[int], float], times: Callable[[int], int]) -> np.ndarray:
    """Knots, each as often as it stands."""
    numbers = range(1, count + 1)
    return np.repeat([knot(number) for number in numbers], [times(number) for number in numbers])


def _quotient(points: np.ndarray) -> np.ndarray:
    """Places of homogeneous points (points, 2) on a line."""
    return points[:, 0] / points[:, 1]


def _spline(knots: np.ndarray, poles: np.ndarray, degree: int) -> BSpline:
    # not imported above: the masters import this door, and CQ-editor unloads what they import
    from scipy.interpolate import BSpline

    return BSpline(knots, poles, degree)
