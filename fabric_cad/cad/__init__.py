"""The door to CadQuery and OCCT; no other package imports them, the masters apart."""

from .inspection import Consistency, inspect_cell
from .solids import solid_of, sweep
from .step import Cell, assemble, read_step

__all__ = ["Cell", "Consistency", "assemble", "inspect_cell", "read_step", "solid_of", "sweep"]
