"""Control planes: where along a yarn its sections stand.

::

    mid-gap   crossing, width c of the crossed yarn    mid-gap
       |--------|-----|=================|-----|--------|-------
        gap / 2        contact chord           gap / 2

The planes at the ends of the contact chord are there where it is shorter than the width.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..model.solved import SolvedFabric
from ..weave.weaves import Yarn


@dataclass(frozen=True)
class ControlPlane:
    """A place along a yarn (mm), and the number of the crossing it belongs to (None: mid-gap)."""

    place: float
    crossing: int | None


def contact_segment(planes: Sequence[ControlPlane], crossing: int) -> int:
    """Number of the pair of control planes between which a crossing's contact lies."""
    numbers = [at for at, plane in enumerate(planes) if plane.crossing == crossing]
    return numbers[len(numbers) // 2 - 1]


def control_planes(fabric: SolvedFabric, yarn: Yarn) -> tuple[ControlPlane, ...]:
    """A yarn's control planes along the cell (Fig. 12)."""
    a, crossed = fabric.directions[yarn.direction].crossed_spacing, fabric.crossed(yarn.direction)
    planes = [ControlPlane(0.0, None)]
    for k, high in enumerate(yarn.high):
        half_chord = crossed.contact["low" if high else "high"].half_chord
        halves = [crossed.width / 2]
        if half_chord < crossed.width / 2 * (1 - 1e-12):
            halves.append(half_chord)
        centre = (k + 0.5) * a
        planes += [ControlPlane(centre - half, k) for half in halves]
        planes += [ControlPlane(centre + half, k) for half in reversed(halves)]
        planes.append(ControlPlane((k + 1) * a, None))
    return tuple(planes)


def contact_patches(
    fabric: SolvedFabric,
) -> dict[tuple[str, str], tuple[float, float, float, float]]:
    """Plan rectangle (x from, x to, y from, y to; mm) in which each weft touches each warp."""
    found = {}
    for i, row in enumerate(fabric.weave.interlacement()):
        for j, over in enumerate(row):
            x, y = (j + 0.5) * fabric.weft.crossed_spacing, (i + 0.5) * fabric.warp.crossed_spacing
            half_x = fabric.warp.contact["low" if over else "high"].half_chord
            half_y = fabric.weft.contact["high" if over else "low"].half_chord
            found[f"weft_{i + 1}", f"warp_{j + 1}"] = (
                x - half_x,
                x + half_x,
                y - half_y,
                y + half_y,
            )

    return found
