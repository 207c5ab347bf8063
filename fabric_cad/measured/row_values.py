"""What the rules of a row look at: the numbers of a whole table, and which cells are filled."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .columns import PER_DIRECTION
from .family import Family


@dataclass(frozen=True, eq=False)
class RowValues:
    """What the rules look at: arrays of shape (rows,) by column, and a text a row.

    ``values`` are in the unit a quantity is kept in, NaN where a cell is empty or refused already;
    ``filled`` is True where something stands in the cell, be it refused. ``sections`` are "" where
    none is named.
    """

    values: Mapping[str, np.ndarray]
    filled: Mapping[str, np.ndarray]
    sections: Sequence[str]

    @staticmethod
    def of(table: Family) -> RowValues:
        """Those of a table; a cell is filled where it has a number."""
        return RowValues(
            values=table.measured,
            filled={column: ~np.isnan(values) for column, values in table.measured.items()},
            sections=table.sections,
        )

    def is_section(self, *words: str) -> np.ndarray:
        """True where a row asks for one of these sections."""
        return np.array([named in words for named in self.sections], dtype=bool)

    def has(self, direction: str) -> np.ndarray:
        """True where a direction has cells of its own: the warp of a balanced row has none."""
        if direction == "weft":
            return np.ones(len(self.sections), dtype=bool)
        return np.any(
            [self.filled[f"{direction}_{quantity}"] for quantity in PER_DIRECTION], axis=0
        )

    def spacing(self, direction: str) -> np.ndarray:
        """Distance of neighbouring yarns, mm."""
        with np.errstate(all="ignore"):
            return 1 / self.values[f"{direction}_density_per_mm"]

    def chord(self, direction: str, side: str) -> np.ndarray:
        """Contact chord c_t or c_b, mm: the width where none is given."""
        given = self.values[f"{direction}_contact_{side}_mm"]
        return np.where(np.isnan(given), self.values[f"{direction}_width_mm"], given)
