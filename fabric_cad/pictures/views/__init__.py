"""Pictures and ParaView files of a mesh; the door to PyVista and VTK."""

from .cell import draw_cell, show_cell
from .cuts import Outline, cut_along
from .deformed import draw_deformed
from .series import State, write_series
from .vtu import pyvista_blocks, pyvista_grid, write_vtu

__all__ = [
    "Outline",
    "State",
    "cut_along",
    "draw_cell",
    "draw_deformed",
    "pyvista_blocks",
    "pyvista_grid",
    "show_cell",
    "write_series",
    "write_vtu",
]
