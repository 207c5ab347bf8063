"""A study's sensitivities as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..pictures.plots import plot_sensitivity, save_figure

_ACROSS = 3  # figures side by side


def draw_sensitivities(name: str, design: str, rows: Sequence[dict], path: str | Path) -> None:
    """Draw the rows of :func:`fabric_cad.study.sensitivity.sensitivities`, one axes a figure, as PNG and PDF."""
    from matplotlib.figure import Figure

    figures = list(dict.fromkeys(row["figure"] for row in rows))
    across = min(_ACROSS, len(figures))
    down = -(-len(figures) // across)
    factors = len({row["factor"] for row in rows})
    picture = Figure(figsize=(4.5 * across, (1.2 + 0.45 * factors) * down), layout="constrained")
    axes = picture.subplots(down, across, squeeze=False).ravel()
    for ax, figure in zip(axes, figures):
        plot_sensitivity([row for row in rows if row["figure"] == figure], ax)
        ax.set_title(figure, fontsize="medium")

    for ax in axes[len(figures) :]:
        ax.remove()
    save_figure(picture, path, f"{name}: {design}")
