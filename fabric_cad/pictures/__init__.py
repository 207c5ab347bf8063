"""Pictures and ParaView files of a mesh."""

from .cell import draw_cell, show_cell
from .cuts import Outline, cut_along
from .deformed import draw_deformed
from .series import State, write_series
from .vtu import write_vtu

__all__ = [
    "Outline",
    "State",
    "cut_along",
    "draw_cell",
    "draw_deformed",
    "show_cell",
    "write_series",
    "write_vtu",
]
