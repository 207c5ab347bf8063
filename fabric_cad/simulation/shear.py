"""Trellis shear of a cell: both directions turn towards each other by half the angle.

The cell's vectors turn and keep their length, as a fabric's yarns do; the moment is that of the
yarn ends' forces, work-conjugate to the angle between the directions.
"""

from __future__ import annotations

import math

import numpy as np

from ..decks.model import Load
from ..meshing.mesh import Mesh
from .job import Reached, tension_per_yarn
from .settings import ShearCase


def cell_vectors(period: tuple[float, float], angle: float, strain: float = 0.0) -> np.ndarray:
    """The weft's and the warp's period (2, 3), mm, of a cell sheared by ``angle`` (degrees)."""
    half = math.radians(angle) / 2
    turned = np.array([[math.cos(half), math.sin(half), 0.0], [math.sin(half), math.cos(half), 0.0]])
    return (1 + strain) * np.array(period)[:, None] * turned


def angles(case: ShearCase) -> tuple[float, ...]:
    """Degrees, from the smallest; 0 comes first where a strain is applied before."""
    turned = tuple(case.angle_deg * at / case.points for at in range(1, case.points + 1))
    return (0.0, *turned) if case.strain else turned


def shear_loads(period: tuple[float, float], case: ShearCase) -> tuple[Load, ...]:
    """The cell's change for every angle; ``period`` mm."""
    rest = cell_vectors(period, 0.0)
    loads = []
    for angle in angles(case):
        weft, warp = (cell_vectors(period, angle, case.strain) - rest).tolist()
        loads.append(Load(f"shear {angle:.6g} degrees", tuple(weft), tuple(warp)))
    return tuple(loads)


def moment(period: tuple[float, float], angle: float, strain: float, forces: np.ndarray) -> float:
    """Moment (N mm) of a cell: work of the ends' ``forces`` (2, 3), N, per radian of shear."""
    half = math.radians(angle) / 2
    turning = np.array([[-math.sin(half), math.cos(half), 0.0], [math.cos(half), -math.sin(half), 0.0]]) / 2
    return float(((1 + strain) * np.array(period)[:, None] * turning * forces).sum())


def shear_row(
    mesh: Mesh, period: tuple[float, float], angle: float, strain: float, reached: Reached, condition: dict[str, float]
) -> dict[str, float]:
    """The line of ``shear.csv`` for one angle (degrees); ``condition`` as of :func:`.job.condition`.

    ``force_N_per_mm`` is the moment per area of the cell: the force along a side, per mm of it.
    """
    couple = moment(period, angle, strain, reached.forces)
    vectors = cell_vectors(period, angle, strain)
    pulls = (reached.forces * vectors).sum(axis=1) / np.linalg.norm(vectors, axis=1)
    return {
        "angle_deg": angle,
        "moment_N_mm": couple,
        "force_N_per_mm": couple / (period[0] * period[1]),
        **tension_per_yarn(mesh, pulls),
        "thickness_mm": float(np.ptp(mesh.points[:, 2] + reached.displacement[:, 2])),
        **condition,
    }


def state_label(angle: float, strain: float) -> str:
    """A line of ``shear.csv`` in words: its angle (degrees), and the strain before where there was one."""
    return f"sheared by {angle:.4g} degrees" + (f", stretched by {100 * strain:.4g} % before" if strain else "")
