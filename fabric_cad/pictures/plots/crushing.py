"""Sections of a cell's yarns crushed under load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...weave.colours import colour_of
from ..cuts import Outline
from .figures import drawn_on
from .outlines import along_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DASHED = (0, (4, 2))


def plot_crushing(
    cuts: Mapping[str, Sequence[Outline]], scale: float, axes: Any = None, stretch: float = 3.0
) -> Figure:
    """Cuts of a cell under load, filled, over the cell at rest, dashed (Fig. 22c); the figure.

    ``cuts`` maps the yarn each runs along to its :class:`fabric_cad.pictures.Outline` list; an
    axes each. Displacements are drawn ``scale`` times and z ``stretch`` times larger, which the
    picture says.
    """
    figure, axes = drawn_on(axes, (len(cuts), 1), _size(cuts, stretch))
    for ax, (name, outlines) in zip(np.ravel(axes), cuts.items()):
        direction, number = name.rsplit("_", 1)
        for outline in outlines:
            moved = outline.rest + scale * (outline.deformed - outline.rest)
            ax.fill(*moved.T, color=colour_of(outline.yarn), alpha=0.75, linewidth=0)
            ax.plot(*outline.rest.T, color="black", linewidth=0.9, linestyle=_DASHED)

        ax.set(aspect=stretch, xlabel=along_label(direction), ylabel="z mm")
        ax.set_title(f"along {direction} {number}", loc="left", fontsize="medium")
        ax.margins(x=0.01)

    enlarged = f"displacements \u00d7 {scale:g}; z is drawn {stretch:g} times larger"
    title = f"dashed: at rest; filled: {enlarged}"
    np.ravel(axes)[0].set_title(title, loc="right", fontsize="medium")
    return figure


def _size(cuts: Mapping[str, Sequence[Outline]], stretch: float) -> tuple[float, float]:
    """Inches across and down of a figure that holds the cuts one above the other."""
    heights = []
    for outlines in cuts.values():
        width, height = np.ptp(np.vstack([outline.rest for outline in outlines]), axis=0)
        heights.append(9.0 * stretch * height / width)

    return 10, 0.6 + sum(heights) + len(cuts)
