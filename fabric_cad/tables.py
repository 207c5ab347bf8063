"""Family tables: reading what was measured, in every dialect a spreadsheet writes.

One CSV per weave type, one row per fabric. A table is read whole: everything that is wrong
in it is listed in one :class:`~fabric_cad.errors.InputError`.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from .errors import InputError, Problem, did_you_mean, read_input
from .patterns import read_pattern
from .weaves import DIRECTIONS, FAMILIES, Weave, pattern_faults, weave_of

WEAVE_COLUMNS = {"plain": (), "twill": ("over", "under"), "satin": ("harness", "step"), "pattern": ("pattern",)}

_PER_DIRECTION = (
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
    *(f"{direction}_{quantity}" for direction in DIRECTIONS for quantity in _PER_DIRECTION),
    "fabric_thickness_mm",
    "lateral_height_mm",
    "fibre_density_g_cm3",
)
"""Columns that hold a measured number, in the unit they are kept in."""

_STD = tuple(f"{name}_std" for name in MEASURED)

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

_STD_WRITTEN = {*_STD, *(written for written in OTHER_UNITS if written.endswith("_std"))}
_MAY_BE_ZERO = {name for name in MEASURED if "_offset_" in name} | _STD_WRITTEN

TEXTS = ("name", "section", "thicker", "source", "notes")
SECTIONS = ("lenticular", "flat", "round")

MOST_YARNS = 100
"""Largest float or harness a table may ask for, and most wefts or warps of a pattern."""

_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,79}")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_WHOLE = re.compile(r"\d{1,4}")
_RESERVED = {"families", "con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in range(10)}


def is_safe_name(name: str) -> bool:
    """True where a text may name a row, and so its files and folder, on every system."""
    return bool(_NAME.fullmatch(name)) and name.lower() not in _RESERVED


@dataclass(frozen=True, eq=False)
class Family:
    """The rows of one family table, as measured; every array has shape (rows,).

    ``measured`` maps each name of :data:`MEASURED` to an array in mm, 1/mm, tex, g/cm3 or
    (crimp) a plain ratio, NaN where the cell was empty; ``scatter`` maps the same names to
    the standard deviations of the ``*_std`` columns, in the same units. ``table[name]`` is
    the table of that one row, ``len(table)`` the number of rows.
    """

    family: str
    path: str
    names: tuple[str, ...]
    lines: tuple[int, ...]
    weaves: tuple[Weave, ...]
    measured: dict[str, np.ndarray]
    scatter: dict[str, np.ndarray]
    sections: tuple[str, ...]
    thicker: tuple[str, ...]
    sources: tuple[str, ...]
    notes: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.names)

    def __getitem__(self, name: str) -> Family:
        """The table that holds the row ``name`` only. Raises KeyError."""
        try:
            at = self.names.index(name)
        except ValueError:
            raise KeyError(name) from None
        return self.take([at])

    def take(self, rows: Sequence[int]) -> Family:
        """The table of the rows with these numbers, in this order."""

        def taken(value):
            if isinstance(value, dict):
                return {column: values[rows] for column, values in value.items()}
            return tuple(value[at] for at in rows) if isinstance(value, tuple) else value

        return Family(**{each.name: taken(getattr(self, each.name)) for each in fields(self)})

    @property
    def balanced(self) -> np.ndarray:
        """Boolean (rows,): True where every warp cell is empty."""
        return np.all([np.isnan(self.measured[f"warp_{q}"]) for q in _PER_DIRECTION], axis=0)

    @property
    def scattered(self) -> np.ndarray:
        """Boolean (rows,): True where any standard deviation is given."""
        return ~np.all([np.isnan(values) for values in self.scatter.values()], axis=0)

    def problem(self, at: int, column: str, message: str) -> Problem:
        """A :class:`Problem` placed at a column of row number ``at``."""
        return Problem(message, self.path, self.lines[at], column, self.names[at])


def read_family(path: str | Path) -> Family:
    """Read one family table; the weave type is the file's name (``twill.csv``).

    Raises :class:`InputError` with every problem of the table: unreadable file, unknown or
    missing column, bad name, text or a bound broken where a number belongs.
    """
    path = Path(path)
    if path.stem not in FAMILIES:
        known = ", ".join(f"{family}.csv" for family in FAMILIES)
        raise InputError(Problem(f"not a family table; those are {known}", str(path)))
    return _TableReader(path).read()


def read_families(folder: str | Path) -> dict[str, Family | InputError]:
    """Read every family table of a folder; a table with problems is given as its error.

    Row names are unique over all tables: a name used again is a problem of the table that
    comes later. Raises :class:`InputError` where there is no folder or no table in it.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(
            Problem(
                "no such folder of family tables; 'fabric-cad init' puts the shipped ones into ./families",
                str(folder),
            )
        )
    tables: dict[str, Family | InputError] = {}
    seen: dict[str, str] = {}
    for family in FAMILIES:
        path = folder / f"{family}.csv"
        if not path.exists():
            continue
        try:
            table = read_family(path)
        except InputError as error:
            tables[family] = error
            continue
        repeated = [
            table.problem(at, "name", f"this row name is also at {seen[name.lower()]}")
            for at, name in enumerate(table.names)
            if name.lower() in seen
        ]
        tables[family] = InputError(repeated) if repeated else table
        for name, line in zip(table.names, table.lines):
            seen.setdefault(name.lower(), f"{table.path}:{line}")
    if not tables:
        known = ", ".join(f"{family}.csv" for family in FAMILIES)
        raise InputError(Problem(f"no family table in this folder ({known})", str(folder)))
    return tables


class _TableReader:
    """Reads one table, gathering problems as it goes."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.family = path.stem
        self.problems: list[Problem] = []
        self.names_seen: dict[str, int] = {}
        self.whole = WEAVE_COLUMNS[self.family]

    def wrong(self, message: str, line: int | None = None, column: str | None = None, row: str | None = None) -> None:
        self.problems.append(Problem(message, str(self.path), line, column, row))

    def stop_if_wrong(self) -> None:
        if self.problems:
            raise InputError(self.problems)

    def read(self) -> Family:
        records = self.records()
        header_line, header = next(records, (None, None))
        if header is None:
            self.wrong("the table is empty: no header line")
            self.stop_if_wrong()
        self.check_header(header_line, header)
        self.stop_if_wrong()
        rows = [row for line, cells in records if (row := self.row(header, line, cells)) is not None]
        self.stop_if_wrong()
        measured = {column: np.array([row[column] for row in rows], dtype=float) for column in MEASURED}
        return Family(
            family=self.family,
            path=str(self.path),
            names=tuple(row["name"] for row in rows),
            lines=tuple(row["line"] for row in rows),
            weaves=tuple(weave_of(self.family, row) for row in rows),
            measured=measured,
            scatter={column: np.array([row[std] for row in rows], dtype=float) for column, std in zip(MEASURED, _STD)},
            sections=tuple(row["section"] or "lenticular" for row in rows),
            thicker=tuple(row["thicker"] for row in rows),
            sources=tuple(row["source"] for row in rows),
            notes=tuple(row["notes"] for row in rows),
        )

    def records(self):
        """(line number, cells) of every line that holds something, header first."""
        raw = read_input(self.path)
        try:
            text = raw.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = raw[: error.start].count(b"\n") + 1
            self.wrong("not UTF-8 text; save the table as 'CSV UTF-8'", line)
            self.stop_if_wrong()
        lines = re.split(r"\r\n|\r|\n", text)
        # comments are blanked, not dropped, so that line numbers stay those of the file
        lines = ["" if line.lstrip().startswith("#") else line for line in lines]
        first = next((line for line in lines if line.strip()), "")
        self.separator = ","
        if re.fullmatch(r"\s*\"?sep=(.)\"?[;,\t]*\s*", first, re.IGNORECASE):  # Excel's own hint
            self.separator = re.search(r"sep=(.)", first, re.IGNORECASE)[1]
            lines[lines.index(first)] = ""
        else:
            self.separator = next((s for s in ";\t" if s in first), ",")
        # ended again, so that line breaks inside a quoted cell stay
        reader = csv.reader((line + "\n" for line in lines), delimiter=self.separator, skipinitialspace=True)
        line = 1
        try:
            for cells in reader:
                cells = [cell.strip() for cell in cells]
                if any(cells) and not cells[0].startswith("#"):
                    yield line, cells
                line = reader.line_num + 1
        except csv.Error as error:
            self.wrong(f"not a CSV line: {error}", reader.line_num)
            self.stop_if_wrong()

    def check_header(self, line: int, header: list[str]) -> None:
        while header and not header[-1]:
            header.pop()
        known = [*TEXTS, *self.whole, *MEASURED, *_STD, *OTHER_UNITS]
        for column in header:
            if column in known:
                if header.count(column) > 1:
                    self.wrong("this column stands twice in the header", line, column)
                continue
            hint = did_you_mean(column.lower(), known, cutoff=0.3)
            self.wrong(f"unknown column of {self.family}.csv{hint}", line, column or "(empty)")
        self.problems = list(dict.fromkeys(self.problems))
        for column in ("name", *self.whole):
            if column not in header:
                self.wrong("this column is missing", line, column)
        for quantity in ("density_per_mm", "width_mm"):
            column = f"weft_{quantity}"
            written = [column, *(other for other, (kept, _) in OTHER_UNITS.items() if kept == column)]
            if not any(name in header for name in written):
                self.wrong("this column is missing", line, column)

    def row(self, header: list[str], line: int, cells: list[str]) -> dict | None:
        """One row's values by column, or None where the cells do not fit the header."""
        while len(cells) > len(header) and not cells[-1]:
            cells.pop()
        texts = dict(zip(header, cells))
        name = texts.get("name", "")
        if len(cells) > len(header):
            hint = " (a decimal comma needs ';' as the separator)" if self.separator == "," else ""
            self.wrong(f"{len(cells)} cells where the header has {len(header)}{hint}", line, row=name)
            return None
        row = dict.fromkeys((*MEASURED, *_STD), math.nan) | dict.fromkeys(TEXTS, "")
        row["line"] = line
        row |= {column: texts[column] for column in TEXTS if column in texts}
        before = len(self.problems)
        self.check_name(name, line)
        for column, text in texts.items():
            if column == "pattern":
                row[column] = self.pattern(text, line, column, name)
            elif column in self.whole:
                row[column] = self.whole_number(text, line, column, name)
            elif text and column not in TEXTS:
                kept, factor = OTHER_UNITS.get(column, (column, 1.0))
                if not math.isnan(row[kept]):
                    self.wrong("this quantity is given twice, in two units", line, column, name)
                row[kept] = self.number(text, line, column, name) * factor
        if row["section"] not in ("", *SECTIONS):
            self.wrong(f"{row['section']!r} is none of {', '.join(SECTIONS)}", line, "section", name)
        if row["thicker"] not in ("", *DIRECTIONS):
            self.wrong(f"{row['thicker']!r} is none of {', '.join(DIRECTIONS)}", line, "thicker", name)
        self.check_weave(row, line, name)
        filled = {column for column, text in texts.items() if text}
        self.check_scatter([column for column in header if column in filled & _STD_WRITTEN], filled, line, name)
        self.check_geometry(row, filled, line, name)
        return row if len(self.problems) == before else None

    def check_name(self, name: str, line: int) -> None:
        if not name:
            self.wrong("the row has no name", line, "name")
        elif not is_safe_name(name):
            self.wrong(
                f"{name!r} is no safe file name: letters, digits, '_' and '-' only, not '-' first, "
                "at most 80 characters, and no name a system keeps for itself",
                line,
                "name",
            )
        elif name.lower() in self.names_seen:
            self.wrong(f"this row name is also at line {self.names_seen[name.lower()]}", line, "name", name)
        self.names_seen.setdefault(name.lower(), line)

    def number(self, text: str, line: int, column: str, name: str) -> float:
        if self.separator != ",":
            text = text.replace(",", ".")
        elif re.fullmatch(r"[+-]?\d+,\d+", text):
            self.wrong(
                f"{text} has a decimal comma in a comma-separated file; write {text.replace(',', '.')}",
                line,
                column,
                name,
            )
            return math.nan
        if not _NUMBER.fullmatch(text) or not math.isfinite(float(text)):
            percent = re.sub(r"crimp(_std)?$", r"crimp_percent\1", column)
            hint = f"; use the column {percent}" if text.endswith("%") and percent != column else ""
            self.wrong(f"{text!r} is not a number{hint}", line, column, name)
            return math.nan
        value = float(text)
        if value < 0 or (value == 0 and column not in _MAY_BE_ZERO):
            bound = "below 0" if column in _MAY_BE_ZERO else "not above 0"
            self.wrong(f"{text} is {bound}", line, column, name)
            return math.nan
        return value

    def whole_number(self, text: str, line: int, column: str, name: str) -> int:
        text = re.sub(r"[.,]0+$", "", text)
        if not _WHOLE.fullmatch(text):
            self.wrong(f"{text!r} is not a whole number" if text else "this cell is empty", line, column, name)
            return 0
        if not 1 <= int(text) <= MOST_YARNS:
            self.wrong(f"{text} is not between 1 and {MOST_YARNS}", line, column, name)
        return int(text)

    def pattern(self, text: str, line: int, column: str, name: str) -> tuple[str, ...]:
        try:
            pattern = read_pattern(text)
        except ValueError as error:
            self.wrong(str(error), line, column, name)
            return ()
        wefts, warps = len(pattern), max(map(len, pattern), default=0)
        if not pattern:
            self.wrong("this cell is empty", line, column, name)
        elif wefts == 1:
            message = f"{text!r} is one weft only; part the wefts by a space, / or |"
            self.wrong(message, line, column, name)
        elif max(wefts, warps) > MOST_YARNS:
            message = f"{wefts} wefts x {warps} warps are more than {MOST_YARNS} in a direction"
            self.wrong(message, line, column, name)
        else:
            digits = "0" in text or "1" in text
            hint = "; a spreadsheet drops the zeros a number starts with: write o and u for 1 and 0" if digits else ""
            uneven = len(set(map(len, pattern))) > 1
            for fault in pattern_faults(pattern):
                self.wrong(fault + hint * uneven, line, column, name)
        return pattern

    def check_weave(self, row: dict, line: int, name: str) -> None:
        if self.family != "satin":
            return
        harness, step = row["harness"], row["step"]
        if not (harness and step):
            return  # told already
        if harness < 3:
            self.wrong(f"{harness} is not at least 3", line, "harness", name)
        elif step >= harness:
            self.wrong(f"{step} is not below the harness {harness}", line, "step", name)
        elif math.gcd(harness, step) != 1:
            self.wrong(f"{step} is not coprime to the harness {harness}", line, "step", name)

    def check_scatter(self, given: list[str], filled: set[str], line: int, name: str) -> None:
        """A standard deviation belongs to a measured value; ``given`` are the columns that hold one."""
        filled = {OTHER_UNITS.get(column, (column, 1.0))[0] for column in filled}
        for column in given:
            if OTHER_UNITS.get(column, (column, 1.0))[0].removesuffix("_std") not in filled:
                message = f"a standard deviation without its value; {column.removesuffix('_std')} is empty"
                self.wrong(message, line, column, name)

    def check_geometry(self, row: dict, filled: set[str], line: int, name: str) -> None:
        """Bounds between cells of one row that need no model; ``filled`` names its columns with a text."""
        filled = {OTHER_UNITS.get(column, (column, 1.0))[0] for column in filled}
        balanced = not any(f"warp_{quantity}" in filled for quantity in _PER_DIRECTION)
        for direction in ("weft",) if balanced else DIRECTIONS:
            for quantity in ("density_per_mm", "width_mm"):
                if f"{direction}_{quantity}" not in filled:
                    hint = " (leave every warp cell empty for a balanced fabric)" if direction == "warp" else ""
                    self.wrong(f"this cell is empty{hint}", line, f"{direction}_{quantity}", name)
            width, spacing = row[f"{direction}_width_mm"], 1 / row[f"{direction}_density_per_mm"]
            if width >= spacing:
                message = f"{width:g} is not below the {direction} spacing {spacing:.4g} mm"
                self.wrong(message, line, f"{direction}_width_mm", name)
        lateral = row["lateral_height_mm"]
        if row["section"] == "flat" and "lateral_height_mm" not in filled:
            self.wrong(
                "this cell is empty; a flat section needs the height of its sides", line, "lateral_height_mm", name
            )
        if row["section"] != "flat" and not math.isnan(lateral):
            message = f"{lateral:g} has no meaning for a {row['section'] or 'lenticular'} section; write flat"
            self.wrong(message, line, "lateral_height_mm", name)
        for direction in ("weft",) if balanced else DIRECTIONS:
            for side in ("top", "bottom"):
                self.check_contact(row, direction, side, line, name)

    def check_contact(self, row: dict, direction: str, side: str, line: int, name: str) -> None:
        """Bounds of a contact chord c_t, c_b and offset d_c."""
        column, width = f"{direction}_contact_{side}_mm", row[f"{direction}_width_mm"]
        chord = width if math.isnan(row[column]) else row[column]
        if chord > width:
            self.wrong(f"{chord:g} is above the {direction} width {width:g} mm", line, column, name)
        elif row["section"] == "round" and chord == width:
            message = f"a round section needs a contact chord below its width {width:g} mm"
            self.wrong(message, line, column, name)
        offset = row[f"{direction}_offset_{side}_mm"]
        if offset >= chord / 2:
            message = f"{offset:g} is not below half the contact chord, {chord / 2:g} mm"
            self.wrong(message, line, f"{direction}_offset_{side}_mm", name)
