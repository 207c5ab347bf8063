"""The columns of the family tables: every one with the unit it is kept in, and which names are safe."""

from __future__ import annotations

import re

from ..weave.weaves import DIRECTIONS

WEAVE_COLUMNS = {"plain": (), "twill": ("over", "under"), "satin": ("harness", "step"), "pattern": ("pattern",)}

PER_DIRECTION = (
    "density_per_mm",
    "width_mm",
    "crimp",
    "thickness_mm",
    "contact_top_mm",
    "contact_bottom_mm",
    "offset_top_mm",
    "offset_bottom_mm",
    "linear_density_tex",
)
MEASURED = (
    *(f"{direction}_{quantity}" for direction in DIRECTIONS for quantity in PER_DIRECTION),
    "fabric_thickness_mm",
    "lateral_height_mm",
    "fibre_density_g_cm3",
)
"""Columns that hold a measured number, in the unit they are kept in."""

STD = tuple(f"{name}_std" for name in MEASURED)

OTHER_UNITS = {
    f"{direction}_{written}": (f"{direction}_{kept}", factor)
    for direction in DIRECTIONS
    for written, kept, factor in (
        ("density_per_cm", "density_per_mm", 0.1),
        ("density_per_inch", "density_per_mm", 1 / 25.4),
        ("crimp_percent", "crimp", 0.01),
    )
}
OTHER_UNITS |= {f"{written}_std": (f"{kept}_std", factor) for written, (kept, factor) in OTHER_UNITS.items()}
"""Columns in other units: the column a quantity is kept in, and the factor to its unit."""

STD_WRITTEN = {*STD, *(written for written in OTHER_UNITS if written.endswith("_std"))}
MAY_BE_ZERO = {name for name in MEASURED if "_offset_" in name} | STD_WRITTEN

TEXTS = ("name", "section", "float_gap", "thicker", "source", "notes")
SECTIONS = ("lenticular", "flat", "round")

FLOAT_GAPS = ("symmetric", "flat")
"""Sections between two crossings of one float: symmetric (Fig. 13b) or that of a flat contact (Fig. 13a)."""

MOST_YARNS = 100
"""Largest float or harness a table may ask for, and most wefts or warps of a pattern."""

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,79}")
_RESERVED = {"families", "con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in range(10)}


def is_safe_name(name: str) -> bool:
    """True where a text may name a row, and so its files and folder, on every system."""
    return bool(_NAME.fullmatch(name)) and name.lower() not in _RESERVED
