"""The measured arrays that the identification works with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..measured.family import Family
from ..section.forms import Form, rows_by_form
from ..weave.directions import DIRECTIONS, Direction
from .closing import CLOSING

CONTACT_SIDE = {"high": "bottom", "low": "top"}
"""The side of a yarn that touches at each plateau."""


@dataclass(frozen=True, eq=False)
class Measured:
    """A table's measurements, with a balanced row's weft cells used for its warp; mm, shape (rows,).

    ``chord`` and ``offset`` are by direction and plateau of the yarn itself, ``closing``, shape (5,
    rows), in the order of :data:`~fabric_cad.model.closing.CLOSING`; ``forms`` are the sections'
    with the numbers of their rows.
    """

    density: Mapping[Direction, np.ndarray]
    width: Mapping[Direction, np.ndarray]
    chord: Mapping[tuple[Direction, str], np.ndarray]
    offset: Mapping[tuple[Direction, str], np.ndarray]
    closing: np.ndarray
    balanced: np.ndarray
    lateral_height: np.ndarray
    forms: tuple[tuple[Form, np.ndarray], ...]

    @classmethod
    def of(cls, table: Family) -> Measured:
        """Those of a table; where none is given, a contact chord is the width and an offset 0."""
        balanced, values = table.balanced, table.measured

        def both(quantity: str) -> dict[Direction, np.ndarray]:
            weft, warp = (values[f"{direction}_{quantity}"] for direction in DIRECTIONS)
            return {Direction.WEFT: weft, Direction.WARP: np.where(balanced, weft, warp)}

        width, chord, offset = both("width_mm"), {}, {}
        for plateau, side in CONTACT_SIDE.items():
            chords, offsets = both(f"contact_{side}_mm"), both(f"offset_{side}_mm")
            for direction in DIRECTIONS:
                given = chords[direction]
                chord[direction, plateau] = np.where(np.isnan(given), width[direction], given)
                offset[direction, plateau] = np.nan_to_num(offsets[direction])

        return cls(
            density=both("density_per_mm"),
            width=width,
            chord=chord,
            offset=offset,
            closing=np.array([values[column] for column in CLOSING]).reshape(
                len(CLOSING), len(table)
            ),
            balanced=balanced,
            lateral_height=np.nan_to_num(values["lateral_height_mm"]),
            forms=tuple(rows_by_form(table.sections)),
        )

    def half_chord(self, direction: Direction, plateau: str) -> np.ndarray:
        """Half the contact chord, mm."""
        return self.chord[direction, plateau] / 2

    def between_half_chord(self, direction: Direction) -> np.ndarray:
        """The mean of a direction's half chords, mm: where the section between crossings is split."""
        return (self.chord[direction, "high"] + self.chord[direction, "low"]) / 4

    def crimp(self, direction: Direction) -> np.ndarray:
        """Measured crimp of a direction, a balanced row's weft crimp for its warp."""
        weft, warp = self.closing[:2]
        return weft if direction is Direction.WEFT else np.where(self.balanced, weft, warp)
