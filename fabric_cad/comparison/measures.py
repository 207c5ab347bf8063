"""How consistent a fabric's yarns are under a model.

In plan two yarns overlap only in the rectangles of their crossings. There the gap is the upper
yarn's bottom minus the lower yarn's top: negative where they penetrate each other, positive where
they leave a void. It is measured on a midpoint grid, finer towards the yarns' edges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.weaves import yarns_of
from ..yarn.planes import control_planes
from .crossings import crossings, facing
from .models import MODELS, Model

POINTS = 192
"""Points of the grid along either side of a crossing: volumes are then right to 0.1 %, the
contact area to 1 % of the crossings' area."""

TOLERANCE = 0.01
"""Two faces touch where they are nearer than this share of the thinner yarn's thickness: a few
micrometres, less than a fibre's diameter, and in favour of the models that touch at points."""


@dataclass(frozen=True)
class Comparison:
    """What one model makes of a fabric's elementary cell, all of its crossings together.

    ``max_penetration`` mm; ``overlap_volume``, ``void_volume`` (between the facing sides of the
    crossings, where they are apart) and ``yarn_volume`` mm3; ``contact_area`` (where the gap is
    within ``tolerance``, mm, of 0) and ``crossing_area`` (of all rectangles) mm2.
    """

    model: str
    tolerance: float
    max_penetration: float
    overlap_volume: float
    void_volume: float
    contact_area: float
    crossing_area: float
    yarn_volume: float

    @property
    def overlap_percent(self) -> float:
        """Overlap volume in percent of the yarns' volume."""
        return 100 * self.overlap_volume / self.yarn_volume

    @property
    def contact_percent(self) -> float:
        """Contact area in percent of the crossings' area."""
        return 100 * self.contact_area / self.crossing_area

    @property
    def mean_void(self) -> float:
        """Void volume per area of the crossings, mm."""
        return self.void_volume / self.crossing_area


def measure(
    fabric: SolvedFabric,
    model: Model,
    points: int = POINTS,
    tolerance: float | None = None,
) -> Comparison:
    """Measure one model on ``points`` x ``points`` places of every crossing.

    Penetration is how far the facing sides have passed each other; the overlap counts only
    what lies in both yarns, which is less where one of them is thin. ``tolerance`` (mm)
    tells contact; by default :data:`TOLERANCE` of the thinner yarn. Raises
    :class:`BuildError` where the model cannot make this fabric's yarns.
    """
    if tolerance is None:
        tolerance = TOLERANCE * min(fabric.weft.thickness, fabric.warp.thickness)
    v_weft, d_weft = _midpoints(fabric.weft.width, points)
    v_warp, d_warp = _midpoints(fabric.warp.width, points)
    areas = np.outer(d_warp, d_weft)

    deepest = overlap = void = touching = total = 0.0
    for crossing in crossings(fabric):
        sheets = facing(fabric, model, crossing, v_weft, v_warp)
        gap = sheets.gap
        deepest = max(deepest, float(-gap.min()))
        overlap += float(np.sum(np.maximum(sheets.shared, 0.0) * areas))
        void += float(np.sum(np.maximum(gap, 0.0) * areas))
        touching += float(np.sum(areas[np.abs(gap) <= tolerance]))
        total += float(np.sum(areas))

    return Comparison(
        model=model.title,
        tolerance=tolerance,
        max_penetration=deepest,
        overlap_volume=overlap,
        void_volume=void,
        contact_area=touching,
        crossing_area=total,
        yarn_volume=yarn_volume(fabric, model),
    )


def compare(
    fabric: SolvedFabric,
    models: Sequence[Model] = MODELS,
    points: int = POINTS,
) -> tuple[Comparison, ...]:
    """Measure every model on one identified fabric, as :func:`measure` does.

    Raises :class:`BuildError` where one of them cannot be made; circular arcs have no room where
    a yarn rises steeply over thin, wide ones. ``models`` may leave such out.
    """
    return tuple(measure(fabric, model, points) for model in models)


def yarn_volume(fabric: SolvedFabric, model: Model) -> float:
    """Volume of all yarns of the cell, mm3: the integral of top - bottom over their plan.

    Gauss's rule has 4 points between two control planes and, across, 24 in either half of the
    yarn, in the angle whose sine is 2 v / c: there an ellipse has no steep edge.
    """
    volume = 0.0
    for yarn in yarns_of(fabric.weave.interlacement()):
        planes = np.array([plane.place for plane in control_planes(fabric, yarn)])
        t, dt = _gauss(planes, 4)

        half_width = fabric.directions[yarn.direction].width / 2
        angle, d_angle = _gauss(np.array([-np.pi / 2, 0.0, np.pi / 2]), 24)
        v, dv = half_width * np.sin(angle), d_angle * half_width * np.cos(angle)

        bottom, top = model.heights(fabric, yarn, t, v)
        volume += float(dt @ (top - bottom) @ dv)

    return volume


def _midpoints(width: float, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places across a yarn and the extents of their cells, each shape (points,), mm.

    Cells are equal in the angle whose sine is 2 v / c, in which an ellipse has no steep edge.
    """
    angles = np.linspace(-np.pi / 2, np.pi / 2, 2 * points + 1)
    v = width / 2 * np.sin(angles)
    return v[1::2], np.diff(v[::2])


def _gauss(ends: np.ndarray, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of Gauss's rule with ``points`` points in every interval of ``ends``."""
    places, weights = np.polynomial.legendre.leggauss(points)
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    return (middle[:, None] + np.outer(half, places)).ravel(), np.outer(half, weights).ravel()
