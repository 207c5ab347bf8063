"""The plan grid of a cell: x-line i is station i of every weft, y-line j station j of every warp.

Along x, warp by warp (along y, weft by weft)::

    cell's side, mid-gap                                              mid-gap
       |---|---|---+---+===+===+===+===+---+---|---|---|---|---+---+===
        half a gap  side  the yarn's columns  side  a gap

``side`` are the lines over the arcs of a round section; other sections have none. Lines are counted
on a torus: line 0 is the cell's side x = 0, and x = X as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..meshing.plan import Plan
from ..support.errors import InputError, Problem


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines across one axis: their ``places`` (lines + 1,), mm, and what lies between them.

    ``yarns`` yarns stand side by side, each with ``columns`` columns of its own, ``side`` lines of
    its lateral zone on either side, and ``gap`` from there to the next yarn's.
    """

    places: np.ndarray
    yarns: int
    columns: int
    side: int
    gap: int

    @property
    def count(self) -> int:
        """Lines on the torus."""
        return len(self.places) - 1

    @property
    def between(self) -> int:
        """Columns of the grid from one yarn's own to the next's."""
        return self.gap + 2 * self.side

    def first(self, yarn: int) -> int:
        """The line on which a yarn's own columns begin."""
        return yarn * (self.columns + self.between) + self.gap // 2 + self.side

    def own(self, yarn: int) -> np.ndarray:
        """The lines of a yarn's own columns, both ends included."""
        return self.first(yarn) + np.arange(self.columns + 1)

    def outwards(self, yarn: int, right: bool, count: int) -> np.ndarray:
        """The line in which a yarn's columns end on one side, and the ``count`` lines beyond it."""
        start = self.first(yarn) + (self.columns if right else 0)
        return (start + np.arange(count + 1) * (1 if right else -1)) % self.count


def lines_across(axis: int, plans: Sequence[Plan], columns: int, yarns: int, gap: int) -> Lines:
    """The lines across an axis (0: x), from the plans of the yarns that run along it.

    ``columns`` and ``yarns`` are those of the crossed direction, ``gap`` elements lie between two
    crossings. Raises :class:`InputError` where the yarns do not have equally many stations.
    """
    along = [plan for plan in plans if plan.along_axis == axis]
    counts = {int(plan.rows[-1]) for plan in along}
    if len(counts) > 1:
        message = (
            "the arcs above and below a round section would take different numbers of elements, "
            "and the matrix needs equal ones; ask for fewer elements"
        )
        raise InputError(Problem(message, column=("crossing", "across")[axis]))

    places = np.mean([_stations(plan) for plan in along], axis=0)
    places[[0, -1]] = along[0].places[[0, -1]]  # a mean of equal numbers is not always the number
    side = ((len(places) - 1) // yarns - columns - gap) // 2
    return Lines(places, yarns, columns, side, gap)


def _stations(plan: Plan) -> np.ndarray:
    """Places (stations,) of a yarn's layers along the cell, mm."""
    spans = zip(plan.places, plan.places[1:], plan.layers)
    parts = [start + (end - start) * shares for start, end, shares in spans]
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])
