"""Sections, trajectories and cuts of a solved fabric, as the paper's Fig. 15 to 18 draw them, its models compared, and
what simulations of its cell gave (Fig. 3, 4, 22a and 22c).

Each function draws on Matplotlib axes it is given; lengths mm. Those of simulations make a figure of their own where
they are given none, and return the figure either way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from scipy.interpolate import BSpline, CloughTocher2DInterpolator

from ..comparison.models import MODELS, TOLERANCE, Model, crossing_gap
from ..model.solved import SolvedFabric, point_columns
from ..section.sections import KINDS, Section, contact_section, free_section
from ..section.splines import Spline
from ..support.series import valid_until
from ..weave.colours import COLOURS, colour_of
from ..weave.directions import DIRECTIONS
from ..weave.weaves import Yarn, yarns_of
from ..yarn.swept import SweptYarn

_POINTS = 41
_ACROSS = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 301)) / 2  # of a width, closer towards the edges
_PENETRATION = "#d1001f"
_UNSEEN = 1e-9  # mm, less than any picture shows

# strips of a section in the order in which they follow each other, and which are run backwards
_AROUND = (
    ("left_lower", False),
    ("bottom", False),
    ("right_lower", False),
    ("right", False),
    ("right_upper", True),
    ("top", True),
    ("left_upper", True),
    ("left", True),
)


def sample(spline: Spline, points: int = _POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Places along a spline and its heights there, each of shape (points,), mm."""
    t = np.linspace(spline.knots[0], spline.knots[-1], points)
    return t, BSpline(spline.knots, spline.poles, spline.degree)(t)


def section_outline(section: Section, points: int = _POINTS) -> tuple[np.ndarray, np.ndarray]:
    """The closed outline (v, z) of a section, counter-clockwise from its left edge, mm."""
    curve = []
    for side, backwards in _AROUND:
        if side in section.strips:
            found = section.strips[side].at(np.linspace(0.0, 1.0, points))
            curve.append(found[::-1] if backwards else found)
    v, z = np.vstack([*curve, curve[0][:1]]).T
    return v, z


def _yarn(fabric: SolvedFabric, direction: str, number: int) -> Yarn:
    return next(y for y in yarns_of(fabric.weave.interlacement()) if y.name == f"{direction}_{number}")


def plot_trajectory(fabric: SolvedFabric, axes, direction: str = "weft") -> None:
    """Half a period of a midline with its control points M1 ... M6 (Fig. 16)."""
    solved = fabric.directions[direction]
    names = [name for name, *_ in point_columns(direction)]
    places = np.array(solved.points)
    (_, _), (x2, z2), (x3, _), (x4, _), (x5, z5), _ = places
    axes.plot(*places[:2].T, color=COLOURS[direction])
    axes.plot(*places[4:].T, color=COLOURS[direction])
    sign = np.sign(z5 - z2)
    p_start, p_end = (solved.p_low, solved.p_high) if sign > 0 else (solved.p_high, solved.p_low)
    for start, end, vertex, level, p in ((x2, x3, x2, z2, sign * p_start), (x4, x5, x5, z5, -sign * p_end)):
        x = np.linspace(start, end, _POINTS)
        axes.plot(x, level + p * (x - vertex) ** 2, color="black")
    axes.plot(*places[2:4].T, color=COLOURS[direction], linestyle="--")
    axes.plot(*places.T, "o", color="black", markersize=4)
    for name, place in zip(names, places):
        axes.annotate(name, place, xytext=(0, 6), textcoords="offset points", ha="center")
    axes.margins(y=0.2)
    axes.set(xlabel="x mm" if direction == "weft" else "y mm", ylabel="z mm", title=f"trajectory of the {direction}")


def plot_sections(fabric: SolvedFabric, axes, direction: str = "weft") -> None:
    """The control sections of one direction in their envelope rectangle (Fig. 17).

    ``axes`` are four: crossed yarn floats, turns on the right, turns on both sides, and
    the section between crossings.
    """
    solved, frame = fabric.directions[direction], fabric.frame(direction)
    titles = {"float": "contact, flat", "edge": "contact, turn on the right", "turn": "contact, turn on both sides"}
    for ax, kind in zip(axes, (*KINDS, "free")):
        if kind == "free":
            section, title = free_section(frame, solved.between), "between crossings"
        else:
            turns = {"float": (False, False), "edge": (False, True), "turn": (True, True)}[kind]
            section = contact_section(frame, solved.contact["high"], turns, solved.free_sides["high", kind], below=True)
            title = titles[kind]
        ax.fill(*section_outline(section), color=COLOURS[direction], alpha=0.5)
        ax.plot(*section_outline(section), color="black", linewidth=1)
        half_width, half_height = solved.width / 2, solved.thickness / 2
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) * [half_width, half_height]
        ax.plot(*corners.T, color="grey", linestyle=":", linewidth=1)
        ax.set(title=title, aspect="equal")


def plot_cut(fabric: SolvedFabric, axes, direction: str = "weft", number: int = 1) -> None:
    """A cut through the cell along the axis of one yarn: its own profile and the sections it crosses (Fig. 15, 18)."""
    yarn = _yarn(fabric, direction, number)
    swept = SweptYarn(fabric, yarn)
    path, sections = swept.trajectory, swept.sections
    t, bottom, top = [], [], []
    for piece, first, second in zip(path.pieces, sections, sections[1:]):
        x, z = sample(piece)
        share = (x - x[0]) / (x[-1] - x[0])
        blend = share**2 * (3 - 2 * share)
        t.append(x)
        for profile, side in ((bottom, "bottom"), (top, "top")):
            start, end = (_on_axis(section, side) for section in (first, second))
            profile.append(z + (1 - blend) * start + blend * end)
    along = np.concatenate(t)
    axes.fill_between(along, np.concatenate(bottom), np.concatenate(top), color=COLOURS[direction], alpha=0.6)
    crossed_direction = DIRECTIONS[1 - DIRECTIONS.index(direction)]
    crossed = fabric.directions[crossed_direction]
    for k, high in enumerate(yarn.high):
        other = SweptYarn(fabric, _yarn(fabric, crossed_direction, k + 1))
        met = next(n for n, plane in enumerate(other.planes) if plane.crossing == number - 1)
        v, z = section_outline(other.sections[met])
        level = crossed.z_low if high else crossed.z_high
        axes.fill(
            (k + 0.5) * fabric.directions[direction].crossed_spacing + v,
            level + z,
            color=COLOURS[crossed_direction],
            alpha=0.9,
        )
    axes.set(
        xlabel="x mm" if direction == "weft" else "y mm",
        ylabel="z mm",
        title=f"cut along {direction} {number}",
        aspect="equal",
    )


def plot_edges(fabric: SolvedFabric, axes, direction: str = "weft", number: int = 1) -> None:
    """Heights of a yarn's two edges along it, over its midline; a flat side's lower corner stands for it.

    The gaps between two crossings of one float are grey: there ``float_gap`` decides how the edges run.
    """
    yarn = _yarn(fabric, direction, number)
    swept = SweptYarn(fabric, yarn)
    path, sections = swept.trajectory, swept.sections

    heights: dict[str, list[np.ndarray]] = {"midline": [], "left edge": [], "right edge": []}
    along = []
    for piece, first, second in zip(path.pieces, sections, sections[1:]):
        x, z = sample(piece)
        share = (x - x[0]) / (x[-1] - x[0])
        blend = share**2 * (3 - 2 * share)
        along.append(x)
        heights["midline"].append(z)
        for name, end in (("left", 0), ("right", -1)):
            start, stop = (_edge_height(section, name, end) for section in (first, second))
            heights[f"{name} edge"].append(z + (1 - blend) * start + blend * stop)

    styles = {
        "midline": ("black", ":"),
        "left edge": (COLOURS[direction], "-"),
        "right edge": (COLOURS[direction], "--"),
    }
    for label, (colour, style) in styles.items():
        axes.plot(np.concatenate(along), np.concatenate(heights[label]), style, color=colour, label=label)
    _shade_float_gaps(fabric, axes, yarn)
    axes.set(
        xlabel="x mm" if direction == "weft" else "y mm",
        ylabel="z mm",
        title=f"edges of {direction} {number}, float gaps {fabric.float_gap}",
    )


def _edge_height(section: Section, name: str, end: int) -> float:
    """Height of a section's left or right edge above the midline, mm."""
    return float(section.strips.get(f"{name}_lower", section.strips["bottom"]).poles[end, 1])


def _shade_float_gaps(fabric: SolvedFabric, axes, yarn: Yarn) -> None:
    spacing = fabric.directions[yarn.direction].crossed_spacing
    half = (spacing - fabric.crossed(yarn.direction).width) / 2
    period = len(yarn.high) * spacing
    for number, same in enumerate((*yarn.floats_on, yarn.floats_on[0])):
        if same:
            middle = number * spacing
            axes.axvspan(max(0.0, middle - half), min(period, middle + half), color="0.85", linewidth=0)


def _on_axis(section: Section, side: str) -> float:
    """Height of a section's bottom or top above its yarn's axis."""
    v, z = section_outline(Section({side: section.strips[side]}), 201)
    order = np.argsort(v, kind="stable")
    return float(np.interp(0.0, v[order], z[order]))


def plot_model_cuts(fabric: SolvedFabric, axes, direction: str = "weft", number: int = 1, stretch: float = 3.0) -> None:
    """The same cut along a yarn's axis for every model of
    :data:`fabric_cad.comparison.models.MODELS`, one each on ``axes``.

    Penetrations are red, voids white; z is drawn ``stretch`` times larger.
    """
    for ax, model in zip(axes, MODELS):
        _model_cut(fabric, model, ax, direction, number)
        ax.set_title(model.title, loc="left", fontsize="medium")
        ax.margins(x=0)
        ax.set(aspect=stretch, ylabel="z mm")
    axes[-1].set_xlabel("x mm" if direction == "weft" else "y mm")


def _model_cut(fabric: SolvedFabric, model: Model, axes, direction: str, number: int) -> None:
    yarn, solved = _yarn(fabric, direction, number), fabric.directions[direction]
    along = np.linspace(0.0, len(yarn.high) * solved.crossed_spacing, 50 * len(yarn.high) + 1)
    bottom, top = (z[:, 0] for z in model.heights(fabric, yarn, along, np.zeros(1)))
    axes.fill_between(along, bottom, top, color=COLOURS[direction], alpha=0.6, linewidth=0)
    crossed_direction = DIRECTIONS[1 - DIRECTIONS.index(direction)]
    v = fabric.directions[crossed_direction].width * _ACROSS
    here = np.array([(yarn.index + 0.5) * fabric.directions[crossed_direction].crossed_spacing])
    for k, high in enumerate(yarn.high):
        place = (k + 0.5) * solved.crossed_spacing + v
        under, over = (z[0] for z in model.heights(fabric, _yarn(fabric, crossed_direction, k + 1), here, v))
        axes.fill_between(place, under, over, color=COLOURS[crossed_direction], alpha=0.9, linewidth=0)
        own_bottom, own_top = (z[:, 0] for z in model.heights(fabric, yarn, place, np.zeros(1)))
        low, above = (own_bottom, over) if high else (under, own_top)
        axes.fill_between(place, low, above, where=above > low + _UNSEEN, color=_PENETRATION, linewidth=0)


def plot_gap_maps(fabric: SolvedFabric, axes, weft: int = 1, warp: int = 1):
    """The gap over one crossing for every model of :data:`fabric_cad.comparison.models.MODELS`, one each on ``axes``.

    Penetrations are red, voids blue; a line goes around where the yarns touch. Returns the last
    map, for a colour bar; the colours end at a quarter of the thinner yarn's thickness.
    """
    yarns = _yarn(fabric, "weft", weft), _yarn(fabric, "warp", warp)
    v, u = (way.width * _ACROSS for way in (fabric.weft, fabric.warp))
    thinner = min(fabric.weft.thickness, fabric.warp.thickness)
    for ax, model in zip(axes, MODELS):
        gap = crossing_gap(fabric, model, *yarns, v, u).T
        gap[np.abs(gap) < _UNSEEN] = 0.0
        drawn = ax.pcolormesh(u, v, gap, cmap="RdBu", vmin=-thinner / 4, vmax=thinner / 4, shading="gouraud")
        touching = np.pad(np.abs(gap[1:-1, 1:-1]) <= TOLERANCE * thinner, 1)
        ax.contour(u, v, touching, levels=[0.5], colors="black", linewidths=0.8)
        ax.set(aspect="equal", xlabel="x from the centre, mm", ylabel="y from the centre, mm")
        ax.set_title(model.title, fontsize="medium")
        ax.label_outer()
    return drawn


def plot_tension_curves(columns: Mapping[str, Sequence[float]], axes=None):
    """Tension T11 of a weft against the strain E11 along it, a curve per ratio k = E22/E11 (Fig. 3); the figure.

    ``columns``, of equal length: ``k`` (NaN for points of a grid, which are not drawn unless they are
    of rest, where every curve starts; inf where E11 is 0), ``E11``, ``E22``, and ``T11``, ``T22`` in N
    a yarn. With k = inf T11 stands on a vertical line: T22 against E22 is drawn instead, dashed.
    """
    k, e11, e22, t11, t22 = (np.asarray(columns[name], dtype=float) for name in ("k", "E11", "E22", "T11", "T22"))
    figure, axes = _drawn_on(axes)
    ratios = np.unique(k[~np.isnan(k)])
    for ratio, colour in zip(ratios, _shades(len(ratios))):
        here, along = (k == ratio) | (np.isnan(k) & (e11 == 0) & (e22 == 0)), bool(np.isfinite(ratio))
        strain, tension = (e11[here], t11[here]) if along else (e22[here], t22[here])
        order = np.argsort(strain, kind="stable")
        label = f"k = {ratio:g}" if along else "k = \u221e, T22 against E22"
        axes.plot(
            100 * strain[order],
            tension[order],
            color=colour,
            linestyle="-" if along else "--",
            marker="o",
            markersize=3.5,
            label=label,
        )
    axes.set(xlabel="strain E11, %", ylabel="tension T11, N per yarn", title="constant ratios of strain k = E22/E11")
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    return figure


def plot_tension_surface(columns: Mapping[str, Sequence[float]], axes=None):
    """The tension surfaces T11 and T22 over (E11, E22) and the points computed, in 3D (Fig. 4, 22a); the figure.

    ``axes`` are two with the projection ``3d``. ``columns`` as for :func:`plot_tension_curves`,
    points of a grid included; ``k`` is not needed. The surfaces pass smoothly through all points and
    end at their convex hull. Raises ValueError where all points lie on one line.
    """
    figure, axes = _drawn_on(axes, (1, 2), (11, 5), projection="3d")
    at = 100 * np.column_stack([columns["E11"], columns["E22"]])
    _, first = np.unique(at.round(9), axis=0, return_index=True)
    at = at[first]
    if np.linalg.matrix_rank(at - at.mean(axis=0), tol=1e-9) < 2:
        raise ValueError("the strains of all points lie on one line: they span no surface")
    grid = np.meshgrid(*(np.linspace(low, high, _POINTS) for low, high in zip(at.min(axis=0), at.max(axis=0))))
    for ax, name, direction in zip(axes, ("T11", "T22"), DIRECTIONS):
        tension = np.asarray(columns[name], dtype=float)[first]
        surface = CloughTocher2DInterpolator(at, tension, rescale=True)(*grid)
        ax.plot_surface(*grid, surface, cmap="viridis", vmin=tension.min(), vmax=tension.max(), alpha=0.85, linewidth=0)
        ax.plot(*at.T, tension, linestyle="", marker="o", markersize=3, color="black", zorder=10)
        ax.set(xlabel="strain E11, %", ylabel="strain E22, %", title=f"tension of the {direction}")
        ax.set_zlabel(f"{name}, N per yarn")
        ax.locator_params(nbins=5)
        ax.view_init(elev=24, azim=-125)
    return figure


def plot_shear_curve(columns: Mapping[str, Sequence[float]], axes=None, allowed: float = 0.01):
    """Shear moment of a cell against the angle, and where contact ceases to be valid; the figure.

    ``columns``, of equal length: ``angle_deg`` ascending, ``moment_N_mm`` of a cell, ``force_N_per_mm``
    and ``penetration_mm``. The force is the moment over the cell's area: one curve, read off on the left
    as moment and on the right as force. Beyond the angle at which yarns penetrate by more than
    ``allowed`` mm the ground is grey. Raises ValueError where forces are in no fixed ratio to moments.
    """
    angle, moment, force, depth = (
        np.asarray(columns[name], dtype=float)
        for name in ("angle_deg", "moment_N_mm", "force_N_per_mm", "penetration_mm")
    )
    figure, axes = _drawn_on(axes)
    axes.plot(angle, moment, color="black", marker="o", markersize=3.5)
    axes.set(xlabel="shear angle, degrees", ylabel="moment of a cell, N mm", title="in-plane shear")
    axes.grid(alpha=0.3)

    if moment.any():
        ratio = (moment @ force) / (moment @ moment)
        if not np.allclose(force, ratio * moment, rtol=1e-6, atol=1e-9 * np.abs(force).max()):
            raise ValueError("force_N_per_mm is in no fixed ratio to moment_N_mm")
        right = axes.secondary_yaxis("right", functions=(lambda value: value * ratio, lambda value: value / ratio))
        right.set_ylabel("force along a side, N/mm")

    if (depth > allowed).any():
        valid = valid_until(angle, depth, allowed)
        label = f"penetration {allowed:g} mm, {valid:.1f}\u00b0"
        axes.axvline(valid, color=_PENETRATION, linewidth=1.2, label=label)
        axes.axvspan(valid, angle[-1], color="0.92", zorder=0)
        axes.legend(frameon=False, loc="upper left")
    return figure


def plot_crushing(cuts: Mapping[str, Sequence], scale: float, axes=None, stretch: float = 3.0):
    """Cuts of a cell under load, filled, over the cell at rest, dashed (Fig. 22c); the figure.

    ``cuts`` maps the yarn each runs along to its :class:`fabric_cad.pictures.Outline` list; an axes each.
    Displacements are drawn ``scale`` times and z ``stretch`` times larger, which the picture says.
    """
    shapes = [np.ptp(np.vstack([cut.rest for cut in outlines]), axis=0) for outlines in cuts.values()]
    heights = [9.0 * stretch * height / width for width, height in shapes]
    figure, axes = _drawn_on(axes, (len(cuts), 1), (10, 0.6 + sum(heights) + len(cuts)))
    for ax, (name, outlines) in zip(np.ravel(axes), cuts.items()):
        direction, number = name.rsplit("_", 1)
        for outline in outlines:
            moved = outline.rest + scale * (outline.deformed - outline.rest)
            ax.fill(*moved.T, color=colour_of(outline.yarn), alpha=0.75, linewidth=0)
            ax.plot(*outline.rest.T, color="black", linewidth=0.9, linestyle=(0, (4, 2)))
        ax.set(aspect=stretch, xlabel="x mm" if direction == "weft" else "y mm", ylabel="z mm")
        ax.set_title(f"along {direction} {number}", loc="left", fontsize="medium")
        ax.margins(x=0.01)
    drawn = f"dashed: at rest; filled: displacements \u00d7 {scale:g}; z is drawn {stretch:g} times larger"
    np.ravel(axes)[0].set_title(drawn, loc="right", fontsize="medium")
    return figure


def save_figure(figure, path: str | Path, title: str = "") -> None:
    """Write a figure as PNG (``path``) and, beside it, as PDF: the same bytes for the same figure.

    ``title`` stands above all its axes.
    """
    from matplotlib import rc_context

    if title:
        figure.suptitle(title)
    figure.savefig(path, dpi=150, metadata={"Software": None})
    with rc_context({"pdf.fonttype": 42}):  # fonts stay text, for who edits the picture
        figure.savefig(Path(path).with_suffix(".pdf"), metadata={"CreationDate": None})


def _drawn_on(axes, grid: tuple[int, int] = (1, 1), size: tuple[float, float] = (7, 4.5), **options):
    """The figure of the axes given, or a new one of a ``grid`` (down, across), and its axes."""
    if axes is None:
        from matplotlib.figure import Figure

        axes = Figure(size, layout="constrained").subplots(*grid, subplot_kw=options)
    return np.ravel(axes)[0].figure, axes


def _shades(count: int) -> list[tuple[float, ...]]:
    """Colours from dark to light, as many as there are curves."""
    from matplotlib import colormaps

    return [tuple(colour) for colour in colormaps["viridis"](np.linspace(0.0, 0.85, count))]


_MEASURES = (
    ("first_order", "first order", COLOURS["weft"]),
    ("total", "total", COLOURS["warp"]),
    ("elasticity", "elasticity", COLOURS["weft"]),
    ("spearman", "rank correlation", COLOURS["weft"]),
    ("figure_value", "value", COLOURS["weft"]),
)


def plot_sensitivity(rows: list[dict], axes) -> None:
    """Bars of one figure's sensitivities, as :func:`fabric_cad.study.sensitivity.sensitivities` gives them.

    A bar a factor and measure, 95 % intervals as lines where there are any.
    """
    drawn = [each for each in _MEASURES if any(each[0] in row for row in rows)]
    height = 0.8 / len(drawn)
    labels = [" ".join(str(row[key]) for key in ("factor", "value") if key in row) for row in rows]
    for number, (key, label, colour) in enumerate(drawn):
        places = [at + (number - (len(drawn) - 1) / 2) * height for at in range(len(rows))]
        values = [row.get(key, np.nan) for row in rows]
        axes.barh(places, values, height=0.9 * height, color=colour, label=label)
        for place, row in zip(places, rows):
            if f"{key}_low" in row:
                axes.plot([row[f"{key}_low"], row[f"{key}_high"]], [place, place], color="black", linewidth=1)
    axes.set_yticks(range(len(rows)), labels)
    axes.invert_yaxis()
    axes.axvline(0.0, color="grey", linewidth=0.8)
    if len(drawn) > 1:
        axes.legend(fontsize="small")
    else:
        axes.set_xlabel(drawn[0][1])
