"""Where two yarns cross, the upper one's bottom and the lower one's top become one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..model.solved import SolvedFabric
from ..support.errors import InputError, Problem
from ..weave.directions import Direction
from .grid import Lines
from .yarns import Strip, of_direction

MOST_CLOSED = 0.02
"""Share of a yarn's thickness up to which two yarns are moved together where their chord is below their width."""


@dataclass(frozen=True, eq=False)
class Closed:
    """What closing the crossings does.

    ``stands_for`` (nodes,) is the node that every node has become, ``crossing`` (nodes,) the number
    of the crossing whose contact it lies in, -1 in none; ``wedge`` the largest distance closed, mm.
    """

    stands_for: np.ndarray
    crossing: np.ndarray
    wedge: float

    def renumber(self, strip: Strip) -> Strip:
        """A yarn's skin in the nodes that there are now."""
        faces = {
            name: self.stands_for[getattr(strip, name)]
            for name in ("bottom", "top", "left", "right")
        }
        return replace(strip, **faces)


def close_crossings(
    points: np.ndarray,
    strips: Sequence[Strip],
    fabric: SolvedFabric,
    axes: tuple[Lines, Lines],
    bonded: bool,
) -> Closed:
    """Move facing nodes of crossing yarns to their middle, in place; let them be one, if ``bonded``, or on the rim.

    Contact is exact on the chords; where a chord is below the width a wedge opens beyond it, of
    micrometres, which hexahedra cannot fill: a patch of them would have a corner of 180 degrees.
    Raises :class:`InputError` where one is above :data:`MOST_CLOSED` of the thinner yarn's
    thickness.
    """
    x, y = axes
    stands_for, number = np.arange(len(points)), np.full(len(points), -1)
    wefts, warps = of_direction(strips, Direction.WEFT), of_direction(strips, Direction.WARP)
    rim = np.ones((x.columns + 1, y.columns + 1), dtype=bool)
    if not bonded:
        rim[1:-1, 1:-1] = False

    wedge = 0.0
    for i, weft in enumerate(wefts):
        for j, warp in enumerate(warps):
            over = weft.high[j]
            ours = (weft.bottom if over else weft.top)[x.own(j)]
            theirs = (warp.top if over else warp.bottom)[y.own(i)].T
            apart = np.linalg.norm(points[ours] - points[theirs], axis=-1).max()
            wedge = max(wedge, float(apart))

            points[ours] = points[theirs] = (points[ours] + points[theirs]) / 2
            number[ours] = number[theirs] = i * len(warps) + j
            stands_for[ours[rim]] = theirs[rim]

    _check(wedge, fabric)

    return Closed(stands_for, number, wedge)


def _check(wedge: float, fabric: SolvedFabric) -> None:
    thickness = min(fabric.weft.thickness, fabric.warp.thickness)
    if wedge > MOST_CLOSED * thickness:
        message = (
            f"the yarns stand {wedge:.3g} mm apart at their edges, beyond the contact chord, "
            f"{100 * wedge / thickness:.2g} % of a yarn's thickness; the matrix closes at most {100 * MOST_CLOSED:g} %"
        )
        raise InputError(Problem(message, row=fabric.name))
