"""The solved family table: every control point and conic parameter that drives a master.

Columns, for weft and warp alike (``weft_...``, ``warp_...``), mm and 1/mm:

``crossed_spacing_mm``      a, spacing of the yarns it crosses
``width_mm, thickness_mm``  c, b of its own section's envelope rectangle
``crimp, slope, amplitude_mm``   e, s, A
``M11_x_mm ... M16_z_mm``   control points of the weft, ``M21_y_mm ... M26_z_mm`` of the warp
``p11, p12, p21, p22``      parabolas of (1), (2) at the first and second plateau, signed
``<plateau>_chord_mm, _offset_mm``  contact chord and d_c of its own contact side at the ``low``
                            plateau (its top touches) and at the ``high`` one (its bottom)
``<plateau>_<kind>_q``, ``_v0_mm``, ``_left_mm``, ``_right_mm``  free side of the contact section at
                            that plateau, kind ``float``, ``edge`` (turn on the right), ``turn``
``between_q``, ``between_end_mm``   both sides of the section between crossings

and for both directions ``float_gap``: between two crossings of one float the section is the
``symmetric`` one of the line above, or that of a ``flat`` contact, which is the crossings' own of
the kind ``float``.
"""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..measured.columns import FLOAT_GAPS
from ..section.forms import FORMS, Form
from ..section.frame import KINDS, ContactSide, Frame, FreeSide, Split
from ..support.errors import ArgumentError, InputError, Problem, UnknownRowError, did_you_mean
from ..support.numerals import number as number_of
from ..support.numerals import whole
from ..weave.lattice import Lattice
from ..weave.weaves import Weave

PLATEAUX = ("low", "high")


def point_columns(direction: str) -> list[tuple[str, str, str]]:
    """(point, along column, height column) of a direction's six control points."""
    number, axis = (1, "x") if direction == "weft" else (2, "y")
    return [(f"M{number}{k}", f"M{number}{k}_{axis}_mm", f"M{number}{k}_z_mm") for k in range(1, 7)]


@dataclass(frozen=True)
class SolvedDirection:
    """Solved parameters of the wefts or the warps; lengths mm, parabolas 1/mm.

    ``points`` are the six control points (along, z) of Fig. 16 in the paper's frame:
    M11 ... M16 start in the middle of the weft's low float, M21 ... M26 in that of the
    warp's high one. ``p_low``, ``p_high`` are positive. ``contact`` maps the plateau,
    ``free_sides`` (plateau, kind); ``between`` is the section between crossings.
    """

    crossed_spacing: float
    width: float
    thickness: float
    crimp: float
    slope: float
    amplitude: float
    p_low: float
    p_high: float
    points: tuple[tuple[float, float], ...]
    contact: Mapping[str, ContactSide]
    free_sides: Mapping[tuple[str, str], FreeSide]
    between: FreeSide

    @property
    def z_low(self) -> float:
        """Height of the midline on the low plateau."""
        return min(self.points[0][1], self.points[-1][1])

    @property
    def z_high(self) -> float:
        """Height of the midline on the high plateau."""
        return max(self.points[0][1], self.points[-1][1])


@dataclass(frozen=True)
class SolvedFabric:
    """One row of a solved table.

    ``float_gap`` is one of :data:`~fabric_cad.measured.columns.FLOAT_GAPS`.
    """

    name: str
    family: str
    weave: Weave
    section: str
    lateral_height: float
    float_gap: str
    fabric_thickness: float
    weft: SolvedDirection
    warp: SolvedDirection

    @property
    def directions(self) -> dict[str, SolvedDirection]:
        """The parameters of the wefts and of the warps."""
        return {"weft": self.weft, "warp": self.warp}

    def crossed(self, direction: str) -> SolvedDirection:
        """The other direction: that of the yarns which ``direction`` crosses."""
        return self.warp if direction == "weft" else self.weft

    @property
    def form(self) -> Form:
        """The form of its sections."""
        return FORMS[self.section]

    def frame(self, direction: str) -> Frame:
        """What all sections of a direction share."""
        solved = self.directions[direction]
        bottom, top = (
            Split(solved.contact[plateau].half_chord, solved.contact[plateau].offset)
            for plateau in ("high", "low")
        )
        return Frame(solved.width, solved.thickness, self.form, self.lateral_height, bottom, top)

    @property
    def period(self) -> tuple[float, float]:
        """Extents of the elementary cell along x and y, mm."""
        return (
            self.weave.warps * self.weft.crossed_spacing,
            self.weave.wefts * self.warp.crossed_spacing,
        )

    @property
    def lattice(self) -> Lattice:
        """How the cell repeats: as woven, its directions are the axes of space."""
        return Lattice.axis_parallel(*self.period)

    @classmethod
    def from_row(cls, row: Mapping[str, object]) -> SolvedFabric:
        """A fabric from one row of a solved table, cells as text or numbers. Raises KeyError, ValueError."""
        cells = _Cells(row)
        over, under, step = (whole(cells.text(column)) for column in ("over", "under", "step"))
        return cls(
            name=cells.text("name"),
            family=cells.text("family"),
            weave=Weave(over, under, step, tuple(cells.text("pattern").split())),
            section=cells.one_of("section", FORMS),
            lateral_height=cells.number("lateral_height_mm"),
            float_gap=cells.one_of(
                "float_gap", FLOAT_GAPS, default=FLOAT_GAPS[0]
            ),  # older tables have none
            fabric_thickness=cells.number("fabric_thickness_mm"),
            weft=cells.direction("weft", "warp"),
            warp=cells.direction("warp", "weft"),
        )


_FREE_SIDE = ("q", "v0_mm", "left_mm", "right_mm")


@dataclass(frozen=True)
class _Cells:
    """One row of a solved table, read as a fabric's parts."""

    row: Mapping[str, Any]

    def text(self, column: str) -> str:
        return str(self.row[column])

    def number(self, column: str) -> float:
        value = self.row[column]
        return number_of(value) if isinstance(value, str) else float(value)

    def one_of(self, column: str, choices: Collection[str], default: str = "") -> str:
        word = str(self.row.get(column) or default) if default else self.text(column)
        if word not in choices:
            raise ValueError(f"{column}: {word!r} is none of {', '.join(choices)}")
        return word

    def parabola(self, direction: str, plateau: str) -> float:
        """p at a plateau, without its sign, 1/mm: the weft starts on the low one, the warp on the high one."""
        first = "low" if direction == "weft" else "high"
        return abs(self.number(f"p{1 if direction == 'weft' else 2}{1 if plateau == first else 2}"))

    def contact(self, direction: str, crossed: str, plateau: str) -> ContactSide:
        """What a direction touches with at a plateau is the trajectory of the yarns it crosses at their other one."""
        return ContactSide(
            p=self.parabola(crossed, "high" if plateau == "low" else "low"),
            offset=self.number(f"{direction}_{plateau}_offset_mm"),
            half_chord=self.number(f"{direction}_{plateau}_chord_mm") / 2,
        )

    def free_side(self, direction: str, plateau: str, kind: str) -> FreeSide:
        q, v0, left, right = (
            self.number(f"{direction}_{plateau}_{kind}_{name}") for name in _FREE_SIDE
        )
        return FreeSide(q, v0, left, right)

    def direction(self, name: str, crossed: str) -> SolvedDirection:
        """The parameters of the wefts or the warps."""
        end = self.number(f"{name}_between_end_mm")
        return SolvedDirection(
            crossed_spacing=self.number(f"{name}_crossed_spacing_mm"),
            width=self.number(f"{name}_width_mm"),
            thickness=self.number(f"{name}_thickness_mm"),
            crimp=self.number(f"{name}_crimp"),
            slope=self.number(f"{name}_slope"),
            amplitude=self.number(f"{name}_amplitude_mm"),
            p_low=self.parabola(name, "low"),
            p_high=self.parabola(name, "high"),
            points=tuple(
                (self.number(along), self.number(z)) for _, along, z in point_columns(name)
            ),
            contact={plateau: self.contact(name, crossed, plateau) for plateau in PLATEAUX},
            free_sides={
                (plateau, kind): self.free_side(name, plateau, kind)
                for plateau in PLATEAUX
                for kind in KINDS
            },
            between=FreeSide(self.number(f"{name}_between_q"), 0.0, -end, end),
        )


@dataclass(frozen=True)
class SolvedTable:
    """A whole solved table, column by column; every column is a list of one value a row.

    ``comparisons[row]`` lists (quantity, measured, model) of what a row measured beyond what
    identified it. ``table[name]`` is one row as :class:`SolvedFabric`, ``name in table`` whether
    there is one; iterating gives one after the other.
    """

    columns: Mapping[str, Sequence]
    comparisons: tuple[tuple[tuple[str, float, float], ...], ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the rows."""
        return tuple(self.columns["name"])

    def __len__(self) -> int:
        return len(self.columns["name"])

    def __iter__(self) -> Iterator[SolvedFabric]:
        return (self[name] for name in self.names)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def _number(self, name: str) -> int:
        """The number of a row. Raises :class:`UnknownRowError`, a KeyError."""
        if not isinstance(name, str):
            raise ArgumentError(
                f"a row of a table is named by a text, not {type(name).__name__} {name!r:.60}"
            )
        if name not in self.names:
            raise UnknownRowError(f"no row is called {name!r}{did_you_mean(name, self.names)}")
        return self.names.index(name)

    def row(self, name: str) -> dict[str, object]:
        """One row as a mapping of column to value. Raises :class:`UnknownRowError`, a KeyError."""
        number = self._number(name)
        return {column: values[number] for column, values in self.columns.items()}

    def __getitem__(self, name: str) -> SolvedFabric:
        """One row as the value that drives a master. Raises :class:`UnknownRowError`, a KeyError."""
        return SolvedFabric.from_row(self.row(name))

    def only(self, name: str) -> SolvedTable:
        """The table of one row. Raises :class:`UnknownRowError`, a KeyError."""
        at = self._number(name)
        return SolvedTable(
            {c: [v[at]] for c, v in self.columns.items()}, self.comparisons[at : at + 1]
        )

    def write(self, path: str | Path) -> None:
        """Write the table as CSV; numbers so that reading gives the same bits."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(self.columns)
            writer.writerows(zip(*self.columns.values()))


def read_solved(path: str | Path, name: str | None = None) -> SolvedFabric:
    """Read one fabric from a solved table (its first row, or the row called ``name``).

    Raises :class:`InputError` where the file, the row or a value of it is missing.
    """
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise InputError(Problem(f"cannot be read: {error.strerror}", str(path))) from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(Problem(f"not a table of text: {error}", str(path))) from error

    rows = [row for row in rows if name in (None, row.get("name"))]
    if not rows:
        raise InputError(
            Problem(
                "the table has no such row" if name else "the table is empty", str(path), row=name
            )
        )

    try:
        return SolvedFabric.from_row(rows[0])
    except KeyError as error:
        raise InputError(
            Problem("this column is missing", str(path), column=str(error.args[0]))
        ) from error
    except (TypeError, ValueError) as error:
        raise InputError(Problem(str(error), str(path), row=rows[0].get("name"))) from error
