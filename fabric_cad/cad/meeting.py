"""Two yarns over the plan rectangle that they share.

With the distance d(x, y) = bottom of the upper yarn - top of the lower one, their depth of
penetration is -min d, their gap max d over the patch in which they should touch, and::

    overlap volume = integral of max(0, -d) dx dy
    contact area   = integral of dA / (dx dy) where |d| <= TOUCHING, over the same patch
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..support.errors import BuildError
from .faces import PLAN, Face, Rectangle
from .quadrature import PointsAlong

TOUCHING = 1e-9
"""Distance (mm) up to which two faces count as in contact."""


@dataclass(frozen=True)
class Meeting:
    """How two yarns meet: deepest penetration and largest gap, mm; overlap, mm3; contact, mm2."""

    penetration: float
    gap: float
    overlap_volume: float
    contact_area: float


@dataclass(frozen=True, eq=False)
class _Sheets:
    """A yarn's two sheets, in any order, over a grid: ``heights`` (2, x, y) mm.

    ``stretches`` (2, x, y) are areas of surface per area in plan.
    """

    heights: np.ndarray
    stretches: np.ndarray

    @property
    def top(self) -> np.ndarray:
        return self.heights.max(axis=0)

    @property
    def bottom(self) -> np.ndarray:
        return self.heights.min(axis=0)

    @property
    def top_stretch(self) -> np.ndarray:
        sheet = self.heights.argmax(axis=0)[None]
        return np.take_along_axis(self.stretches, sheet, axis=0)[0]


def hull(rectangles: Sequence[Rectangle]) -> Rectangle:
    """The rectangle around some."""
    box = np.array(rectangles)
    return box[:, 0].min(), box[:, 1].max(), box[:, 2].min(), box[:, 3].max()


def intersection(one: Rectangle, other: Rectangle) -> Rectangle | None:
    """What two rectangles share, None where that is no area."""
    x0, x1 = max(one[0], other[0]), min(one[1], other[1])
    y0, y1 = max(one[2], other[2]), min(one[3], other[3])
    return None if x1 - x0 <= PLAN or y1 - y0 <= PLAN else (x0, x1, y0, y1)


def meeting(
    first: Sequence[Face],
    second: Sequence[Face],
    common: Rectangle,
    patch: Rectangle,
) -> Meeting:
    """How the yarns of two sequences of faces meet over the rectangle ``common``.

    ``patch`` is the one in which they should touch. Raises BuildError where a face is no height
    field, or a yarn has not one top and one bottom face everywhere over the rectangle.
    """
    near_first = [face for face in first if intersection(face.rectangle, common)]
    near_second = [face for face in second if intersection(face.rectangle, common)]
    x, y = _grid([*near_first, *near_second], common, patch)
    weights = np.outer(x.weights, y.weights)
    yarns = _sheets(near_first, x, y), _sheets(near_second, x, y)
    lower, upper = sorted(yarns, key=lambda sheets: (sheets.heights * weights).sum())

    distance = upper.bottom - lower.top
    inside = np.outer(x.within(*patch[:2]), y.within(*patch[2:]))
    touching = inside & (np.abs(distance) <= TOUCHING)
    return Meeting(
        penetration=max(0.0, float(-distance.min())),
        gap=max(0.0, float(distance[inside].max())),
        overlap_volume=float((np.maximum(-distance, 0.0) * weights).sum()),
        contact_area=float((lower.top_stretch[touching] * weights[touching]).sum()),
    )


def _grid(
    faces: Sequence[Face],
    common: Rectangle,
    patch: Rectangle,
) -> tuple[PointsAlong, PointsAlong]:
    """Points along x and y, in cells that no knot line and no side of the patch crosses."""
    x_lines = [place for face in faces for place in face.knot_lines(0)]
    y_lines = [place for face in faces for place in face.knot_lines(1)]
    x0, x1, y0, y1 = common
    x = PointsAlong.between(x0, x1, [*patch[:2], *x_lines])
    y = PointsAlong.between(y0, y1, [*patch[2:], *y_lines])
    return x, y


def _sheets(faces: Sequence[Face], x: PointsAlong, y: PointsAlong) -> _Sheets:
    """A yarn's two sheets over a grid: at every point the first two faces that lie over it."""
    shape = len(x.points), len(y.points)
    sheets = _Sheets(np.full((2, *shape), np.nan), np.full((2, *shape), np.nan))
    filled = np.zeros(shape, dtype=int)

    for face in faces:
        x0, x1, y0, y1 = face.rectangle
        rows, columns = np.flatnonzero(x.within(x0, x1)), np.flatnonzero(y.within(y0, y1))
        if not (len(rows) and len(columns)):
            continue

        row, column = np.ix_(rows, columns)
        sheet = filled[row, column]
        if sheet.max() > 1:
            break  # a third face: told below

        z, stretch = face.heights(
            np.clip(x.points[rows], x0, x1),
            np.clip(y.points[columns], y0, y1),
        )
        sheets.heights[sheet, row, column] = z
        sheets.stretches[sheet, row, column] = stretch
        filled[row, column] += 1

    if (filled != 2).any():
        raise BuildError("a yarn has not one top and one bottom face over a crossing")
    return sheets
