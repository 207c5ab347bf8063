"""How consistent a fabric's yarns would be under the models that the paper criticises (section 2).

For one identified fabric, the yarns of five constant-section models and those of the present
model are written as height fields over the plan, z = bottom(t, v) and top(t, v), with t along
a yarn and v across it from its axis. All six share the spacing, the widths and thicknesses of
the yarns and the plateaux of the midlines, so every crossing touches at its centre, and differ
in nothing but the curve between two plateaux and the section:

    trajectories    sinusoidal   half a cosine from one crossing's centre to the next
                    circular     arc, straight segment, arc with common tangents; the arcs have the
                                 radius of the crossed yarn's lens, around which they bend
                    bars         straight from one crossing's centre to the next (Kawabata, Fig. 5)
    sections        elliptic     an ellipse with the axes c and b
                    lenticular   two circular arcs over the chord c, b high together

Sections are constant and stand in vertical planes x = const (wefts) or y = const (warps), as the
present model's do. Over a float, between crossings on one side, every trajectory is flat.

In plan two yarns overlap only in the rectangles of their crossings. There the gap is the upper
yarn's bottom minus the lower yarn's top: negative where they penetrate each other, positive where
they leave a void. It is measured on a midpoint grid, finer towards the yarns' edges.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..model.solved import Direction, SolvedFabric
from ..support.errors import BuildError
from ..weave.weaves import Yarn, yarns_of
from ..yarn.planes import control_planes
from ..yarn.swept import SweptYarn

POINTS = 192
"""Points of the grid along either side of a crossing: volumes are then right to 0.1 %, the
contact area to 1 % of the crossings' area."""

TOLERANCE = 0.01
"""Two faces touch where they are nearer than this share of the thinner yarn's thickness: a few
micrometres, less than a fibre's diameter, and in favour of the models that touch at points."""

Heights = Callable[[SolvedFabric, Yarn, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Model:
    """A model of a fabric's yarns.

    ``heights(fabric, yarn, t, v)`` gives the bottom and the top of a yarn, each of shape
    (len(t), len(v)), at places ``t`` along it (0 to the period) and ``v`` across it
    (-c/2 to c/2); mm. It raises :class:`BuildError` where the model cannot make the yarn.
    """

    title: str
    heights: Heights


# Fall of a midline from its plateau, at the distance u (0 to a/2) from the crossing's centre


def sinusoidal(u: np.ndarray, solved: Direction, crossed: Direction) -> np.ndarray:
    """A/2 (1 - cos(pi u / a)), mm."""
    return solved.amplitude / 2 * (1 - np.cos(np.pi * u / solved.crossed_spacing))


def circular(u: np.ndarray, solved: Direction, crossed: Direction) -> np.ndarray:
    """Arc, then its tangent to the mid-gap plane, mm. Raises :class:`BuildError`.

    The arc has the radius R of the crossed yarn's lens, so a lens is touched all along it.
    The segment is the inner common tangent of two circles whose centres are a apart along
    the yarn and A - 2 R across it; where 2 R > a, these leave room for a rise up to that of
    two arcs alone.
    """
    a, rise, radius = solved.crossed_spacing, solved.amplitude, lens_radius(crossed)
    most = 2 * radius - np.sqrt(max(4 * radius**2 - a**2, 0.0))
    if 2 * radius > a and rise > most:
        raise BuildError(
            f"a circular trajectory cannot rise by {rise:.4g} mm over a spacing of {a:.4g} mm: its arcs, of the "
            f"radius {radius:.4g} mm of the crossed yarn's lens, have room for {most:.4g} mm"
        )
    across = rise - 2 * radius
    angle = np.arctan2(across, a) + np.arcsin(2 * radius / np.hypot(a, across))
    end = radius * np.sin(angle)
    on_arc = radius - np.sqrt(radius**2 - np.minimum(u, end) ** 2)
    return on_arc + np.tan(angle) * np.maximum(u - end, 0.0)


def straight_bars(u: np.ndarray, solved: Direction, crossed: Direction) -> np.ndarray:
    """A u / a, mm."""
    return solved.amplitude * u / solved.crossed_spacing


# Height of a section above its axis, at the distance v across


def elliptic(v: np.ndarray, solved: Direction) -> np.ndarray:
    """b/2 sqrt(1 - (2 v / c)^2), mm."""
    return solved.thickness / 2 * np.sqrt(np.maximum(1 - (2 * v / solved.width) ** 2, 0.0))


def lenticular(v: np.ndarray, solved: Direction) -> np.ndarray:
    """b/2 - R + sqrt(R^2 - v^2), mm."""
    radius = lens_radius(solved)
    return solved.thickness / 2 - (radius - np.sqrt(np.maximum(radius**2 - v**2, 0.0)))


def lens_radius(solved: Direction) -> float:
    """Radius R (mm) of the two arcs of a lens, c wide and b thick. Raises :class:`BuildError`."""
    b, c = solved.thickness, solved.width
    if b > c:
        raise BuildError(f"no lens is {b:.4g} mm thick and {c:.4g} mm wide: its arcs would exceed half circles")
    return (b**2 + c**2) / (4 * b)


def constant_section(fall: Callable, half_height: Callable) -> Heights:
    """Heights of a yarn with the same section everywhere, along a trajectory given by its fall."""

    def heights(fabric: SolvedFabric, yarn: Yarn, t: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        solved, crossed = fabric.directions[yarn.direction], fabric.crossed(yarn.direction)
        a, count = solved.crossed_spacing, len(yarn.high)
        at = np.clip((t / a).astype(int), 0, count - 1)
        from_centre = t - (at + 0.5) * a
        high = np.array(yarn.high)
        turns = high[at] != high[(at + np.where(from_centre < 0, -1, 1)) % count]
        drop = np.where(turns, fall(np.abs(from_centre), solved, crossed), 0.0)
        middle = np.where(high[at], solved.z_high - drop, solved.z_low + drop)[:, None]
        half = half_height(v, solved)
        return middle - half, middle + half

    return heights


def _present(fabric: SolvedFabric, yarn: Yarn, t: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Heights of a yarn of the present model: the patches that its solid is made of."""
    from scipy.interpolate import BSpline

    surface = SweptYarn(fabric, yarn).skin
    found = {level: np.full((len(t), len(v)), np.nan) for level in ("lower", "upper")}
    sheet = {"bottom": "lower", "top": "upper"}
    for patch in surface.patches:
        level = sheet.get(patch.side, patch.side.split("_")[-1])
        (knots, degree), (across, across_degree) = patch.along, patch.across
        here = np.flatnonzero((t >= knots[0]) & (t <= knots[-1]))
        if level not in found or not len(here):
            continue
        rows = BSpline(knots, patch.homogeneous, degree)(t[here])
        if np.ptp(patch.poles[..., [1, 3]], axis=0).max() == 0:  # one section all along
            curve = BSpline(across, rows.transpose(1, 0, 2), across_degree)
            at, inside = _across_parameter(curve, v)
            found[level][np.ix_(here, inside)] = (curve(at)[..., 2] / curve(at)[..., 3]).T
            continue
        for row, number in zip(rows, here):
            curve = BSpline(across, row[:, None], across_degree)
            at, inside = _across_parameter(curve, v)
            found[level][number, inside] = (curve(at)[..., 2] / curve(at)[..., 3])[:, 0]
    return found["lower"], found["upper"]


def _across_parameter(curve, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of a strip at the places v that it covers, and the numbers of those places."""

    def places(parameters: np.ndarray) -> np.ndarray:
        points = curve(parameters)[:, 0]
        return points[:, 1] / points[:, 3]

    ends = places(np.array([0.0, 1.0]))
    slack = 1e-12 * max(1.0, np.ptp(ends))
    inside = np.flatnonzero((v >= ends[0] - slack) & (v <= ends[1] + slack))
    wanted = np.clip(v[inside], *ends)
    at = (wanted - ends[0]) / np.ptp(ends)
    if len(at) and np.max(np.abs(places(at) - wanted)) > slack:  # an arc: bisect
        low, high = np.zeros(len(at)), np.ones(len(at))
        for _ in range(60):
            at = (low + high) / 2
            beyond = places(at) > wanted
            low, high = np.where(beyond, low, at), np.where(beyond, at, high)
    return at, inside


MODELS = (
    Model("sinusoidal, elliptic", constant_section(sinusoidal, elliptic)),
    Model("sinusoidal, lenticular", constant_section(sinusoidal, lenticular)),
    Model("circular, elliptic", constant_section(circular, elliptic)),
    Model("circular, lenticular", constant_section(circular, lenticular)),
    Model("straight bars, elliptic", constant_section(straight_bars, elliptic)),
    Model("present model", _present),
)
"""The five models criticised, then the present one."""


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


def crossing_heights(
    fabric: SolvedFabric, model: Model, weft: Yarn, warp: Yarn, v_weft: np.ndarray, v_warp: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Bottom and top of the lower yarn, then of the upper, over one crossing (mm).

    ``v_warp`` are distances from the warp's axis (along x), ``v_weft`` from the weft's (along
    y), mm; each array has the shape (len(v_warp), len(v_weft)).
    """
    x = (warp.index + 0.5) * fabric.weft.crossed_spacing + v_warp
    y = (weft.index + 0.5) * fabric.warp.crossed_spacing + v_weft
    along_x = model.heights(fabric, weft, x, v_weft)
    along_y = tuple(z.T for z in model.heights(fabric, warp, y, v_warp))
    return (*along_y, *along_x) if weft.high[warp.index] else (*along_x, *along_y)


def crossing_gap(
    fabric: SolvedFabric, model: Model, weft: Yarn, warp: Yarn, v_weft: np.ndarray, v_warp: np.ndarray
) -> np.ndarray:
    """Upper yarn's bottom minus lower yarn's top (mm) over one crossing, as :func:`crossing_heights`."""
    _, low, high, _ = crossing_heights(fabric, model, weft, warp, v_weft, v_warp)
    return high - low


def measure(fabric: SolvedFabric, model: Model, points: int = POINTS, tolerance: float | None = None) -> Comparison:
    """Measure one model on ``points`` x ``points`` places of every crossing.

    Penetration is how far the facing sides have passed each other; the overlap counts only
    what lies in both yarns, which is less where one of them is thin. ``tolerance`` (mm)
    tells contact; by default :data:`TOLERANCE` of the thinner yarn. Raises
    :class:`BuildError` where the model cannot make this fabric's yarns.
    """
    if tolerance is None:
        tolerance = TOLERANCE * min(fabric.weft.thickness, fabric.warp.thickness)
    (v_weft, d_weft), (v_warp, d_warp) = (_midpoints(way.width, points) for way in (fabric.weft, fabric.warp))
    areas = np.outer(d_warp, d_weft)
    deepest = overlap = void = touching = total = 0.0
    for weft, warp in crossings(fabric):
        bottom, low, high, top = crossing_heights(fabric, model, weft, warp, v_weft, v_warp)
        gap, shared = high - low, np.minimum(low, top) - np.maximum(high, bottom)
        deepest = max(deepest, float(-gap.min()))
        overlap += float(np.sum(np.maximum(shared, 0.0) * areas))
        void += float(np.sum(np.maximum(gap, 0.0) * areas))
        touching += float(np.sum(areas[np.abs(gap) <= tolerance]))
        total += float(np.sum(areas))
    return Comparison(model.title, tolerance, deepest, overlap, void, touching, total, yarn_volume(fabric, model))


def compare(fabric: SolvedFabric, models: Sequence[Model] = MODELS, points: int = POINTS) -> tuple[Comparison, ...]:
    """Measure every model on one identified fabric, as :func:`measure` does.

    Raises :class:`BuildError` where one of them cannot be made; circular arcs have no room where
    a yarn rises steeply over thin, wide ones. ``models`` may leave such out.
    """
    return tuple(measure(fabric, model, points) for model in models)


def crossings(fabric: SolvedFabric) -> Iterator[tuple[Yarn, Yarn]]:
    """(weft, warp) of every crossing in the cell."""
    yarns = yarns_of(fabric.weave.interlacement())
    for weft in yarns[: fabric.weave.wefts]:
        for warp in yarns[fabric.weave.wefts :]:
            yield weft, warp


def yarn_volume(fabric: SolvedFabric, model: Model) -> float:
    """Volume of all yarns of the cell, mm3: Gauss's rule, 4 points between two control planes."""
    volume = 0.0
    for yarn in yarns_of(fabric.weave.interlacement()):
        half_width = fabric.directions[yarn.direction].width / 2
        planes = np.array([plane.place for plane in control_planes(fabric, yarn)])
        t, dt = _gauss(planes, 4)
        angle, d_angle = _gauss(np.array([-np.pi / 2, 0.0, np.pi / 2]), 24)
        bottom, top = model.heights(fabric, yarn, t, half_width * np.sin(angle))
        volume += float(dt @ (top - bottom) @ (d_angle * half_width * np.cos(angle)))
    return volume


def _midpoints(width: float, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places across a yarn and the extents of their cells, each shape (points,), mm.

    Cells are equal in the angle whose sine is 2 v / c, in which an ellipse has no steep edge.
    """
    angles = np.linspace(-np.pi / 2, np.pi / 2, 2 * points + 1)
    v = width / 2 * np.sin(angles)
    return v[1::2], np.diff(v[::2])


def _gauss(ends: np.ndarray, points: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of Gauss's rule with ``points`` points in every interval between ``ends``."""
    places, weights = np.polynomial.legendre.leggauss(points)
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    return (middle[:, None] + np.outer(half, places)).ravel(), np.outer(half, weights).ravel()


def comparison_table(results: Sequence[Comparison]) -> str:
    """The results as plain text, one model a line."""
    lines = [
        f"{'':24}{'penetration':>13}{'overlap':>10}{'overlap':>10}{'contact':>10}{'void':>10}{'mean void':>11}",
        f"{'':24}{'max mm':>13}{'mm3':>10}{'% yarn':>10}{'% area':>10}{'mm3':>10}{'mm':>11}",
    ]
    for each in results:
        values = (
            (_short(each.max_penetration, 4), 13),
            (_short(each.overlap_volume, 3), 10),
            (_short(each.overlap_percent, 2), 10),
            (_short(each.contact_percent, 1), 10),
            (_short(each.void_volume, 3), 10),
            (_short(each.mean_void, 4), 11),
        )
        lines.append(f"{each.model:24}" + "".join(f"{text:>{width}}" for text, width in values))
    return "\n".join(lines)


def _short(value: float, digits: int) -> str:
    """A number with ``digits`` decimals, or as a power of ten where these would hide it."""
    return f"{value:.{digits}f}" if value >= 10.0**-digits else f"{value:.0e}" if value else "0"
