"""What a study's figures depend on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...weave.colours import COLOURS
from ...weave.directions import Direction

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MEASURES = (
    ("first_order", "first order", COLOURS[Direction.WEFT]),
    ("total", "total", COLOURS[Direction.WARP]),
    ("elasticity", "elasticity", COLOURS[Direction.WEFT]),
    ("spearman", "rank correlation", COLOURS[Direction.WEFT]),
    ("figure_value", "value", COLOURS[Direction.WEFT]),
)
"""Columns of sensitivities, what they are called and their colours."""


def plot_sensitivity(rows: Sequence[Mapping[str, Any]], axes: Axes) -> None:
    """Bars of one figure's sensitivities.

    ``rows`` are as :func:`fabric_cad.study.sensitivity.sensitivities` gives them. A bar a factor
    and measure, 95 % intervals as lines where there are any.
    """
    measures = [measure for measure in _MEASURES if any(measure[0] in row for row in rows)]
    height = 0.8 / len(measures)
    labels = [" ".join(str(row[key]) for key in ("factor", "value") if key in row) for row in rows]

    for number, (key, label, colour) in enumerate(measures):
        shift = (number - (len(measures) - 1) / 2) * height
        places = [line + shift for line in range(len(rows))]
        values = [row.get(key, np.nan) for row in rows]
        axes.barh(places, values, height=0.9 * height, color=colour, label=label)

        for place, row in zip(places, rows):
            if f"{key}_low" in row:
                interval = [row[f"{key}_low"], row[f"{key}_high"]]
                axes.plot(interval, [place, place], color="black", linewidth=1)

    axes.set_yticks(range(len(rows)), labels)
    axes.invert_yaxis()
    axes.axvline(0.0, color="grey", linewidth=0.8)
    if len(measures) > 1:
        axes.legend(fontsize="small")
    else:
        axes.set_xlabel(measures[0][1])
