"""Figures: made where none is given, coloured, and saved."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PENETRATION = "#d1001f"
"""The colour of what penetrates."""


def save_figure(figure: Figure, path: str | Path, title: str = "") -> None:
    """Write a figure as PNG (``path``) and, beside it, as PDF: the same bytes for the same figure.

    ``title`` stands above all its axes.
    """
    from matplotlib import rc_context

    if title:
        figure.suptitle(title)
    figure.savefig(path, dpi=150, metadata={"Software": None})
    with rc_context({"pdf.fonttype": 42}):  # fonts stay text, for who edits the picture
        figure.savefig(Path(path).with_suffix(".pdf"), metadata={"CreationDate": None})


def drawn_on(
    axes: Any,
    grid: tuple[int, int] = (1, 1),
    size: tuple[float, float] = (7, 4.5),
    **options: Any,
) -> tuple[Figure, Any]:
    """The figure of the axes given, or a new one of a ``grid`` (down, across), and its axes.

    ``size`` in inches; ``options`` make the new axes.
    """
    if axes is None:
        from matplotlib.figure import Figure

        axes = Figure(size, layout="constrained").subplots(*grid, subplot_kw=options)
    return np.ravel(axes)[0].figure, axes


def shades(count: int) -> list[tuple[float, ...]]:
    """Colours from dark to light, as many as there are curves."""
    from matplotlib import colormaps

    return [tuple(colour) for colour in colormaps["viridis"](np.linspace(0.0, 0.85, count))]
