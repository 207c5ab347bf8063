"""What the masters share: control planes, control sections, trajectory, sweep.

Every yarn of the elementary cell is cut by control planes: mid-gap, begin and end of each
crossing (paper, Fig. 12). In each plane stands a control section (Fig. 9, 13), and the
sections are swept along the trajectory (Fig. 11). Which yarn lies on top at each crossing
is all that a master adds.
"""

from __future__ import annotations

import numpy as np

from fabric_cad.cad import Cell, assemble, sweep
from fabric_cad.model.solved import SolvedFabric
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.swept import SweptYarn


def woven(fabric: SolvedFabric, weft_over_warp: np.ndarray) -> Cell:
    """The cell of a fabric; ``weft_over_warp[i, j]`` is True where weft i passes over warp j."""
    yarns = {}
    for yarn in yarns_of(weft_over_warp):
        swept = SweptYarn(fabric, yarn)
        yarns[yarn.name] = sweep(swept.trajectory, swept.sections)
    return assemble(yarns, fabric.name)


def show(cell: Cell, show_object) -> None:
    """Hand every yarn of a cell to CQ-editor under its name and in its colour."""
    for part in cell.assembly.children:
        show_object(part.obj, name=part.name, options={"color": tuple(int(255 * c) for c in part.color.toTuple()[:3])})
