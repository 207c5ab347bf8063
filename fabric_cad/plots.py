"""Sections, trajectories and cuts of a solved fabric, as the paper's Fig. 15 to 18 draw them, and its models compared.

Each function draws on Matplotlib axes it is given; lengths mm.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from .colours import COLOURS
from .comparison import MODELS, TOLERANCE, Model, crossing_gap
from .sections import KINDS, Section, contact_section, free_section
from .solved import SolvedFabric, point_columns
from .splines import Spline
from .sweeps import control_planes, control_sections, trajectory
from .weaves import DIRECTIONS, Yarn, yarns_of

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
    planes = control_planes(fabric, yarn)
    path, sections = trajectory(fabric, yarn, planes), control_sections(fabric, yarn, planes)
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
        other = _yarn(fabric, crossed_direction, k + 1)
        other_planes = control_planes(fabric, other)
        at = next(n for n, plane in enumerate(other_planes) if plane.crossing == number - 1)
        v, z = section_outline(control_sections(fabric, other, other_planes)[at])
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


def _on_axis(section: Section, side: str) -> float:
    """Height of a section's bottom or top above its yarn's axis."""
    v, z = section_outline(Section({side: section.strips[side]}), 201)
    order = np.argsort(v, kind="stable")
    return float(np.interp(0.0, v[order], z[order]))


def plot_model_cuts(fabric: SolvedFabric, axes, direction: str = "weft", number: int = 1, stretch: float = 3.0) -> None:
    """The same cut along a yarn's axis for every model of :data:`fabric_cad.comparison.MODELS`, one each on ``axes``.

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
    """The gap over one crossing for every model of :data:`fabric_cad.comparison.MODELS`, one each on ``axes``.

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
