"""A cut as a drawing (SVG): the yarns filled in their colours, midlines, control points, and sizes to read off."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.colours import COLOURS
from ..weave.weaves import yarns_of
from ..yarn.planes import control_planes
from .cuts import Cut, CutYarn

_MARGIN = 0.02  # of the length, around the drawing


def cut_drawing(fabric: SolvedFabric, cut: Cut, stretch: float = 2.0) -> str:
    """The SVG of a cut; heights are drawn ``stretch`` times larger, which its caption says."""
    heights = np.concatenate([stretch * yarn.outline[:, 1] for yarn in cut.yarns])
    margin = _MARGIN * cut.length
    width, height = cut.length + 2 * margin, np.ptp(heights) + 2 * margin
    box = f"{-margin:.5g} {-heights.max() - margin:.5g} {width:.5g} {height:.5g}"

    shapes = [_yarn(yarn, stretch, cut.length) for yarn in cut.yarns]
    shapes += [
        _control_points(fabric, yarn, stretch, cut.length)
        for yarn in cut.yarns
        if len(yarn.midline) > 1
    ]
    label = f"cut along the {cut.direction}s at {'yx'[cut.direction.axis]} = {cut.place:.4g} mm"

    return (
        f'<svg class="cut" viewBox="{box}" role="img" aria-label="{escape(label)}" '
        f'preserveAspectRatio="xMidYMid meet" xmlns="http://www.w3.org/2000/svg">{"".join(shapes)}</svg>'
    )


def cut_caption(fabric: SolvedFabric, cut: Cut, stretch: float = 2.0) -> str:
    """The sizes to read off beside a cut."""
    own, crossed = fabric.directions[cut.direction], fabric.crossed(cut.direction)
    gap = own.crossed_spacing - crossed.width
    sizes = [
        f"{'yx'[cut.direction.axis]} = {cut.place:.4g} mm, heights \u00d7 {stretch:g}",
        f"{cut.direction}: thickness {own.thickness:.4g} mm, amplitude {own.amplitude:.4g} mm",
        f"{cut.direction.other}: width {crossed.width:.4g} mm, thickness {crossed.thickness:.4g} mm, gap {gap:.4g} mm",
        f"fabric: {fabric.fabric_thickness:.4g} mm",
    ]
    return "; ".join(sizes)


def _yarn(yarn: CutYarn, stretch: float, length: float) -> str:
    colour = _colour(COLOURS[yarn.body.direction])
    name = yarn.body.name.replace("_", " ")
    fill = f'<path d="{_path(yarn.outline, stretch)}Z" fill="{colour}"><title>{escape(name)}</title></path>'
    if len(yarn.midline) == 1:
        return fill
    dashes = f"{length / 150:.3g}"
    line = (
        f'fill="none" stroke="#222" stroke-width="{length / 900:.3g}" stroke-dasharray="{dashes}"'
    )
    return fill + f'<path d="{_path(yarn.midline, stretch)}" {line}/>'


def _control_points(fabric: SolvedFabric, yarn: CutYarn, stretch: float, length: float) -> str:
    """Where the control planes stand on a midline."""
    bodies = {each.body: each for each in yarns_of(fabric.weave.interlacement())}
    places = [plane.place for plane in control_planes(fabric, bodies[yarn.body])]
    heights = np.interp(places, *yarn.midline.T)
    return "".join(
        f'<circle cx="{t:.5g}" cy="{-stretch * z:.5g}" r="{length / 400:.3g}" fill="#222">'
        f"<title>control plane at {t:.4g} mm, z {z:.4g} mm</title></circle>"
        for t, z in zip(places, heights)
    )


def _path(points: Iterable[np.ndarray], stretch: float) -> str:
    return "M" + "L".join(f"{x:.5g} {-stretch * z:.5g}" for x, z in points)


def _colour(colour: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)
