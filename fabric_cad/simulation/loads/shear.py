"""Trellis shear of a cell: both directions turn towards each other by half the angle.

The cell's vectors turn and keep their length, as a fabric's yarns do; the moment is that of the
yarn ends' forces, work-conjugate to the angle between the directions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ...decks.model import Load
from ...measured.settings_files import Check
from ...support.series import valid_until
from ...weave.lattice import Lattice
from ..checks import is_from_to, whole
from ..laws import ContactLaw
from ..reached import Deformed, tension_per_yarn, thickness
from .case import Line, LoadCase

if TYPE_CHECKING:
    from ..case_run import CaseRun
    from ..case_table import CaseTable
    from ..report import CaseReport


@dataclass(frozen=True)
class ShearCase(LoadCase[float]):
    """Trellis shear to an angle (degrees) after a strain of both directions.

    A state is its angle, degrees.
    """

    angle_deg: float
    points: int
    strain: float

    name: ClassVar[str] = "shear"
    text: ClassVar[str] = "shear a row's cell with CalculiX: moment and force against the angle"
    checks: ClassVar[Mapping[str, Check]] = MappingProxyType(
        {
            "angle_deg": (float, lambda angle: 0 < angle <= 60, "is not above 0 and up to 60"),
            "points": whole(1, 200),
            "strain": (float, is_from_to(0, 0.1), "is not from 0 to 0.1"),
        }
    )

    def paths(self, contact: ContactLaw) -> Sequence[Sequence[float]]:
        """One path, from the smallest angle; 0 comes first where a strain is applied before."""
        turned = tuple(self.angle_deg * step / self.points for step in range(1, self.points + 1))
        return ((0.0, *turned) if self.strain else turned,)

    def load(self, state: float, lattice: Lattice) -> Load:
        """The cell's periods turned and stretched."""
        change = cell_vectors(lattice.vectors, state, self.strain) - lattice.vectors
        return Load.of(f"shear {state:.6g} degrees", change)

    def at_rest(self) -> float | None:
        """No angle; a cell that is stretched before is not at rest there."""
        return None if self.strain else 0.0

    def lines(self, states: Sequence[float]) -> Sequence[Line]:
        """The angles as they come, which are the times of the series too."""
        return [Line(number, angle, {"angle_deg": angle}) for number, angle in enumerate(states)]

    def measures(self, state: float, deformed: Deformed) -> dict[str, float]:
        """Moment, force, tensions, thickness.

        ``force_N_per_mm`` is the moment per area of the cell: the force along a side, per mm of it.
        """
        forces, vectors = deformed.reached.forces, deformed.vectors
        couple = moment(deformed.lattice.vectors, state, self.strain, forces)
        pulls = (forces * vectors).sum(axis=1) / np.linalg.norm(vectors, axis=1)
        return {
            "moment_N_mm": couple,
            "force_N_per_mm": couple
            / float(np.prod(np.linalg.norm(deformed.lattice.vectors, axis=1))),
            **tension_per_yarn(deformed.mesh, pulls),
            "thickness_mm": thickness(deformed.points),
        }

    def label(self, row: Mapping[str, float]) -> str:
        """Its angle, and the strain before where there was one."""
        before = f", stretched by {100 * self.strain:.4g} % before" if self.strain else ""
        return f"sheared by {row['angle_deg']:.4g} degrees{before}"

    def draw(self, run: CaseRun, table: CaseTable) -> None:
        """Moment and force against the angle, and the last valid state."""
        from ..pictures import draw_state

        if len(table.rows) > 1:
            _draw_curve(run, table)
            if table.valid:
                draw_state(run, table.reached[table.valid[-1]], table.labels[table.valid[-1]])

    def findings(self, run: CaseRun, table: CaseTable) -> dict[str, Any]:
        """``valid_up_to_deg`` and ``largest``, the last line."""
        from ..report import plain

        angles, depths = (
            [row[column] for row in table.rows] for column in ("angle_deg", "penetration_mm")
        )
        return {
            "valid_up_to_deg": valid_until(angles, depths, run.penetration_bound)
            if angles
            else 0.0,
            "largest": plain(table.rows[-1]) if table.rows else None,
        }

    def summary(self, report: CaseReport) -> list[str]:
        """The last angle, and up to which contact is valid."""
        last, contact = report.findings["largest"], report.contact
        until = "up to" if contact.states_beyond else "at least up to"
        return [
            f"  at {last['angle_deg']:g} degrees   moment {last['moment_N_mm']:.4g} N mm a cell, "
            f"force {last['force_N_per_mm']:.4g} N/mm",
            f"  contact valid   {until} {report.findings['valid_up_to_deg']:.3g} degrees "
            f"(penetration within {contact.valid_penetration_mm:.2g} mm)",
        ]


def cell_vectors(rest: np.ndarray, angle: float, strain: float = 0.0) -> np.ndarray:
    """The weft's and the warp's period (2, 3), mm, of a cell sheared by ``angle`` (degrees), with ``rest`` before.

    Each turns in the plane towards the other by half of the angle.
    """
    half = math.radians(angle) / 2
    return (1 + strain) * _turned(rest, math.cos(half), math.sin(half))


def moment(rest: np.ndarray, angle: float, strain: float, forces: np.ndarray) -> float:
    """Moment (N mm) of a cell: work of the ends' ``forces`` (2, 3), N, per radian of shear."""
    half = math.radians(angle) / 2
    # the vectors' derivative by the angle
    turning = _turned(rest, -math.sin(half), math.cos(half)) / 2
    return float(((1 + strain) * turning * forces).sum())


def _turned(rest: np.ndarray, cos: float, sin: float) -> np.ndarray:
    """Vectors (2, 3) in the plane turned by an angle, the weft's one way and the warp's the other."""
    turns = np.array([[[cos, -sin], [sin, cos]], [[cos, sin], [-sin, cos]]])
    turned = np.zeros((2, 3))
    turned[:, :2] = np.einsum("vij,vj->vi", turns, rest[:, :2])
    return turned


def _draw_curve(run: CaseRun, table: CaseTable) -> None:
    """Moment and force against the angle."""
    from ...pictures.plots import plot_shear_curve, save_figure

    with run.stages("curves"):
        figure = plot_shear_curve(table.columns(), allowed=run.penetration_bound)
        save_figure(figure, run.path("_curve.png"), run.cell.fabric.name)
