"""The models of a fabric side by side: cuts along a yarn, gaps over a crossing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...comparison.crossings import facing
from ...comparison.measures import TOLERANCE
from ...comparison.models import MODELS, Model
from ...model.solved import SolvedFabric
from ...weave.colours import COLOURS
from .figures import PENETRATION
from .outlines import along_label, yarn_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ACROSS = np.sin(np.linspace(-np.pi / 2, np.pi / 2, 301)) / 2
"""Places across a yarn as shares of its width, closer towards the edges."""

_UNSEEN = 1e-9
"""mm, less than any picture shows."""


def plot_model_cuts(
    fabric: SolvedFabric,
    axes: Sequence[Axes],
    direction: str = "weft",
    number: int = 1,
    stretch: float = 3.0,
) -> None:
    """The same cut along a yarn's axis for every model, one each on ``axes``.

    The models are :data:`fabric_cad.comparison.models.MODELS`.
    Penetrations are red, voids white; z is drawn ``stretch`` times larger.
    """
    for ax, model in zip(axes, MODELS):
        _model_cut(fabric, model, ax, direction, number)
        ax.set_title(model.title, loc="left", fontsize="medium")
        ax.margins(x=0)
        ax.set(aspect=stretch, ylabel="z mm")

    axes[-1].set_xlabel(along_label(direction))


def _model_cut(fabric: SolvedFabric, model: Model, axes: Axes, direction: str, number: int) -> None:
    yarn, axis = yarn_of(fabric, direction, number), np.zeros(1)
    solved, crossed = fabric.directions[yarn.direction], fabric.crossed(yarn.direction)
    crossed_colour = COLOURS[yarn.direction.other]

    along = np.linspace(0.0, len(yarn.high) * solved.crossed_spacing, 50 * len(yarn.high) + 1)
    bottom, top = (z[:, 0] for z in model.heights(fabric, yarn, along, axis))
    axes.fill_between(along, bottom, top, color=COLOURS[yarn.direction], alpha=0.6, linewidth=0)

    across = crossed.width * _ACROSS
    here = np.array([(yarn.index + 0.5) * crossed.crossed_spacing])
    for crossing, high in enumerate(yarn.high):
        places = (crossing + 0.5) * solved.crossed_spacing + across
        other = yarn_of(fabric, yarn.direction.other, crossing + 1)
        other_bottom, other_top = (z[0] for z in model.heights(fabric, other, here, across))
        axes.fill_between(
            places,
            other_bottom,
            other_top,
            color=crossed_colour,
            alpha=0.9,
            linewidth=0,
        )

        own_bottom, own_top = (z[:, 0] for z in model.heights(fabric, yarn, places, axis))
        low, above = (own_bottom, other_top) if high else (other_bottom, own_top)
        inside = above > low + _UNSEEN
        axes.fill_between(places, low, above, where=inside, color=PENETRATION, linewidth=0)


def plot_gap_maps(fabric: SolvedFabric, axes: Sequence[Axes], weft: int = 1, warp: int = 1):
    """The gap over one crossing for every model, one each on ``axes``.

    The models are :data:`fabric_cad.comparison.models.MODELS`.
    Penetrations are red, voids blue; a line goes around where the yarns touch. Returns the last
    map, for a colour bar; the colours end at a quarter of the thinner yarn's thickness.
    """
    yarns = yarn_of(fabric, "weft", weft), yarn_of(fabric, "warp", warp)
    v_weft, v_warp = (way.width * _ACROSS for way in (fabric.weft, fabric.warp))
    thinner = min(fabric.weft.thickness, fabric.warp.thickness)

    for ax, model in zip(axes, MODELS):
        gap = facing(fabric, model, yarns, v_weft, v_warp).gap.T
        gap[np.abs(gap) < _UNSEEN] = 0.0
        drawn = ax.pcolormesh(
            v_warp,
            v_weft,
            gap,
            cmap="RdBu",
            vmin=-thinner / 4,
            vmax=thinner / 4,
            shading="gouraud",
        )

        touching = np.pad(np.abs(gap[1:-1, 1:-1]) <= TOLERANCE * thinner, 1)
        ax.contour(v_warp, v_weft, touching, levels=[0.5], colors="black", linewidths=0.8)

        ax.set(aspect="equal", xlabel="x from the centre, mm", ylabel="y from the centre, mm")
        ax.set_title(model.title, fontsize="medium")
        ax.label_outer()

    return drawn
