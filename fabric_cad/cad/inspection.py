"""What a cell's solids really do, measured on the B-spline faces of the STEP file.

Seen from above, the faces of a yarn in a crossing are height fields z(x, y) over axis-parallel
rectangles (checked, not assumed). Two yarns can meet only where their rectangles overlap.
Between knot lines the difference of two polynomial faces is a polynomial, and Gauss-Lobatto
points with more nodes than its degree see all of it; round lateral zones are sampled at the
same points.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_BSplineSurface

from ..support.errors import BuildError

TOUCHING = 1e-9
"""Distance (mm) up to which two faces count as in contact."""

Rectangle = tuple[float, float, float, float]
"""x from, x to, y from, y to, mm."""

_PLAN = 1e-9  # mm, how far a face may be from a height field over a rectangle
_VOLUME = 1e-9  # relative; without it OCCT takes fewer points than its own degree needs
# Gauss-Lobatto on [0, 1], five points: exact to degree 7, ends included
_NODES = (np.array([-1.0, -np.sqrt(3 / 7), 0.0, np.sqrt(3 / 7), 1.0]) + 1) / 2
_WEIGHTS = np.array([1 / 20, 49 / 180, 16 / 45, 49 / 180, 1 / 20])


@dataclass(frozen=True)
class Consistency:
    """How a cell's yarns meet; lengths mm, areas mm2, volumes mm3.

    ``max_contact_gap`` is the largest distance between the facing sides of two crossing
    yarns over their contact patch, ``max_penetration`` how deep one enters another anywhere,
    ``overlap_volume`` the integral of that depth over the fabric's plane, ``contact_area`` the
    area in which the distance is at most :data:`TOUCHING`; ``yarn_volumes`` has one entry a yarn.
    """

    max_penetration: float
    max_contact_gap: float
    overlap_volume: float
    contact_area: float
    thickness: float
    yarn_volumes: dict[str, float]


@dataclass(frozen=True, eq=False)
class _Face:
    """A B-spline face: knots and degrees along its parameters u, v and homogeneous poles (u, v, 4).

    u runs along the axis ``along`` (0: x, 1: y) of the plan, v across it.
    """

    knots: tuple[np.ndarray, np.ndarray]
    degrees: tuple[int, int]
    poles: np.ndarray
    along: int

    @property
    def corners(self) -> np.ndarray:
        """The poles as points (u, v, 3)."""
        return self.poles[..., :3] / self.poles[..., 3:]

    @property
    def rectangle(self) -> Rectangle:
        """Plan rectangle of its poles, which holds the face."""
        low, high = self.corners[..., :2].min(axis=(0, 1)), self.corners[..., :2].max(axis=(0, 1))
        return low[0], high[0], low[1], high[1]

    def evaluate(self, u: np.ndarray, v: np.ndarray, along: int = 0, across: int = 0) -> np.ndarray:
        """Homogeneous points, or derivatives of them, on the grid u x v: shape (u, v, 4)."""
        first = _spline(self.knots[0], self.poles, self.degrees[0])(u, along)
        second = _spline(self.knots[1], first.transpose(1, 0, 2), self.degrees[1])(v, across)
        return second.transpose(1, 0, 2)

    def parameters(self, along: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(u, v) of the grid of places along and across, mm. Raises BuildError where the face is no height field."""
        (ku, kv), row = self.knots, self.poles[0]
        places = self.corners[..., self.along]
        start, end = places[0, 0], places[-1, 0]
        u = ku[0] + (along - start) / (end - start) * (ku[-1] - ku[0])
        low, high = np.full(len(across), kv[0]), np.full(len(across), kv[-1])
        curve = _spline(kv, row[:, [1 - self.along, 3]], self.degrees[1])
        v = low + (across - curve(low)[:, 0]) / (curve(high) - curve(low))[:, 0] * (high - low)
        found = curve(v)
        if np.max(np.abs(found[:, 0] / found[:, 1] - across)) > _PLAN:  # not linear: bisect
            for _ in range(60):
                v = (low + high) / 2
                found = curve(v)
                beyond = found[:, 0] / found[:, 1] > across
                low, high = np.where(beyond, low, v), np.where(beyond, v, high)
            v = (low + high) / 2
        return u, v

    def heights(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(z, area of surface per area in plan) on the grid x x y, each of shape (x, y)."""
        along, across = (x, y) if self.along == 0 else (y, x)
        u, v = self.parameters(along, across)
        homogeneous = self.evaluate(u, v)
        points = homogeneous[..., :3] / homogeneous[..., 3:]
        expected = np.broadcast_arrays(along[:, None], across[None, :])
        for axis, places in ((self.along, expected[0]), (1 - self.along, expected[1])):
            if np.max(np.abs(points[..., axis] - places)) > 10 * _PLAN:
                raise BuildError("a yarn's face is no height field over the fabric's plane")
        tangents = []
        for order in ((1, 0), (0, 1)):
            rate = self.evaluate(u, v, *order)
            tangents.append((rate[..., :3] - points * rate[..., 3:]) / homogeneous[..., 3:])
        normal = np.cross(*tangents)
        with np.errstate(divide="ignore"):  # vertical at the edge of a round section
            stretch = np.linalg.norm(normal, axis=-1) / np.abs(normal[..., 2])
        z = points[..., 2]
        return (z, stretch) if self.along == 0 else (z.T, stretch.T)


def inspect_cell(
    solids: Mapping[str, cq.Solid], patches: Mapping[tuple[str, str], Rectangle] | None = None
) -> Consistency:
    """Measure the solids of a cell, as read from its STEP file.

    ``patches`` gives the plan rectangle in which two yarns should touch; without it they
    should wherever they lie over each other. Raises :class:`BuildError` where a yarn is no
    valid solid, or its faces are no height fields in a crossing.
    """
    for name, solid in solids.items():
        if not solid.isValid():
            raise BuildError(f"{name} is not a valid solid")
    faces = {name: _faces(solid) for name, solid in solids.items()}
    hulls = {name: _hull([face.rectangle for face in each]) for name, each in faces.items()}
    found = np.zeros((0, 4))
    for pair in combinations(solids, 2):
        common = _intersection(*(hulls[name] for name in pair))
        if common is not None:
            patch = common if patches is None else patches.get(pair, common)
            found = np.vstack([found, _meeting(*(faces[name] for name in pair), common, patch)])
    everything = [face for each in faces.values() for face in each]
    return Consistency(
        max_penetration=float(found[:, 0].max(initial=0.0)),
        max_contact_gap=float(found[:, 1].max(initial=0.0)),
        overlap_volume=float(found[:, 2].sum()),
        contact_area=float(found[:, 3].sum()),
        thickness=_highest(everything, 1.0) + _highest(everything, -1.0),
        yarn_volumes={name: solid.Volume(_VOLUME) for name, solid in solids.items()},
    )


def _spline(knots: np.ndarray, poles: np.ndarray, degree: int):
    from scipy.interpolate import BSpline  # not above: the masters import this door, and CQ-editor unloads it

    return BSpline(knots, poles, degree)


def _faces(solid: cq.Solid) -> tuple[_Face, ...]:
    """Top and bottom faces of a yarn; its vertical sides and planar ends are left out."""
    faces = []
    for face in solid.Faces():
        surface = BRep_Tool.Surface_s(face.wrapped)
        if not isinstance(surface, Geom_BSplineSurface):
            continue
        poles = np.array(
            [
                [(*surface.Pole(i, j).Coord(), surface.Weight(i, j)) for j in range(1, surface.NbVPoles() + 1)]
                for i in range(1, surface.NbUPoles() + 1)
            ]
        )
        if np.ptp(poles[..., 0]) < _PLAN or np.ptp(poles[..., 1]) < _PLAN:
            continue  # a vertical side
        along = int(np.ptp(poles[:, 0, 1]) > np.ptp(poles[:, 0, 0]))
        poles[..., :3] *= poles[..., 3:]
        knots = []
        for count, knot, times in (
            (surface.NbUKnots(), surface.UKnot, surface.UMultiplicity),
            (surface.NbVKnots(), surface.VKnot, surface.VMultiplicity),
        ):
            knots.append(np.repeat([knot(i + 1) for i in range(count)], [times(i + 1) for i in range(count)]))
        faces.append(_Face(tuple(knots), (surface.UDegree(), surface.VDegree()), poles, along))
    return tuple(faces)


def _hull(rectangles: list[Rectangle]) -> Rectangle:
    box = np.array(rectangles)
    return box[:, 0].min(), box[:, 1].max(), box[:, 2].min(), box[:, 3].max()


def _intersection(a: Rectangle, b: Rectangle) -> Rectangle | None:
    x0, x1, y0, y1 = max(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), min(a[3], b[3])
    return None if x1 - x0 <= _PLAN or y1 - y0 <= _PLAN else (x0, x1, y0, y1)


def _meeting(first, second, common: Rectangle, patch: Rectangle) -> tuple[float, float, float, float]:
    """(deepest penetration, largest gap over the patch, overlap volume, contact area) of two yarns."""
    near = [[face for face in faces if _intersection(face.rectangle, common)] for faces in (first, second)]
    axes = []
    for axis, ends in ((0, common[:2]), (1, common[2:])):
        lines = [*patch[2 * axis : 2 * axis + 2]]
        for face in (*near[0], *near[1]):
            lines += _knot_lines(face, axis)
        axes.append(_Grid(_cells(ends, lines)))
    sheets = [_sheets(faces, *axes) for faces in near]
    lower, upper = sorted(sheets, key=lambda sheet: (sheet[0] * np.outer(axes[0].weights, axes[1].weights)).sum())
    weights = np.outer(axes[0].weights, axes[1].weights)
    roof = lower[0].argmax(axis=0)[None]
    distance = upper[0].min(axis=0) - lower[0].max(axis=0)
    stretch = np.take_along_axis(lower[1], roof, axis=0)[0]
    inside = np.outer(axes[0].within(*patch[:2]), axes[1].within(*patch[2:]))
    touching = inside & (np.abs(distance) <= TOUCHING)
    return (
        max(0.0, -distance.min()),
        max(0.0, distance[inside].max()),
        (np.maximum(-distance, 0.0) * weights).sum(),
        (stretch[touching] * weights[touching]).sum(),
    )


class _Grid:
    """Quadrature points along one axis, cell by cell."""

    def __init__(self, cells: list[tuple[float, float]]) -> None:
        ends = np.array(cells)
        spans = ends[:, 1] - ends[:, 0]
        self.points = (ends[:, :1] + spans[:, None] * _NODES).ravel()
        self.weights = (spans[:, None] * _WEIGHTS).ravel()
        self.cells = np.repeat(ends, len(_NODES), axis=0)

    def within(self, low: float, high: float) -> np.ndarray:
        """True for the points of the cells that lie between two places."""
        return (self.cells[:, 0] >= low - _PLAN) & (self.cells[:, 1] <= high + _PLAN)


def _sheets(faces, x: _Grid, y: _Grid) -> np.ndarray:
    """Heights and stretches of a yarn's two sheets over a grid: shape (what, sheet, x, y)."""
    sheets = np.full((2, 2, len(x.points), len(y.points)), np.nan)
    filled = np.zeros((len(x.points), len(y.points)), dtype=int)
    for face in faces:
        x0, x1, y0, y1 = face.rectangle
        rows, columns = np.flatnonzero(x.within(x0, x1)), np.flatnonzero(y.within(y0, y1))
        if not (len(rows) and len(columns)):
            continue
        at = np.ix_(rows, columns)
        if filled[at].max() > 1:
            break
        places = np.clip(x.points[rows], x0, x1), np.clip(y.points[columns], y0, y1)
        found = np.array(face.heights(*places))
        for sheet in (0, 1):
            here = filled[at] == sheet
            for what in (0, 1):
                sheets[what, sheet][at] = np.where(here, found[what], sheets[what, sheet][at])
        filled[at] += 1
    if (filled != 2).any():
        raise BuildError("a yarn has not one top and one bottom face over a crossing")
    return sheets


def _knot_lines(face: _Face, axis: int) -> list[float]:
    """Plan coordinates of a face's knot lines across one axis."""
    direction = 0 if axis == face.along else 1
    knots = face.knots[direction]
    places = np.unique(knots)
    row = face.poles[:, 0] if direction == 0 else face.poles[0]
    curve = _spline(knots, row[:, [axis, 3]], face.degrees[direction])(places)
    return (curve[:, 0] / curve[:, 1]).tolist()


def _cells(ends: tuple[float, float], lines: list[float]) -> list[tuple[float, float]]:
    """Intervals between the distinct lines that lie within ``ends``."""
    places = [ends[0]]
    for place in sorted(lines):
        if places[-1] + _PLAN < place < ends[1] - _PLAN:
            places.append(place)
    places.append(ends[1])
    return list(zip(places, places[1:]))


def _highest(faces: list[_Face], sign: float) -> float:
    """Largest sign * z over all faces, mm."""
    bounds = [(sign * face.corners[..., 2]).max() for face in faces]
    best, where = -np.inf, None
    for number in np.argsort(bounds)[::-1]:
        face = faces[number]
        if bounds[number] <= best:
            break  # no pole of this face, or of any that follow, is higher
        u, v = (np.linspace(knots[0], knots[-1], 9) for knots in face.knots)
        points = face.evaluate(u, v)
        z = sign * points[..., 2] / points[..., 3]
        i, j = np.unravel_index(z.argmax(), z.shape)
        if z[i, j] > best:
            best, where = z[i, j], (face, u[i], v[j])
    from scipy.optimize import minimize

    face, *start = where

    def depth(at):
        point = face.evaluate(at[:1], at[1:])[0, 0]
        return -sign * point[2] / point[3]

    bounds = [(knots[0], knots[-1]) for knots in face.knots]
    refined = minimize(depth, start, bounds=bounds, method="L-BFGS-B", options={"ftol": 1e-15, "gtol": 1e-12})
    return float(max(best, -refined.fun))
