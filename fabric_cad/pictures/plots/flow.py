"""Flow through a cell: where it goes in plan, and how fast in a section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SAMPLES = 120


@dataclass(frozen=True, eq=False)
class Section:
    """Speed in a section: ``points`` (points, 2) mm, ``triangles`` (triangles, 3), ``speed`` (points,) mm2."""

    points: np.ndarray
    triangles: np.ndarray
    speed: np.ndarray
    title: str


def plot_flow(plan: np.ndarray, flux: np.ndarray, title: str, sections: list[Section]) -> Figure:
    """Streamlines of the ``flux`` (points, 2) through the thickness over ``plan`` (points, 2), mm, and sections.

    Flux is in mm3, speed in mm2, both for a unit pressure gradient over viscosity. Returns the
    figure.
    """
    from matplotlib.figure import Figure
    from scipy.interpolate import griddata

    figure = Figure((8, 6 + 1.8 * len(sections)), layout="constrained")
    ratios = [6, *[1.4] * len(sections)]
    upper, *others = figure.subplots(len(ratios), 1, squeeze=False, height_ratios=ratios).ravel()
    sides = [np.linspace(plan[:, axis].min(), plan[:, axis].max(), _SAMPLES) for axis in range(2)]
    grid = np.stack(np.meshgrid(*sides), axis=-1)
    field = griddata(plan, flux, grid, method="linear")

    size = np.linalg.norm(field, axis=-1)
    image = upper.pcolormesh(*sides, size, shading="gouraud", cmap="viridis", rasterized=True)
    if np.nanmax(size) > 0:
        upper.streamplot(
            *sides,
            field[..., 0],
            field[..., 1],
            color="white",
            linewidth=0.7,
            density=1.2,
            arrowsize=0.7,
        )

    figure.colorbar(image, ax=upper, label="flux through the thickness, mm3")
    upper.set(xlim=sides[0][[0, -1]], ylim=sides[1][[0, -1]])
    _label(upper, title, ("x mm", "y mm"))

    for ax, section in zip(others, sections):
        image = ax.tripcolor(
            *section.points.T, section.triangles, section.speed, shading="gouraud", rasterized=True
        )
        figure.colorbar(image, ax=ax, label="speed, mm2")
        _label(ax, section.title, ("x mm", "z mm"))

    return figure


def _label(ax: Any, title: str, names: tuple[str, str]) -> None:
    ax.set_aspect("equal")
    ax.set_title(title, fontsize="medium")
    ax.set_xlabel(names[0])
    ax.set_ylabel(names[1])
