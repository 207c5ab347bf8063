"""Stiffness against direction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .figures import drawn_on

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_PLANES = (
    ("in the fabric's plane", (("xy", 0, 1),)),
    ("through the thickness", (("xz", 0, 2), ("yz", 1, 2))),
)
_STYLES = (
    {"color": "black", "linewidth": 2.0},
    {"color": "0.6", "linewidth": 1.4, "linestyle": "--"},
)
_SAMPLES = 361


def plot_directions(stiffness: np.ndarray, axes: Any = None) -> Figure:
    """Young's modulus against direction, GPa, of a stiffness (6, 6), MPa; the figure.

    ``stiffness`` is in the order xx yy zz yz xz xy with engineering shear. ``axes`` are two, polar:
    in the fabric's plane from x towards y, and through the thickness from x, or y, towards z.
    """
    figure, axes = drawn_on(axes, (1, 2), (9, 4.8), projection="polar")
    compliance = np.linalg.inv(stiffness)
    angle = np.linspace(0.0, 2 * np.pi, _SAMPLES)

    for ax, (title, planes) in zip(np.ravel(axes), _PLANES):
        for (name, first, second), style in zip(planes, _STYLES):
            ax.plot(
                angle, youngs_modulus(compliance, angle, first, second) / 1e3, label=name, **style
            )

        ax.set_title(f"{title}, Young's modulus GPa", fontsize="medium")
        ax.set_rlim(bottom=0.0)
        if len(planes) > 1:
            ax.legend(frameon=False, loc="lower right", bbox_to_anchor=(1.1, -0.1))

    return figure


def youngs_modulus(
    compliance: np.ndarray, angle: np.ndarray, first: int, second: int
) -> np.ndarray:
    """Modulus (angles,) of a ``compliance`` (6, 6) under tension at angles from axis ``first`` towards ``second``."""
    direction = np.zeros((3, len(angle)))
    direction[first], direction[second] = np.cos(angle), np.sin(angle)
    x, y, z = direction
    stress = np.array([x * x, y * y, z * z, y * z, x * z, x * y])
    return 1 / np.einsum("ia,ij,ja->a", stress, compliance, stress)
