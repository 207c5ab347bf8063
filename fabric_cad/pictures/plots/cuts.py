"""Cuts along one yarn: its own profile, the sections it crosses, its edges."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...model.solved import SolvedFabric
from ...section.strips import Section
from ...weave.colours import COLOURS
from ...weave.directions import Direction
from ...weave.weaves import Yarn
from ...yarn.swept import SweptYarn
from .outlines import along_label, sample, section_outline, yarn_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_cut(fabric: SolvedFabric, axes: Axes, direction: str = "weft", number: int = 1) -> None:
    """A cut through the cell along a yarn's axis, with the sections it crosses (Fig. 15, 18)."""
    yarn = yarn_of(fabric, direction, number)
    swept = SweptYarn(fabric, yarn)

    along, bottom = _profile(swept, lambda section: _on_axis(section, "bottom"))
    _, top = _profile(swept, lambda section: _on_axis(section, "top"))
    axes.fill_between(along, bottom, top, color=COLOURS[yarn.direction], alpha=0.6)

    spacing = fabric.directions[yarn.direction].crossed_spacing
    for crossing, high in enumerate(yarn.high):
        v, z = _crossed_section(fabric, yarn, crossing)
        crossed = fabric.crossed(yarn.direction)
        level = crossed.z_low if high else crossed.z_high
        colour = COLOURS[yarn.direction.other]
        axes.fill((crossing + 0.5) * spacing + v, level + z, color=colour, alpha=0.9)

    axes.set(
        xlabel=along_label(direction),
        ylabel="z mm",
        title=f"cut along {direction} {number}",
        aspect="equal",
    )


def plot_edges(fabric: SolvedFabric, axes: Axes, direction: str = "weft", number: int = 1) -> None:
    """Heights of a yarn's two edges along it, over its midline.

    A flat side's lower corner stands for it. The gaps between two crossings of one float are grey:
    there ``float_gap`` decides how the edges run.
    """
    yarn = yarn_of(fabric, direction, number)
    swept = SweptYarn(fabric, yarn)
    colour = COLOURS[Direction(direction)]

    along, midline = _profile(swept, lambda _: 0.0)
    axes.plot(along, midline, ":", color="black", label="midline")
    for edge, end, style in (("left", 0, "-"), ("right", -1, "--")):
        _, heights = _profile(swept, partial(_edge_height, edge=edge, end=end))
        axes.plot(along, heights, style, color=colour, label=f"{edge} edge")

    _shade_float_gaps(fabric, axes, yarn)
    axes.set(
        xlabel=along_label(direction),
        ylabel="z mm",
        title=f"edges of {direction} {number}, float gaps {fabric.float_gap}",
    )


def _profile(swept: SweptYarn, height: Callable[[Section], float]) -> tuple[np.ndarray, np.ndarray]:
    """Places along a yarn, and the heights there of what is ``height`` above its midline, mm.

    Between two control planes it follows the smoothstep by which the skin blends their sections.
    """
    places, heights = [], []
    sections = swept.sections

    for piece, first, second in zip(swept.trajectory.pieces, sections, sections[1:]):
        along, midline = sample(piece)
        share = (along - along[0]) / (along[-1] - along[0])
        blend = share**2 * (3 - 2 * share)

        places.append(along)
        heights.append(midline + (1 - blend) * height(first) + blend * height(second))

    return np.concatenate(places), np.concatenate(heights)


def _on_axis(section: Section, side: str) -> float:
    """Height of a section's bottom or top above its yarn's axis."""
    v, z = section_outline(Section({side: section.strips[side]}), 201)
    order = np.argsort(v, kind="stable")
    return float(np.interp(0.0, v[order], z[order]))


def _edge_height(section: Section, edge: str, end: int) -> float:
    """Height of a section's left or right edge above the midline, mm."""
    return float(section.strips.get(f"{edge}_lower", section.strips["bottom"]).poles[end, 1])


def _crossed_section(
    fabric: SolvedFabric,
    yarn: Yarn,
    crossing: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Outline (v, z), mm, of the section that the yarn crossed there has over this yarn's axis."""
    crossed = SweptYarn(fabric, yarn_of(fabric, yarn.direction.other, crossing + 1))
    crossings = [plane.crossing for plane in crossed.planes]
    return section_outline(crossed.sections[crossings.index(yarn.index)])


def _shade_float_gaps(fabric: SolvedFabric, axes: Axes, yarn: Yarn) -> None:
    spacing = fabric.directions[yarn.direction].crossed_spacing
    half = (spacing - fabric.crossed(yarn.direction).width) / 2
    period = len(yarn.high) * spacing

    for number, floats_on in enumerate((*yarn.floats_on, yarn.floats_on[0])):
        if floats_on:
            middle = number * spacing
            start, end = max(0.0, middle - half), min(period, middle + half)
            axes.axvspan(start, end, color="0.85", linewidth=0)
