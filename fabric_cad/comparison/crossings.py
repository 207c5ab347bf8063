"""The crossings of a cell, and what faces what there under a model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.weaves import Yarn, yarns_of
from .models import Model


def crossings(fabric: SolvedFabric) -> Iterator[tuple[Yarn, Yarn]]:
    """(weft, warp) of every crossing in the cell."""
    yarns = yarns_of(fabric.weave.interlacement())
    for weft in yarns[: fabric.weave.wefts]:
        for warp in yarns[fabric.weave.wefts :]:
            yield weft, warp


@dataclass(frozen=True, eq=False)
class Facing:
    """Two yarns over one crossing, sheet by sheet from below: heights (warp, weft places), mm."""

    lower_bottom: np.ndarray
    lower_top: np.ndarray
    upper_bottom: np.ndarray
    upper_top: np.ndarray

    @property
    def gap(self) -> np.ndarray:
        """The upper yarn's bottom minus the lower one's top, mm."""
        return self.upper_bottom - self.lower_top

    @property
    def shared(self) -> np.ndarray:
        """Thickness of what lies in both yarns, mm; negative where nothing does."""
        low = np.maximum(self.upper_bottom, self.lower_bottom)
        return np.minimum(self.lower_top, self.upper_top) - low


def facing(
    fabric: SolvedFabric,
    model: Model,
    crossing: tuple[Yarn, Yarn],
    v_weft: np.ndarray,
    v_warp: np.ndarray,
) -> Facing:
    """The sheets of a crossing's (weft, warp), each of shape (len(v_warp), len(v_weft)), mm.

    ``v_warp`` are distances from the warp's axis (along x), ``v_weft`` from the weft's (along
    y), mm.
    """
    weft, warp = crossing
    x = (warp.index + 0.5) * fabric.weft.crossed_spacing + v_warp
    y = (weft.index + 0.5) * fabric.warp.crossed_spacing + v_weft
    weft_bottom, weft_top = model.heights(fabric, weft, x, v_weft)
    warp_bottom, warp_top = (z.T for z in model.heights(fabric, warp, y, v_warp))

    if weft.high[warp.index]:
        return Facing(warp_bottom, warp_top, weft_bottom, weft_top)
    return Facing(weft_bottom, weft_top, warp_bottom, warp_top)
