"""A fabric on one page of A4, as PDF: what it is, its figures, its row, its cuts and its weave."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .. import __version__
from ..cell.traces import renew_digests
from ..measured.columns import NUMBERS
from ..pictures.plots import plot_cut
from ..support.staging import staged
from ..weave.colours import COLOURS
from ..weave.directions import DIRECTIONS, Direction
from .document import kind_of
from .edited import Solution
from .figures import comparisons, expected_quality, figures, warnings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_A4 = (210 / 25.4, 297 / 25.4)
_ROWS = 24  # of a table that fit


def write_datasheet(solution: Solution, folder: Path) -> None:
    """Write ``datasheet.pdf`` into a row's folder: the same bytes for the same fabric."""
    from matplotlib import rc_context

    with staged(folder, renew_digests) as aside, rc_context({"pdf.fonttype": 42}):
        datasheet(solution).savefig(aside / "datasheet.pdf", metadata={"CreationDate": None})


def datasheet(solution: Solution) -> Figure:
    """The page as a Matplotlib figure."""
    from matplotlib.figure import Figure

    fabric = solution.fabric
    figure = Figure(_A4)
    figure.text(0.08, 0.955, fabric.name, fontsize=18, weight="bold")
    figure.text(0.08, 0.935, kind_of(solution), fontsize=10, color="0.35")

    for number, direction in enumerate(DIRECTIONS):
        axes = figure.add_axes((0.08, 0.78 - 0.16 * number, 0.84, 0.12))
        plot_cut(fabric, axes, direction, 1)
        axes.set(aspect="auto")
        axes.tick_params(labelsize=7)
        axes.set_title(f"cut along {direction} 1, heights not to scale", fontsize=9, loc="left")

    _draw_weave(solution, figure.add_axes((0.08, 0.36, 0.30, 0.20)))
    known = [(each.label, each.text) for each in (*figures(solution), expected_quality(solution))]
    _table(figure.add_axes((0.45, 0.30, 0.47, 0.28)), "Figures of the model", known)

    units = {
        column: NUMBERS[column].unit if column in NUMBERS else "" for column in solution.row.cells
    }
    measured = [
        (f"{column}{' *' * (column in solution.identified_by)}", f"{text:.60} {units[column]}")
        for column, text in solution.row.cells.items()
        if column not in ("name", "notes")
    ]
    _table(figure.add_axes((0.08, 0.08, 0.84, 0.20)), "As measured (* identifies)", measured)

    told = [
        f"{name}: measured {one:.4g}, model {two:.4g}" for name, one, two in comparisons(solution)
    ]
    figure.text(
        0.08, 0.05, "\n".join([*told, *warnings(solution)])[:400], fontsize=7, va="top", wrap=True
    )
    figure.text(0.92, 0.02, f"fabric-cad {__version__}", fontsize=7, color="0.35", ha="right")

    return figure


def _draw_weave(solution: Solution, axes: Axes) -> None:
    """The cell's interlacement from above: weft 1 at the bottom."""
    from matplotlib.colors import ListedColormap

    matrix = solution.fabric.weave.interlacement()
    colours = ListedColormap([COLOURS[Direction.WARP], COLOURS[Direction.WEFT]])
    axes.pcolormesh(
        matrix.astype(float), cmap=colours, vmin=0, vmax=1, edgecolors="white", linewidth=1
    )
    axes.set(
        aspect="equal",
        xticks=np.arange(matrix.shape[1]) + 0.5,
        yticks=np.arange(matrix.shape[0]) + 0.5,
    )
    axes.set_xticklabels([str(k + 1) for k in range(matrix.shape[1])], fontsize=6)
    axes.set_yticklabels([str(k + 1) for k in range(matrix.shape[0])], fontsize=6)
    axes.set_title("on top: weft orange, warp blue", fontsize=9, loc="left")


def _table(axes: Axes, title: str, lines: list[tuple[str, str]]) -> None:
    axes.axis("off")
    axes.set_title(title, fontsize=9, loc="left", weight="bold")
    height = 1 / max(len(lines[:_ROWS]), 10)
    for number, (label, text) in enumerate(lines[:_ROWS]):
        down = 1 - (number + 0.7) * height
        axes.text(0.0, down, label, fontsize=7.5, transform=axes.transAxes)
        axes.text(1.0, down, text, fontsize=7.5, ha="right", transform=axes.transAxes)
