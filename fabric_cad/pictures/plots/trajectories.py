"""A yarn's midline with its control points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...model.solved import SolvedFabric, point_columns
from ...weave.colours import COLOURS
from ...weave.directions import Direction
from .outlines import POINTS, along_label

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_trajectory(fabric: SolvedFabric, axes: Axes, direction: str = "weft") -> None:
    """Half a period of a midline with its control points M1 ... M6 (Fig. 16)."""
    colour = COLOURS[Direction(direction)]
    solved = fabric.directions[direction]
    points = np.array(solved.points)
    first_plateau, straight, last_plateau = points[:2], points[2:4], points[4:]

    axes.plot(*first_plateau.T, color=colour)
    axes.plot(*last_plateau.T, color=colour)

    # parabolas (1), from M2 to M3, and (2), from M4 to M5
    (_, _), (x2, z2), (x3, _), (x4, _), (x5, z5), _ = points
    sign = np.sign(z5 - z2)
    low_first = sign > 0
    p_first = solved.p_low if low_first else solved.p_high
    p_last = solved.p_high if low_first else solved.p_low

    for start, end, (vertex, level), p in (
        (x2, x3, (x2, z2), sign * p_first),
        (x4, x5, (x5, z5), -sign * p_last),
    ):
        places = np.linspace(start, end, POINTS)
        axes.plot(places, level + p * (places - vertex) ** 2, color="black")

    axes.plot(*straight.T, color=colour, linestyle="--")

    axes.plot(*points.T, "o", color="black", markersize=4)
    for (name, *_), point in zip(point_columns(direction), points):
        axes.annotate(name, point, xytext=(0, 6), textcoords="offset points", ha="center")

    axes.margins(y=0.2)
    axes.set(
        xlabel=along_label(direction),
        ylabel="z mm",
        title=f"trajectory of the {direction}",
    )
