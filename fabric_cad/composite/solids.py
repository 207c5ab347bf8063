"""A composite cell as CAD: its yarns, and one solid ``matrix``, which is the box less the yarns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..model.solved import SolvedFabric
from ..support.errors import BuildError
from ..yarn.skin import Skin
from ..yarn.swept import swept_yarns
from .cell import MATRIX
from .matrix import centring

if TYPE_CHECKING:
    import cadquery as cq

    from ..cad.step import Cell

_VOLUME = 1e-9
"""Relative error of the sum of all volumes up to which solids count as filling their box."""


def build_composite(fabric: SolvedFabric, size: np.ndarray) -> Cell:
    """The yarns and the matrix of a fabric in a box, ``size`` (3,) in mm, exactly, as an assembly.

    Where a contact chord is below the width the wedge between two yarns is matrix. Raises
    :class:`BuildError` where OCCT makes no valid solid.
    """
    from ..cad import assemble, solid_of
    from ..cad.matrix import matrix_solid

    skins = {swept.yarn.name: _raised(swept.skin, centring(fabric)) for swept in swept_yarns(fabric)}
    solids = {name: solid_of(skin, fabric.lattice) for name, skin in skins.items()}
    solids[MATRIX.name] = matrix_solid(list(skins.values()), size, fabric.lattice)
    return assemble(solids, fabric.name)


def _raised(skin: Skin, height: float) -> Skin:
    """A skin moved up, mm."""
    moved = (replace(patch, poles=patch.poles + [0.0, 0.0, height, 0.0]) for patch in skin.patches)
    return replace(skin, patches=tuple(moved))


def checked_volumes(solids: Mapping[str, cq.Solid], size: np.ndarray) -> dict[str, float]:
    """The volume (mm3) of every solid of a composite, as read from its STEP file.

    Raises :class:`BuildError` where one is not valid, or they do not fill the box, ``size`` (3,) in mm.
    """
    if faulty := [name for name, solid in solids.items() if not solid.isValid()]:
        raise BuildError(f"{', '.join(faulty)}: no valid solid")
    volumes = {name: solid.Volume(_VOLUME) for name, solid in solids.items()}
    error = sum(volumes.values()) / float(size.prod()) - 1
    if abs(error) > _VOLUME:
        raise BuildError(f"the volumes of yarns and matrix are {error:.3g} of the box off its volume")
    return volumes
