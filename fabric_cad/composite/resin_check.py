"""Whether strips of resin fit beside flat and round yarns: in narrow gaps, over steep yarns, they would fold."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..meshing.quality import hexahedra_quality
from ..model.plausibility import LEAST_JACOBIAN
from ..model.solved import SolvedFabric
from ..support.errors import InputError, Problem
from .resin_mesh import Resin
from .spacing import lowest_side


class MeshedResin(NamedTuple):
    """A strip of resin, and its ``hexahedra`` (elements, 8)."""

    resin: Resin
    hexahedra: np.ndarray


def check_resins(resins: Sequence[MeshedResin], points: np.ndarray, fabric: SolvedFabric) -> None:
    """Raise :class:`InputError` where hexahedra of strips between ``points`` (nodes, 3), mm, are as good as folded.

    That is where a scaled Jacobian is not above :data:`LEAST_JACOBIAN`.
    """
    if not resins:
        return
    least = [hexahedra_quality(points, strip.hexahedra).scaled_jacobian.min() for strip in resins]
    worst = int(np.argmin(least))
    if least[worst] > LEAST_JACOBIAN:
        return

    direction = resins[worst].resin.direction
    own, crossed = fabric.directions[direction], fabric.crossed(direction)
    gap, side = crossed.crossed_spacing - own.width, lowest_side(fabric, direction)
    message = (
        f"{own.width:.4g} leaves a gap of {gap:.3g} mm between {direction}s, too narrow for strips of resin beside "
        f"their {fabric.section} sides, which are {side:.3g} mm high, where the {direction.other}s climb "
        f"{crossed.z_high - crossed.z_low:.3g} mm: the scaled Jacobian is {least[worst]:.3g}, "
        f"not above {LEAST_JACOBIAN:g}"
    )
    raise InputError(Problem(message, column=f"{direction}_width_mm", row=fabric.name))
