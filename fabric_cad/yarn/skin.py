"""The exact skin swept between control sections along a trajectory.

Everything is a polynomial spline (arcs: rational), so the skin has closed-form poles and
nothing is fitted. Between two control planes the section is translated along the trajectory;
where the two planes' sections differ they blend with the cubic smoothstep 3 t^2 - 2 t^3, whose
Bernstein coefficients 0, 0, 1, 1 repeat each section's poles twice. The skin is therefore
tangent continuous across every control plane (model, section 5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..section.splines import as_cubic
from ..section.strips import Section
from ..weave.directions import Direction
from .planes import ControlPlane
from .trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Patch:
    """One tensor-product face of a yarn between two control planes.

    ``poles``, shape (along, across, 4), are t along the yarn, v across it, z (mm) and weight;
    ``along`` and ``across`` are (knots, degree); ``segment`` numbers the pairs of planes.
    """

    segment: int
    side: str
    along: tuple[np.ndarray, int]
    across: tuple[np.ndarray, int]
    poles: np.ndarray

    @property
    def homogeneous(self) -> np.ndarray:
        """The poles as weight times place, and weight: shape (along, across, 4)."""
        return self.poles * np.where(np.arange(4) < 3, self.poles[..., 3:], 1.0)

    def at(self, shares_along: np.ndarray, shares_across: np.ndarray) -> np.ndarray:
        """Points (t, v, z), mm, on the grid of shares from 0 to 1 of its two parameters.

        Shape (shares along, shares across, 3).
        """
        from scipy.interpolate import BSpline

        (along, degree_along), (across, degree_across) = self.along, self.across
        t = along[0] + (along[-1] - along[0]) * np.asarray(shares_along)
        v = across[0] + (across[-1] - across[0]) * np.asarray(shares_across)

        rows = BSpline(along, self.homogeneous, degree_along)(t)
        points = BSpline(across, rows, degree_across, axis=1)(v)
        return points[..., :3] / points[..., 3:]


@dataclass(frozen=True, eq=False)
class Skin:
    """The closed surface of a yarn, its two end sections excepted."""

    direction: Direction
    axis: float
    planes: tuple[ControlPlane, ...]
    patches: tuple[Patch, ...]


def skin(path: Trajectory, sections: Sequence[Section]) -> Skin:
    """Sweep the control sections, one in each control plane, along a trajectory: exact splines."""
    patches = []
    for segment, (piece, first, second) in enumerate(zip(path.pieces, sections, sections[1:])):
        along = piece if first is second else as_cubic(piece)
        abscissae = along.abscissae
        for side, strip in first.strips.items():
            other = second.strips[side].poles
            rows = (
                [strip.poles] * len(along.poles)
                if first is second
                else [strip.poles] * 2 + [other] * 2
            )
            poles = np.empty((len(along.poles), len(other), 4))
            poles[..., 0] = abscissae[:, None]
            poles[..., 1:] = rows
            poles[..., 2] += along.poles[:, None]
            degree = 1 if len(other) == 2 else 2
            patches.append(
                Patch(segment, side, (along.knots, along.degree), (strip.knots, degree), poles)
            )

    return Skin(path.direction, path.axis, path.planes, tuple(patches))
