"""What a row's numbers say that a person should look at, and what no yarn can do.

Sections stand in vertical planes (paper, section 4): along a slope s a yarn keeps its vertical
thickness b, so that across its own axis, which is tilted by atan(s), its section shrinks by
cos(atan s) = 1 / sqrt(1 + s^2)::

        ______        on the plateau the section is b high,
       /  /           on the slope still b high along z,
      /  / b          but b / sqrt(1 + s^2) thick across the yarn
    _/__/

Its fibres do not shrink: the share of the section they fill grows by sqrt(1 + s^2). Parallel round
fibres fill pi / sqrt(12) = 0.907 at most (hexagonal packing). A yarn that holds no less than
:data:`SLACKEST` of fibres on its plateaux is packed solid at the slope

    LARGEST_SLOPE = sqrt((pi / sqrt(12) / SLACKEST)^2 - 1) = 2.85, 70.7 degrees

beyond which a row is refused. That 0.3 is an assumption, on the lenient side: it is what loose
staple and textured yarns have; a roving of 0.6 would be solid at a slope of 1.13.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi, sqrt

import numpy as np

from ..measured.tables import Family
from ..support.errors import Problem
from ..weave.directions import DIRECTIONS

DENSEST = pi / sqrt(12)
"""Largest share of a section that parallel round fibres fill."""

SLACKEST = 0.3
"""Least share of a yarn's section that its fibres are taken to fill where it is not squeezed."""

LARGEST_SLOPE = sqrt((DENSEST / SLACKEST) ** 2 - 1)
"""Slope above which a row is refused: there a yarn of the slackest packing would be solid."""

LARGE_CRIMP, LARGE_SLOPE = 0.1, 1.0
"""Crimp and slope above which a row gets a warning."""

LEAST_JACOBIAN, LOW_JACOBIAN = 1e-4, 0.02
"""Scaled Jacobians up to which a mesh is not delivered, and below which it gets a warning.

At 1e-4 a corner is flat to 0.006 degrees: less than what a solver's own displacements and single
precision leave of it.
"""


def responsible(direction: str, identified_by: Sequence[str]) -> str:
    """The column that gave a direction its slope: its crimp, else the last of those that identify the row."""
    crimp = f"{direction}_crimp"
    return crimp if crimp in identified_by else identified_by[-1]


def too_steep(direction: str, slope: float, column: str) -> str:
    """Why no yarn has this slope, which is above :data:`LARGEST_SLOPE`."""
    return (
        f"gives the {direction} a slope of {slope:.3g}, above {LARGEST_SLOPE:.3g}, which no yarn has: on it the yarn "
        f"is squeezed to {100 / sqrt(1 + slope**2):.2g} % of its thickness, tighter than fibres pack"
        + _unit(column)
    )


def _unit(column: str) -> str:
    """What may be behind a crimp that is too large."""
    return (
        f" (crimp is a ratio; {column}_percent takes per cent)" if column.endswith("_crimp") else ""
    )


def implausible(table: Family, columns: Mapping[str, Sequence]) -> list[Problem]:
    """A warning for each direction of a row with a crimp above 10 % or a slope above 1.

    ``columns`` are those of the solved table of the same rows. The warp of a balanced row is told
    of only where its weft, of which it has the measurements, is not.
    """
    told: list[Problem] = []
    balanced, warned = table.balanced, np.zeros(len(table), dtype=bool)

    for d in DIRECTIONS:
        crimps, slopes = (
            np.asarray(columns[f"{d}_{name}"], dtype=float) for name in ("crimp", "slope")
        )
        large = ((crimps > LARGE_CRIMP) | (slopes > LARGE_SLOPE)) & ~(balanced & warned)
        for row in np.flatnonzero(large).tolist():
            column = responsible(d, columns["identified_by"][row].split())
            told.append(table.problem(row, column, _steep(d, crimps[row], slopes[row], column)))

        warned |= large

    return sorted(told, key=lambda problem: problem.line or 0)


def _steep(direction: str, crimp: float, slope: float, column: str) -> str:
    squeezed = 100 / sqrt(1 + slope**2)
    return (
        f"the {direction} has a crimp of {100 * crimp:.3g} % and a slope of {slope:.3g}, and yarns are seldom "
        f"beyond {100 * LARGE_CRIMP:g} % or {LARGE_SLOPE:g}; on the slope it is squeezed to {squeezed:.2g} % "
        "of its thickness" + _unit(column)
    )


def overfull_yarns(row: str, fibre_fractions: Mapping[str, float]) -> list[str]:
    """Sentences on yarns of a row, by direction, whose fibres do not fit in; a NaN is not known."""
    told = []
    for direction, share in fibre_fractions.items():
        if share > DENSEST:
            full = f"fibres fill {100 * share:.0f} % of the yarn's volume"
            message = f"{full}, above {100 * DENSEST:.0f} %, the densest packing"
            told.append(str(Problem(message, column=f"{direction}_linear_density_tex", row=row)))
    return told
