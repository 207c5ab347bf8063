"""The scene every picture of a cell shares: yarns, lines, light, camera, scale bar and title."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..meshing.mesh import Mesh
from ..support.vtk import pyvista
from ..weave.bodies import Body
from ..weave.colours import COLOURS
from ..weave.directions import DIRECTIONS
from .skin import Skin, skin_of

SIZE = (1600, 1200)
"""Pixels across and down a picture."""

EDGE = "#202020"
TEXT = {"font": "arial", "font_size": 16, "color": EDGE}

_GLOSS = {
    "smooth_shading": True,
    "ambient": 0.32,
    "diffuse": 0.75,
    "specular": 0.15,
    "specular_power": 20,
}
# from the cell to the eye
_TOWARDS = np.array([-0.75, -1.5, 1.35]) / np.linalg.norm([-0.75, -1.5, 1.35])
_RIGHT = np.cross([0.0, 0.0, 1.0], _TOWARDS) / np.linalg.norm(np.cross([0.0, 0.0, 1.0], _TOWARDS))
_UP = np.cross(_TOWARDS, _RIGHT)
_ABOVE = 0.07  # of a picture's height: room for a title
_MARGIN = 1.06
_LIGHTS = (((-0.6, -1.0, 1.6), 0.85), ((1.5, 0.4, 0.8), 0.35), ((-0.3, 1.0, 0.5), 0.2))


def new_scene(**options):
    """An empty white scene."""
    plotter = pyvista().Plotter(window_size=SIZE, lighting="none", **options)
    plotter.set_background("white")
    return plotter


def surface(skin: Skin, points: np.ndarray):
    """A skin at ``points`` (nodes, 3) as a surface with normals, smooth within patches.

    Point data ``node`` has the number of the mesh's node of every point.
    """
    keys = skin.patch[:, None].astype(np.int64) * len(points) + skin.quads
    used, faces = np.unique(keys, return_inverse=True)
    nodes = used % len(points)
    poly = pyvista().PolyData.from_regular_faces(points[nodes], faces.reshape(-1, 4))
    poly.point_data["node"] = nodes
    return poly.compute_normals(split_vertices=False, cell_normals=False)


def add_yarns(plotter, mesh: Mesh, points: np.ndarray, yarns: Iterable[Body]) -> None:
    """Yarns in the colours of their directions, and their lines."""
    for direction in DIRECTIONS:
        if alike := [yarn for yarn in yarns if yarn.direction is direction]:
            skin = skin_of(mesh, alike)
            plotter.add_mesh(surface(skin, points), color=COLOURS[direction], **_GLOSS)
            add_lines(plotter, skin.lines, points)


def add_lines(plotter, lines: np.ndarray, points: np.ndarray, **options) -> None:
    """Dark lines (lines, 2) between points (points, 3)."""
    cells = np.column_stack([np.full(len(lines), 2), lines])
    drawn = pyvista().PolyData(points, lines=cells)
    plotter.add_mesh(drawn, **{"color": EDGE, "line_width": 1.5, "lighting": False} | options)


def light(plotter, points: np.ndarray) -> None:
    """Light from above and aside."""
    centre = points.mean(axis=0)
    extent = np.ptp(points, axis=0).max()
    for place, strength in _LIGHTS:
        position = centre + extent * np.array(place)
        lamp = pyvista().Light(position=position, focal_point=centre, intensity=strength)
        plotter.add_light(lamp)


@dataclass(frozen=True)
class ScaleBar:
    """Two arms of one length (mm) along x and y.

    They start from a ``corner`` (3,) left of a cell and in its lower plane.
    """

    corner: np.ndarray
    length: float

    @property
    def points(self) -> np.ndarray:
        """The end of the arm along x, the corner, the end of the arm along y; (3, 3) mm."""
        return self.corner + self.length * np.array([[1.0, 0, 0], [0, 0, 0], [0, 1.0, 0]])

    @property
    def label_place(self) -> np.ndarray:
        """Where its label is centred: just below the arm along x."""
        return self.corner + self.length * np.array([0.65, -0.35, 0])


def scale_bar(points: np.ndarray) -> ScaleBar:
    """The bar of a round length, up to a fifth of a cell, beside its corner at least x and y."""
    extent = float(np.sqrt(np.prod(np.ptp(points[:, :2], axis=0))))
    power = 10.0 ** np.floor(np.log10(extent / 5))
    length = max(step * power for step in (1, 2, 5) if step * power <= extent / 5)
    least = points.min(axis=0)
    return ScaleBar(least - [0.05 * extent + length, 0.0, 0.0], length)


def finish(plotter, points: np.ndarray, title: str = "", below: float = 0.0) -> None:
    """Light, scale bar, title and camera for what lies at ``points`` (points, 3), mm.

    The share ``below`` of the picture's height stays free under it.
    """
    light(plotter, points)
    bar = scale_bar(points)
    add_lines(plotter, np.array([[0, 1], [1, 2]]), bar.points, line_width=5)
    plotter.add_point_labels(
        bar.label_place[None],
        [f"{bar.length:g} mm"],
        show_points=False,
        shape=None,
        always_visible=True,
        font_size=30,
        font_family="arial",
        bold=False,
        text_color=EDGE,
        justification_horizontal="center",
        justification_vertical="top",
    )
    if title:
        plotter.add_text(title, position=(0.03, 0.945), viewport=True, **TEXT)
    shown = np.vstack([points, bar.points, bar.label_place])
    _frame(plotter, shown, _ABOVE if title else 0.0, below)


def _frame(plotter, points: np.ndarray, above: float, below: float) -> None:
    """Look at points from the front left and above.

    They just fill the picture between two shares of its height.
    """
    seen = points @ np.column_stack([_RIGHT, _UP])
    low, high = seen.min(axis=0), seen.max(axis=0)
    width, height = high - low
    scale = _MARGIN * max(height / (1 - above - below), width * SIZE[1] / SIZE[0]) / 2

    centre = points.mean(axis=0)
    offset = (low + high) / 2 - [centre @ _RIGHT, centre @ _UP]
    middle = centre + np.column_stack([_RIGHT, _UP]) @ offset + (above - below) * scale * _UP

    camera = plotter.camera
    camera.focal_point = middle
    camera.position = middle + 2 * np.ptp(points, axis=0).max() * _TOWARDS
    camera.up = tuple(_UP)
    camera.parallel_projection = True
    camera.parallel_scale = scale
    plotter.renderer.ResetCameraClippingRange()


def offscreen() -> None:
    """Draw without a display where there is none."""
    if not os.environ.get("DISPLAY"):
        # no noise about a missing X server
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")


def save(plotter, path: str | Path) -> None:
    """Write a scene as PNG and close it."""
    from PIL import Image

    try:
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
        image = plotter.screenshot(None, return_img=True)
    finally:
        plotter.close()
    Image.fromarray(image).save(path, format="PNG")
