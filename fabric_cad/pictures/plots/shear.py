"""In-plane shear of a cell: moment and force over the angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...support.series import valid_until
from .figures import PENETRATION, drawn_on

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLUMNS = ("angle_deg", "moment_N_mm", "force_N_per_mm", "penetration_mm")


def plot_shear_curve(
    columns: Mapping[str, Sequence[float]],
    axes: Any = None,
    allowed: float = 0.01,
) -> Figure:
    """Shear moment of a cell against the angle, and where contact ceases to be valid; the figure.

    ``columns``, of equal length: ``angle_deg`` ascending, ``moment_N_mm`` of a cell,
    ``force_N_per_mm`` and ``penetration_mm``. The force is the moment over the cell's area: one
    curve, read off on the left as moment and on the right as force. Beyond the angle at which
    yarns penetrate by more than ``allowed`` mm the ground is grey. Raises ValueError where forces
    are in no fixed ratio to moments.
    """
    angle, moment, force, depth = (np.asarray(columns[name], dtype=float) for name in _COLUMNS)
    figure, axes = drawn_on(axes)
    axes.plot(angle, moment, color="black", marker="o", markersize=3.5)
    axes.set(xlabel="shear angle, degrees", ylabel="moment of a cell, N mm", title="in-plane shear")
    axes.grid(alpha=0.3)

    if moment.any():
        ratio = _ratio(moment, force)
        to_force_and_back = (lambda value: value * ratio, lambda value: value / ratio)
        right = axes.secondary_yaxis("right", functions=to_force_and_back)
        right.set_ylabel("force along a side, N/mm")

    if (depth > allowed).any():
        valid = valid_until(angle.tolist(), depth.tolist(), allowed)
        label = f"penetration {allowed:g} mm, {valid:.1f}\u00b0"
        axes.axvline(valid, color=PENETRATION, linewidth=1.2, label=label)
        axes.axvspan(valid, angle[-1], color="0.92", zorder=0)
        axes.legend(frameon=False, loc="upper left")

    return figure


def _ratio(moment: np.ndarray, force: np.ndarray) -> float:
    """Force over moment, 1/mm2. Raises ValueError where it is not the same everywhere."""
    ratio = float((moment @ force) / (moment @ moment))
    if not np.allclose(force, ratio * moment, rtol=1e-6, atol=1e-9 * np.abs(force).max()):
        raise ValueError("force_N_per_mm is in no fixed ratio to moment_N_mm")
    return ratio
