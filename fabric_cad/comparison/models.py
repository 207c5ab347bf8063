"""The models compared: those that the paper criticises (section 2), and the present one.

For one identified fabric, the yarns of five constant-section models and those of the present
model are written as height fields over the plan, z = bottom(t, v) and top(t, v), with t along
a yarn and v across it from its axis. All six share the spacing, the widths and thicknesses of
the yarns and the plateaux of the midlines, so every crossing touches at its centre, and differ
in nothing but the curve between two plateaux and the section:

    trajectories    sinusoidal   half a cosine from one crossing's centre to the next
                    circular     arc, straight segment, arc with common tangents; the arcs have the
                                 radius of the crossed yarn's lens, around which they bend
                    bars         straight from one crossing's centre to the next (Kawabata, Fig. 5)
    sections        elliptic     an ellipse with the axes c and b
                    lenticular   two circular arcs over the chord c, b high together

Sections are constant and stand in vertical planes x = const (wefts) or y = const (warps), as the
present model's do. Over a float, between crossings on one side, every trajectory is flat.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.weaves import Yarn
from .present import heights_of_skin
from .profiles import HalfHeight, elliptic, lenticular
from .trajectories import Fall, circular, sinusoidal, straight_bars

Heights = Callable[[SolvedFabric, Yarn, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Model:
    """A model of a fabric's yarns.

    ``heights(fabric, yarn, t, v)`` gives the bottom and the top of a yarn, each of shape
    (len(t), len(v)), at places ``t`` along it (0 to the period) and ``v`` across it
    (-c/2 to c/2); mm. It raises :class:`BuildError` where the model cannot make the yarn.
    """

    title: str
    heights: Heights


def constant_section(fall: Fall, half_height: HalfHeight) -> Heights:
    """Heights of a yarn with the same section everywhere, along a trajectory given by its fall."""

    def heights(
        fabric: SolvedFabric,
        yarn: Yarn,
        t: np.ndarray,
        v: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        solved, crossed = fabric.directions[yarn.direction], fabric.crossed(yarn.direction)
        spacing, count = solved.crossed_spacing, len(yarn.high)
        crossing = np.clip((t / spacing).astype(int), 0, count - 1)
        from_centre = t - (crossing + 0.5) * spacing

        high = np.array(yarn.high)
        neighbour = (crossing + np.where(from_centre < 0, -1, 1)) % count
        turns = high[crossing] != high[neighbour]
        drop = np.where(turns, fall(np.abs(from_centre), solved, crossed), 0.0)

        midline = np.where(high[crossing], solved.z_high - drop, solved.z_low + drop)[:, None]
        half = half_height(v, solved)
        return midline - half, midline + half

    return heights


MODELS = (
    Model("sinusoidal, elliptic", constant_section(sinusoidal, elliptic)),
    Model("sinusoidal, lenticular", constant_section(sinusoidal, lenticular)),
    Model("circular, elliptic", constant_section(circular, elliptic)),
    Model("circular, lenticular", constant_section(circular, lenticular)),
    Model("straight bars, elliptic", constant_section(straight_bars, elliptic)),
    Model("present model", heights_of_skin),
)
"""The five models criticised, then the present one."""
