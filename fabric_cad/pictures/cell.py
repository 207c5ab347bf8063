"""A cell as it is woven: a picture, and a window."""

from __future__ import annotations

import os
from pathlib import Path

from ..meshing.mesh import Mesh
from ..support.errors import OutputError
from .scene import SIZE, add_yarns, finish, new_scene, offscreen, save

_OF_THE_SCREEN = 0.8  # that a window takes at most: frames, bars and docks need room too


def _scene_of(mesh: Mesh, title: str = "", **options):
    plotter = new_scene(**options)
    add_yarns(plotter, mesh, mesh.points, mesh.yarns)
    finish(plotter, mesh.points, title)
    return plotter


def draw_cell(mesh: Mesh, path: str | Path, title: str = "") -> None:
    """Draw a cell off-screen as PNG with a scale bar in mm, a title above; no display is needed."""
    offscreen()
    save(_scene_of(mesh, title, off_screen=True), path)


def show_cell(mesh: Mesh, title: str) -> None:
    """Show a cell in a window that fits the screen, until it is closed.

    Raises :class:`OutputError` without a display.
    """
    if _no_display():
        raise OutputError(
            "no display to open a window on (DISPLAY is not set); the picture is in the cell's folder"
        )

    plotter = _scene_of(mesh)
    plotter.add_axes()
    plotter.title = title
    plotter.window_size = window_size(plotter.render_window.GetScreenSize())
    plotter.show(title=title)


def _no_display() -> bool:
    """True on a Linux that has neither an X server nor Wayland."""
    on_linux = os.name == "posix" and os.uname().sysname == "Linux"
    return on_linux and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def window_size(screen: tuple[int, int]) -> tuple[int, int]:
    """Pixels of a window of the pictures' shape on a screen of so many pixels across and down."""
    width, height = SIZE
    share = min(1.0, _OF_THE_SCREEN * screen[0] / width, _OF_THE_SCREEN * screen[1] / height)
    return int(share * width), int(share * height)
