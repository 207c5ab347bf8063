"""A composite cell as CAD: its yarns, and one solid ``matrix``, which is the box less the yarns."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..model.solved import SolvedFabric
from ..yarn.skin import Skin
from ..yarn.swept import swept_yarns
from .cell import MATRIX
from .matrix import centring

if TYPE_CHECKING:
    from ..cad.step import Cell


def build_composite(fabric: SolvedFabric, size: np.ndarray) -> Cell:
    """The yarns and the matrix of a fabric in a box, ``size`` (3,) in mm, exactly, as an assembly.

    Where a contact chord is below the width the wedge between two yarns is matrix. Raises
    :class:`BuildError` where OCCT makes no valid solid.
    """
    from ..cad import assemble, solid_of
    from ..cad.matrix import matrix_solid

    skins = {
        swept.yarn.name: _raised(swept.skin, centring(fabric)) for swept in swept_yarns(fabric)
    }
    solids = {name: solid_of(skin, fabric.lattice) for name, skin in skins.items()}
    solids[MATRIX.name] = matrix_solid(list(skins.values()), size, fabric.lattice)
    return assemble(solids, fabric.name)


def _raised(skin: Skin, height: float) -> Skin:
    """A skin moved up, mm."""
    moved = (replace(patch, poles=patch.poles + [0.0, 0.0, height, 0.0]) for patch in skin.patches)
    return replace(skin, patches=tuple(moved))
