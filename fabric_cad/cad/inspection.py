"""What a cell's solids really do, measured on the B-spline faces of the STEP file.

Seen from above, a yarn's top and bottom faces are height fields z(x, y) over axis-parallel
rectangles (checked, not assumed). Two yarns can therefore meet only where their rectangles
overlap, and there the difference of two heights is a polynomial between knot lines:
Gauss-Lobatto points with more nodes than its degree see all of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations, product

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt, gp_Vec
from scipy.optimize import minimize

from ..errors import BuildError

TOUCHING = 1e-9
"""Distance (mm) up to which two faces count as in contact."""

_PLAN = 1e-9  # mm, how far a face may be from a height field with straight parameter lines
# Gauss-Lobatto on [0, 1], five points: exact to degree 7, ends included
_NODES = (np.array([-1.0, -np.sqrt(3 / 7), 0.0, np.sqrt(3 / 7), 1.0]) + 1) / 2
_WEIGHTS = np.array([1 / 20, 49 / 180, 16 / 45, 49 / 180, 1 / 20])


@dataclass(frozen=True)
class Consistency:
    """How a cell's yarns meet; lengths mm, areas mm2, volumes mm3.

    ``max_contact_gap`` is the largest distance between the facing sides of two crossing
    yarns, ``max_penetration`` how deep one enters another, ``overlap_volume`` the integral of
    that depth over the fabric's plane, ``contact_area`` the area in which the
    distance is at most :data:`TOUCHING`; ``yarn_volumes`` has one entry a yarn.
    """

    max_penetration: float
    max_contact_gap: float
    overlap_volume: float
    contact_area: float
    thickness: float
    yarn_volumes: dict[str, float]


@dataclass(frozen=True)
class _HeightField:
    """A B-spline face as z(x, y) over its rectangle."""

    surface: Geom_BSplineSurface
    swapped: bool  # u runs along y
    x: tuple[float, ...]  # knot lines, ends included
    y: tuple[float, ...]
    z: tuple[float, float]  # bounds of its poles, and so of the face

    @property
    def rectangle(self) -> tuple[float, float, float, float]:
        return self.x[0], self.x[-1], self.y[0], self.y[-1]

    def at(self, x: float, y: float) -> tuple[float, float]:
        """(z, area of surface per area in plan) at a point of the rectangle."""
        s, point, du, dv = self.surface, gp_Pnt(), gp_Vec(), gp_Vec()
        along, across = (y, x) if self.swapped else (x, y)
        lines_u, lines_v = (self.y, self.x) if self.swapped else (self.x, self.y)
        u = _scaled(along, lines_u[0], lines_u[-1], s.UKnot(1), s.UKnot(s.NbUKnots()))
        v = _scaled(across, lines_v[0], lines_v[-1], s.VKnot(1), s.VKnot(s.NbVKnots()))
        s.D1(u, v, point, du, dv)
        if abs(point.X() - x) > _PLAN or abs(point.Y() - y) > _PLAN:
            raise BuildError("a yarn's face is no height field over the fabric's plane")
        normal = du.Crossed(dv)
        return point.Z(), normal.Magnitude() / abs(normal.Z())


def _scaled(value: float, low: float, high: float, to_low: float, to_high: float) -> float:
    return to_low + (value - low) / (high - low) * (to_high - to_low)


def inspect_cell(solids: Mapping[str, cq.Solid]) -> Consistency:
    """Measure the solids of a cell, as read from its STEP file.

    Raises :class:`BuildError` where a yarn is no valid solid, or bounded by faces that are no height fields.
    """
    for name, solid in solids.items():
        if not solid.isValid():
            raise BuildError(f"{name} is not a valid solid")
    fields = {name: _height_fields(solid) for name, solid in solids.items()}
    penetration = gap = overlap = area = 0.0
    for first, second in combinations(solids, 2):
        for rectangle in _common_rectangles(fields[first], fields[second]):
            meeting = _meeting(fields[first], fields[second], rectangle)
            penetration = max(penetration, meeting[0])
            gap = max(gap, meeting[1])
            overlap += meeting[2]
            area += meeting[3]
    everything = [field for each in fields.values() for field in each]
    return Consistency(
        max_penetration=float(penetration),
        max_contact_gap=float(gap),
        overlap_volume=float(overlap),
        contact_area=float(area),
        thickness=_highest(everything, 1.0) + _highest(everything, -1.0),
        yarn_volumes={name: solid.Volume() for name, solid in solids.items()},
    )


def _height_fields(solid: cq.Solid) -> tuple[_HeightField, ...]:
    """Top and bottom faces of a yarn; its vertical sides and ends are no height fields."""
    fields = []
    for face in solid.Faces():
        surface = BRep_Tool.Surface_s(face.wrapped)
        if not isinstance(surface, Geom_BSplineSurface):
            continue  # a planar end
        poles = np.array(
            [
                [surface.Pole(i, j).Coord() for j in range(1, surface.NbVPoles() + 1)]
                for i in range(1, surface.NbUPoles() + 1)
            ]
        )
        if np.ptp(poles[..., 0]) < _PLAN or np.ptp(poles[..., 1]) < _PLAN:
            continue  # a vertical side
        swapped = np.ptp(poles[:, 0, 1]) > np.ptp(poles[:, 0, 0])
        lines = {}
        for axis, knots in (
            (swapped, [surface.UKnot(i) for i in range(1, surface.NbUKnots() + 1)]),
            (not swapped, [surface.VKnot(i) for i in range(1, surface.NbVKnots() + 1)]),
        ):
            ends = poles[0, 0, int(axis)], poles[-1, -1, int(axis)]
            lines[int(axis)] = tuple(_scaled(knot, knots[0], knots[-1], *ends) for knot in knots)
        if lines[0][0] > lines[0][-1] or lines[1][0] > lines[1][-1]:
            raise BuildError("a yarn's face does not run along the cell's axes")
        fields.append(
            _HeightField(surface, bool(swapped), lines[0], lines[1], (poles[..., 2].min(), poles[..., 2].max()))
        )
    return tuple(fields)


def _common_rectangles(first, second) -> set[tuple[float, float, float, float]]:
    """Plan rectangles in which faces of two yarns lie over each other."""
    boxes = [np.array([field.rectangle for field in fields]) for fields in (first, second)]
    hulls = [(box[:, 0].min(), box[:, 1].max(), box[:, 2].min(), box[:, 3].max()) for box in boxes]
    if (shared := _intersection(*hulls)) is None:
        return set()
    near = [[field for field in fields if _intersection(field.rectangle, shared)] for fields in (first, second)]
    common = (_intersection(a.rectangle, b.rectangle) for a, b in product(*near))
    return {rectangle for rectangle in common if rectangle is not None}


def _intersection(a, b) -> tuple[float, float, float, float] | None:
    """Common part of two rectangles (x0, x1, y0, y1), rounded so that equal ones compare equal."""
    x0, x1, y0, y1 = max(a[0], b[0]), min(a[1], b[1]), max(a[2], b[2]), min(a[3], b[3])
    if x1 - x0 <= _PLAN or y1 - y0 <= _PLAN:
        return None
    return tuple(round(float(value), 10) for value in (x0, x1, y0, y1))


def _meeting(first, second, rectangle) -> tuple[float, float, float, float]:
    """(deepest penetration, largest gap, overlap volume, contact area) over a plan rectangle."""
    x0, x1, y0, y1 = rectangle
    facing = [
        [
            f
            for f in fields
            if f.x[0] <= x0 + _PLAN and f.x[-1] >= x1 - _PLAN and f.y[0] <= y0 + _PLAN and f.y[-1] >= y1 - _PLAN
        ]
        for fields in (first, second)
    ]
    if any(len(fields) != 2 for fields in facing):
        raise BuildError("a yarn has not one top and one bottom face over a crossing")
    xs, wx = _rule((x0, x1), [line for fields in facing for field in fields for line in field.x])
    ys, wy = _rule((y0, y1), [line for fields in facing for field in fields for line in field.y])
    weights = np.outer(wx, wy)
    # (yarn, face, x, y, [z, area of surface per area in plan]), faces sorted bottom first
    found = np.array(
        [[[[field.at(*_inside(field, x, y)) for y in ys] for x in xs] for field in fields] for fields in facing]
    )
    z = np.sort(found[..., 0], axis=1)
    low, high = z[np.argsort(z.mean(axis=(1, 2, 3)))]
    distance = high[0] - low[1]
    stretch = found[0, np.argmin(np.abs(found[0, ..., 0] - low[1]).mean(axis=(1, 2))), ..., 1]
    return (
        max(0.0, -distance.min()),
        max(0.0, distance.max()),
        (np.maximum(-distance, 0.0) * weights).sum(),
        (stretch * weights)[np.abs(distance) <= TOUCHING].sum(),
    )


def _inside(field: _HeightField, x: float, y: float) -> tuple[float, float]:
    """A point moved by rounding at most, into the rectangle of a face."""
    return min(max(x, field.x[0]), field.x[-1]), min(max(y, field.y[0]), field.y[-1])


def _rule(ends: tuple[float, float], lines: list[float]) -> tuple[list[float], np.ndarray]:
    """Points and weights of the quadrature between two ends, knot line by knot line."""
    low, high = ends
    inner = sorted({round(line, 10) for line in lines if low + _PLAN < line < high - _PLAN})
    places = np.array([low, *inner, high])
    spans = np.diff(places)
    points = places[:-1, None] + spans[:, None] * _NODES
    return points.ravel().tolist(), (spans[:, None] * _WEIGHTS).ravel()


def _highest(fields: list[_HeightField], sign: float) -> float:
    """Largest sign * z over all faces, mm."""
    best, where = -np.inf, None
    for field in sorted(fields, key=lambda each: -max(sign * z for z in each.z)):
        if max(sign * z for z in field.z) <= best:
            break  # no pole of this face, or of any that follow, is higher
        x0, x1, y0, y1 = field.rectangle
        for at in product(np.linspace(x0, x1, 9).tolist(), np.linspace(y0, y1, 9).tolist()):
            z = sign * field.at(*_inside(field, *at))[0]
            if z > best:
                best, where = z, (field, at)
    field, at = where
    x0, x1, y0, y1 = field.rectangle
    refined = minimize(
        lambda at: -sign * field.at(*_inside(field, *at))[0],
        at,
        bounds=((x0, x1), (y0, y1)),
        method="L-BFGS-B",
        options={"ftol": 1e-15, "gtol": 1e-12},
    )
    return max(best, float(-refined.fun))
