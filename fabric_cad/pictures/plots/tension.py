"""Biaxial tension of a cell: curves of constant ratio, and surfaces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator

from ...weave.directions import DIRECTIONS
from .figures import drawn_on, shades
from .outlines import POINTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure
_DOTS = {"linestyle": "", "marker": "o", "markersize": 3, "color": "black", "zorder": 10}
_COLUMNS = ("k", "E11", "E22", "T11", "T22")


def plot_tension_curves(columns: Mapping[str, Sequence[float]], axes: Any = None) -> Figure:
    """Tension T11 of a weft over its strain E11, a curve per k = E22/E11 (Fig. 3); the figure.

    ``columns``, of equal length: ``k`` (NaN for points of a grid, which are not drawn unless they
    are of rest, where every curve starts; inf where E11 is 0), ``E11``, ``E22``, and ``T11``,
    ``T22`` in N a yarn. With k = inf T11 stands on a vertical line: T22 against E22 is drawn
    instead, dashed.
    """
    k, e11, e22, t11, t22 = (np.asarray(columns[name], dtype=float) for name in _COLUMNS)
    figure, axes = drawn_on(axes)
    at_rest = np.isnan(k) & (e11 == 0) & (e22 == 0)

    ratios = np.unique(k[~np.isnan(k)])
    for ratio, colour in zip(ratios, shades(len(ratios))):
        on_curve, finite = (k == ratio) | at_rest, bool(np.isfinite(ratio))
        strain, tension = (e11, t11) if finite else (e22, t22)
        strain, tension = strain[on_curve], tension[on_curve]
        order = np.argsort(strain, kind="stable")
        axes.plot(
            100 * strain[order],
            tension[order],
            color=colour,
            linestyle="-" if finite else "--",
            marker="o",
            markersize=3.5,
            label=f"k = {ratio:g}" if finite else "k = \u221e, T22 against E22",
        )

    axes.set(
        xlabel="strain E11, %",
        ylabel="tension T11, N per yarn",
        title="constant ratios of strain k = E22/E11",
    )
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)

    return figure


def plot_tension_surface(columns: Mapping[str, Sequence[float]], axes: Any = None) -> Figure:
    """The tension surfaces T11 and T22 over (E11, E22) and the points computed, in 3D; the figure.

    (Fig. 4, 22a.) ``axes`` are two with the projection ``3d``. ``columns`` as for
    :func:`plot_tension_curves`, points of a grid included; ``k`` is not needed. The surfaces pass
    smoothly through all points and end at their convex hull. Raises ValueError where all points lie
    on one line.
    """
    figure, axes = drawn_on(axes, (1, 2), (11, 5), projection="3d")

    strains = 100 * np.column_stack([columns["E11"], columns["E22"]])
    _, first = np.unique(strains.round(9), axis=0, return_index=True)
    strains = strains[first]
    if np.linalg.matrix_rank(strains - strains.mean(axis=0), tol=1e-9) < 2:
        raise ValueError("the strains of all points lie on one line: they span no surface")

    ends = zip(strains.min(axis=0), strains.max(axis=0))
    grid = np.meshgrid(*(np.linspace(low, high, POINTS) for low, high in ends))
    for ax, name, direction in zip(axes, ("T11", "T22"), DIRECTIONS):
        tension = np.asarray(columns[name], dtype=float)[first]
        surface = CloughTocher2DInterpolator(strains, tension, rescale=True)(*grid)
        ax.plot_surface(
            *grid,
            surface,
            cmap="viridis",
            vmin=tension.min(),
            vmax=tension.max(),
            alpha=0.85,
            linewidth=0,
        )
        ax.plot(*strains.T, tension, **_DOTS)

        ax.set(xlabel="strain E11, %", ylabel="strain E22, %", title=f"tension of the {direction}")
        ax.set_zlabel(f"{name}, N per yarn")
        ax.locator_params(nbins=5)
        ax.view_init(elev=24, azim=-125)

    return figure
