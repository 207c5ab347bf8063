"""Levels: how high a yarn lies at a crossing, told by whole numbers of yarns below it.

::

    weft over the warp            weft under the warp
      ====  weft (0 | 1)            (  )  warp (1 | 0)         (wefts | warps below)
      (  )  warp (0 | 0)            ====  weft (0 | 0)

Today's weaves have one level of wefts, so that a yarn has at most one of the other direction
below it; the law of heights is the same for more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .directions import Direction


@dataclass(frozen=True)
class Level:
    """Where a yarn lies at a crossing: the wefts below it in its column, the warps below it in its lane."""

    wefts_below: int
    warps_below: int

    def height(
        self, direction: Direction, weft_amplitude: np.ndarray, warp_amplitude: np.ndarray
    ) -> np.ndarray:
        """Height of the midline of a yarn of a direction, from that of the lowest weft; mm, arrays broadcast.

        A weft below raises by the warps' amplitude A2, a warp below by the wefts' A1, and warps
        stand (A1 - A2) / 2 higher: then neighbours at a crossing are (A1 + A2) / 2 apart. (14),
        (A.29), (A.35)
        """
        A1, A2 = weft_amplitude, warp_amplitude
        if direction is Direction.WEFT:
            return self.wefts_below * A2 + self.warps_below * A1
        return ((2 * self.wefts_below - 1) * A2 + (2 * self.warps_below + 1) * A1) / 2


def level_of(direction: Direction, yarns_below: int) -> Level:
    """The level of a yarn with so many yarns of the other direction below it, and none of its own."""
    if direction is Direction.WEFT:
        return Level(0, yarns_below)
    return Level(yarns_below, 0)


LOW, HIGH = 0, 1
"""Yarns of the other direction below a yarn on its low and on its high plateau."""
