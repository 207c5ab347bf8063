"""The columns of the family tables, each stated once: its kind, unit, bound and other units it may be written in."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace

from ..section.forms import FORMS
from ..weave.directions import DIRECTIONS


@dataclass(frozen=True)
class Bound:
    """What a number, or an array of them, must keep: ``broken(value, 0)`` where it does not, and how to say so."""

    word: str
    broken: Callable


ABOVE_0 = Bound("not above 0", operator.le)
NOT_BELOW_0 = Bound("below 0", operator.lt)


@dataclass(frozen=True)
class Column:
    """One column of numbers as it is written: its unit and bound, and the column and factor it is kept by."""

    name: str
    unit: str
    bound: Bound = ABOVE_0
    per_direction: bool = False
    # (name, unit, factor to the kept)
    others: tuple[tuple[str, str, float], ...] = field(default=(), repr=False)
    kept: str = ""
    factor: float = 1.0

    def in_direction(self, direction: str) -> Column:
        """The column of one direction."""
        others = tuple((f"{direction}_{name}", unit, factor) for name, unit, factor in self.others)
        return replace(self, name=f"{direction}_{self.name}", others=others)

    def as_written(self) -> Iterator[Column]:
        """The column and those in other units."""
        yield replace(self, kept=self.name)
        for name, unit, factor in self.others:
            yield replace(self, name=name, unit=unit, others=(), kept=self.name, factor=factor)

    def of_std(self) -> Column:
        """The column of its standard deviation, which may be 0."""
        return replace(
            self, name=f"{self.name}_std", kept=f"{self.kept}_std", bound=NOT_BELOW_0, others=()
        )


_PER_CM_AND_INCH = (("density_per_cm", "1/cm", 0.1), ("density_per_inch", "1/inch", 1 / 25.4))

QUANTITIES = (
    Column("density_per_mm", "1/mm", per_direction=True, others=_PER_CM_AND_INCH),
    Column("width_mm", "mm", per_direction=True),
    Column("crimp", "", per_direction=True, others=(("crimp_percent", "%", 0.01),)),
    Column("thickness_mm", "mm", per_direction=True),
    Column("contact_top_mm", "mm", per_direction=True),
    Column("contact_bottom_mm", "mm", per_direction=True),
    Column("offset_top_mm", "mm", NOT_BELOW_0, per_direction=True),
    Column("offset_bottom_mm", "mm", NOT_BELOW_0, per_direction=True),
    Column("linear_density_tex", "tex", per_direction=True),
    Column("fabric_thickness_mm", "mm"),
    Column("lateral_height_mm", "mm"),
    Column("fibre_density_g_cm3", "g/cm3"),
)
"""What may be measured, in the unit it is kept in."""


def _written() -> Iterator[Column]:
    """Every column of numbers, as it may be written, without the standard deviations."""
    alike = [quantity for quantity in QUANTITIES if quantity.per_direction]
    single = [quantity for quantity in QUANTITIES if not quantity.per_direction]

    for direction in DIRECTIONS:
        for quantity in alike:
            yield from quantity.in_direction(direction).as_written()
    for quantity in single:
        yield from quantity.as_written()


_VALUES = tuple(_written())
NUMBERS = {column.name: column for column in (*_VALUES, *(value.of_std() for value in _VALUES))}
"""Every column of numbers by the name it is written with, values first."""

PER_DIRECTION = tuple(quantity.name for quantity in QUANTITIES if quantity.per_direction)

MEASURED = tuple(column.name for column in _VALUES if column.kept == column.name)
"""Columns that hold a measured number, in the unit they are kept in."""

STD = tuple(f"{name}_std" for name in MEASURED)

OTHER_UNITS = {
    column.name: (column.kept, column.factor)
    for column in NUMBERS.values()
    if column.kept != column.name
}
"""Columns in other units: the column a quantity is kept in, and the factor to its unit."""

FREE_TEXTS = ("source", "notes")
SECTIONS = FORMS.keys()
"""The words of all section forms; that of rows which name none comes first."""

FLOAT_GAPS = ("symmetric", "flat")
"""Sections between two crossings of one float: symmetric (Fig. 13b) or that of a flat contact (Fig. 13a)."""

CHOICES: Mapping[str, Collection[str]] = {
    "section": SECTIONS,
    "float_gap": FLOAT_GAPS,
    "thicker": DIRECTIONS,
}
"""Columns of texts that are one of a few."""

TEXTS = ("name", *CHOICES, *FREE_TEXTS)

WEAVE_COLUMNS: Mapping[str, tuple[str, ...]] = {
    "plain": (),
    "twill": ("over", "under"),
    "satin": ("harness", "step"),
    "pattern": ("pattern",),
}
"""Columns of a family's weave: whole numbers, or the pattern as a text."""

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,79}")
_RESERVED = {"families", "con", "prn", "aux", "nul"} | {
    f"{port}{n}" for port in ("com", "lpt") for n in range(10)
}


def is_safe_name(name: str) -> bool:
    """True where a text may name a row, and so its files and folder, on every system."""
    return bool(_NAME.fullmatch(name)) and name.lower() not in _RESERVED


def kept_column(column: str) -> tuple[str, float]:
    """The column in which a measurement is kept, and the factor from the written unit to its own."""
    return OTHER_UNITS.get(column, (column, 1.0))


def needed_columns(family: str) -> tuple[str, ...]:
    """The columns without which no table of a family is one."""
    return ("name", *WEAVE_COLUMNS[family], "weft_density_per_mm", "weft_width_mm")


def known_columns(family: str) -> list[str]:
    """Every column that a family's table may have."""
    return [*TEXTS, *WEAVE_COLUMNS[family], *MEASURED, *STD, *OTHER_UNITS]
