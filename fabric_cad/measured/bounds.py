"""Bounds between the measurements of one row that need no model, for whole tables of numbers.

The reader of the family tables holds the same bounds cell by cell, where the text still has its
line; here rows come from numbers, a study's samples, and are refused one by one.
"""

from __future__ import annotations

import numpy as np

from ..support.errors import Problem
from ..weave.weaves import DIRECTIONS
from .tables import MEASURED, Family


def out_of_bounds(table: Family) -> dict[int, Problem]:
    """The first bound that each row breaks, by row number; rows that keep all of them are not in it."""
    found: dict[int, Problem] = {}
    values, balanced = table.measured, table.balanced
    rounded = np.array([form == "round" for form in table.sections], dtype=bool)

    def refuse(mask: np.ndarray, column: str, message) -> None:
        for at in np.flatnonzero(mask).tolist():
            found.setdefault(at, table.problem(at, column, message(at)))

    for column in MEASURED:
        value, may_be_zero = values[column], "_offset_" in column
        word = "below 0" if may_be_zero else "not above 0"
        refuse(~np.isfinite(value) & ~np.isnan(value), column, lambda at: f"{value[at]:g} is not a number")
        refuse(value < 0 if may_be_zero else value <= 0, column, lambda at: f"{value[at]:g} is {word}")
    for d in DIRECTIONS:
        there = np.ones(len(table), dtype=bool) if d == "weft" else ~balanced
        width, density = values[f"{d}_width_mm"], values[f"{d}_density_per_mm"]
        for column in (f"{d}_density_per_mm", f"{d}_width_mm"):
            refuse(there & np.isnan(values[column]), column, lambda at: "this cell is empty")
        with np.errstate(all="ignore"):
            spacing = 1 / density
            refuse(
                there & (width >= spacing),
                f"{d}_width_mm",
                lambda at: f"{width[at]:g} is not below the {d} spacing {spacing[at]:.4g} mm",
            )
    lateral, flat = values["lateral_height_mm"], np.array([form == "flat" for form in table.sections], dtype=bool)
    refuse(
        flat & np.isnan(lateral),
        "lateral_height_mm",
        lambda at: "this cell is empty; a flat section needs the height of its sides",
    )
    refuse(
        ~flat & ~np.isnan(lateral),
        "lateral_height_mm",
        lambda at: f"{lateral[at]:g} has no meaning for a {table.sections[at]} section; write flat",
    )
    for d in DIRECTIONS:
        width = values[f"{d}_width_mm"]
        for side in ("top", "bottom"):
            column, given = f"{d}_contact_{side}_mm", values[f"{d}_contact_{side}_mm"]
            chord = np.where(np.isnan(given), width, given)
            refuse(chord > width, column, lambda at: f"{chord[at]:g} is above the {d} width {width[at]:g} mm")
            refuse(
                rounded & (chord == width),
                column,
                lambda at: f"a round section needs a contact chord below its width {width[at]:g} mm",
            )
            column, offset = f"{d}_offset_{side}_mm", values[f"{d}_offset_{side}_mm"]
            refuse(
                offset >= chord / 2,
                column,
                lambda at: f"{offset[at]:g} is not below half the contact chord, {chord[at] / 2:g} mm",
            )
    return found
