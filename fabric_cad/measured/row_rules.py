"""The rules of one row of a family table: from the texts of its cells to its values, or to all that is wrong."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from ..support.errors import Place, Problem, did_you_mean, quoted
from ..support.numerals import number, whole
from ..weave.patterns import read_pattern, size_fault
from ..weave.weaves import DIRECTIONS, pattern_faults
from .columns import (
    FLOAT_GAPS,
    MAY_BE_ZERO,
    MEASURED,
    MOST_YARNS,
    OTHER_UNITS,
    PER_DIRECTION,
    SECTIONS,
    STD,
    STD_WRITTEN,
    TEXTS,
    WEAVE_COLUMNS,
    is_safe_name,
)
from .records import Record

FREE_TEXTS = ("source", "notes")


def header_problems(family: str, header: Sequence[str], place: Place, line: int | None) -> list[Problem]:
    """What is wrong with the header of a family's table: unknown, repeated and missing columns."""
    whole_columns = WEAVE_COLUMNS[family]
    known = [*TEXTS, *whole_columns, *MEASURED, *STD, *OTHER_UNITS]
    problems = []
    for column in header:
        if column not in known:
            hint = did_you_mean(column.lower(), known, cutoff=0.3)
            problems.append(place.problem(f"unknown column of {family}.csv{hint}", line, column or "(empty)"))
        elif header.count(column) > 1:
            problems.append(place.problem("this column stands twice in the header", line, column))

    for column in ("name", *whole_columns, "weft_density_per_mm", "weft_width_mm"):
        written = [column, *(other for other, (kept, _) in OTHER_UNITS.items() if kept == column)]
        if not any(name in header for name in written):
            problems.append(place.problem("this column is missing", line, column))
    return list(dict.fromkeys(problems))


class RowReader:
    """Reads row after row under one header; ``problems`` gathers what is wrong with the one being read."""

    def __init__(self, family: str, header: Sequence[str], place: Place, separator: str = "") -> None:
        self.family, self.header, self.place, self.separator = family, header, place, separator
        self.weave_columns = WEAVE_COLUMNS[family]
        self.names_seen: dict[str, int | None] = {}
        self.problems: list[Problem] = []
        self.line: int | None = None
        self.name = ""

    def wrong(self, message: str, column: str | None = None, row: str | None = None) -> None:
        self.problems.append(self.place.problem(message, self.line, column, self.name if row is None else row))

    def read(self, record: Record) -> tuple[dict, list[Problem]]:
        """One row's values by column, and all that is wrong with it: where that is anything, no row."""
        self.problems, self.line, width = [], record.line, len(self.header)
        texts = dict(zip(self.header, [*record.cells, *[""] * width]))
        self.name = texts["name"]
        filled = [place for place, text in enumerate(record.cells) if text or place in record.faults]
        if filled and filled[-1] >= width:
            hint = " (a decimal comma needs ';' as the separator)" if self.separator == "," else ""
            self.wrong(f"{filled[-1] + 1} cells where the header has {width}{hint}")
            return {}, self.problems

        self.check_name()
        texts = self.without_faults(texts, record)
        row = self.values(texts)
        self.check_choices(row)
        self.check_satin(row)
        self.check_scatter(texts)
        self.check_geometry(row, texts)
        return row, self.problems

    def without_faults(self, texts: dict[str, str | None], record: Record) -> dict[str, str | None]:
        """The texts, None in place of a cell of a workbook that is refused for what it is."""
        sound: dict[str, str | None] = dict(texts)
        for place, column in enumerate(self.header):
            fault = record.faults.get(place)
            if column in FREE_TEXTS:
                fault = None if texts[column] else fault  # a date is as good a note as any
            elif column == "pattern" and place in record.numbers:
                fault = (
                    f"{texts[column]} is a number, of which a spreadsheet drops the zeros it starts with; "
                    "write o and u for 1 and 0"
                )
            elif column.removesuffix("_std").endswith("_percent") and place in record.percents:
                fault = (
                    "the cell has the format percent, in which 0.4 % is the number 0.004, and its column counts in "
                    "percent already; give it the format number, and enter it again"
                )
            else:
                fault = fault or record.merged.get(place)
            if fault:
                self.wrong(fault, column)
                sound[column] = None
        return sound

    def values(self, texts: dict[str, str | None]) -> dict:
        """The values of the cells, by the column they are kept in."""
        row: dict = dict.fromkeys((*MEASURED, *STD), math.nan) | dict.fromkeys(TEXTS, "")
        row |= {column: texts[column] or "" for column in TEXTS if column in texts}
        row |= dict.fromkeys(self.weave_columns)
        for column, text in texts.items():
            if column in TEXTS or text is None:
                continue
            if column == "pattern":
                row[column] = self.pattern(text)
            elif column in self.weave_columns:
                row[column] = self.whole_number(text, column)
            elif text:
                kept, factor = OTHER_UNITS.get(column, (column, 1.0))
                if not math.isnan(row[kept]):
                    self.wrong("this quantity is given twice, in two units", column)
                row[kept] = self.measurement(text, column, factor)
        return row

    def check_name(self) -> None:
        name = self.name
        if not name:
            self.wrong("the row has no name", "name", row="")
        elif not is_safe_name(name):
            self.wrong(
                f"{quoted(name)} is no safe file name: letters, digits, '_' and '-' only, not '-' first, "
                "at most 80 characters, and no name a system keeps for itself",
                "name",
                row="",
            )
        elif name.lower() in self.names_seen:
            word = "row" if self.place.sheet else "line"
            self.wrong(f"this row name is also at {word} {self.names_seen[name.lower()]}", "name")
        self.names_seen.setdefault(name.lower(), self.line)

    def measurement(self, text: str, column: str, factor: float) -> float:
        """The number of a cell in the unit it is kept in, NaN where it is none or out of bounds."""
        try:
            value = number(self.with_point(text)) * factor
        except ValueError:
            self.wrong(self.no_number(text, column), column)
            return math.nan

        if value < 0 or (value == 0 and column not in MAY_BE_ZERO):
            bound = "below 0" if column in MAY_BE_ZERO else "not above 0"
            self.wrong(f"{self.with_point(text)} is {bound}", column)
            return math.nan
        return value

    def with_point(self, text: str) -> str:
        """The text with the decimal mark a point where the file may have decimal commas."""
        return text.replace(",", ".") if self.separator not in ("", ",") else text

    def no_number(self, text: str, column: str) -> str:
        """Why a text is no number, and what to write."""
        if self.separator in ("", ",") and re.fullmatch(r"[+-]?[0-9]+,[0-9]+", text):
            where = "in a comma-separated file" if self.separator else "and so is a text"
            return f"{text} has a decimal comma {where}; write {text.replace(',', '.')}"

        percent = re.sub(r"crimp(_std)?$", r"crimp_percent\1", column)
        hint = f"; use the column {percent}" if text.endswith("%") and percent != column else ""
        return f"{quoted(self.with_point(text))} is not a number{hint}"

    def whole_number(self, text: str, column: str) -> int | None:
        if not text:
            self.wrong("this cell is empty", column)
            return None
        try:
            value = whole(re.sub(r"\.0+$", "", self.with_point(text)))
        except ValueError as error:
            self.wrong(str(error), column)
            return None
        if not 1 <= value <= MOST_YARNS:
            self.wrong(f"{value} is not between 1 and {MOST_YARNS}", column)
            return None
        return value

    def pattern(self, text: str) -> tuple[str, ...]:
        if not text:
            self.wrong("this cell is empty", "pattern")
            return ()
        try:
            pattern = read_pattern(text)
        except ValueError as error:
            self.wrong(str(error), "pattern")
            return ()
        if fault := size_fault(text, pattern, MOST_YARNS):
            self.wrong(fault, "pattern")
            return ()

        digits = "0" in text or "1" in text
        hint = "; a spreadsheet drops the zeros a number starts with: write o and u for 1 and 0" if digits else ""
        uneven = len(set(map(len, pattern))) > 1
        for fault in pattern_faults(pattern):
            self.wrong(fault + hint * uneven, "pattern")
        return pattern

    def check_choices(self, row: dict) -> None:
        for column, choices in (("section", SECTIONS), ("float_gap", FLOAT_GAPS), ("thicker", DIRECTIONS)):
            if row[column] not in ("", *choices):
                self.wrong(f"{quoted(row[column])} is none of {', '.join(choices)}", column)

    def check_satin(self, row: dict) -> None:
        if self.family != "satin" or row["harness"] is None or row["step"] is None:
            return  # told already
        harness, step = row["harness"], row["step"]
        if harness < 3:
            self.wrong(f"{harness} is not at least 3", "harness")
        elif step >= harness:
            self.wrong(f"{step} is not below the harness {harness}", "step")
        elif math.gcd(harness, step) != 1:
            self.wrong(f"{step} is not coprime to the harness {harness}", "step")

    def check_scatter(self, texts: dict[str, str | None]) -> None:
        """A standard deviation belongs to a measured value."""
        filled = _filled(texts)
        for column in self.header:
            if texts[column] and column in STD_WRITTEN:
                if OTHER_UNITS.get(column, (column, 1.0))[0].removesuffix("_std") not in filled:
                    value = column.removesuffix("_std")
                    self.wrong(f"a standard deviation without its value; {value} is empty", column)

    def check_geometry(self, row: dict, texts: dict[str, str | None]) -> None:
        """Bounds between cells of one row that need no model."""
        filled = _filled(texts)
        balanced = not any(f"warp_{quantity}" in filled for quantity in PER_DIRECTION)
        directions = ("weft",) if balanced else DIRECTIONS
        for direction in directions:
            self.check_spacing(row, direction, filled)

        lateral = row["lateral_height_mm"]
        if row["section"] == "flat" and "lateral_height_mm" not in filled:
            self.wrong("this cell is empty; a flat section needs the height of its sides", "lateral_height_mm")
        if row["section"] != "flat" and not math.isnan(lateral):
            message = f"{lateral:g} has no meaning for a {row['section'] or 'lenticular'} section; write flat"
            self.wrong(message, "lateral_height_mm")

        for direction in directions:
            for side in ("top", "bottom"):
                self.check_contact(row, direction, side)

    def check_spacing(self, row: dict, direction: str, filled: set[str]) -> None:
        """Density and width are there, and the yarns lie beside each other."""
        for quantity in ("density_per_mm", "width_mm"):
            if f"{direction}_{quantity}" not in filled:
                hint = " (leave every warp cell empty for a balanced fabric)" if direction == "warp" else ""
                self.wrong(f"this cell is empty{hint}", f"{direction}_{quantity}")

        width, spacing = row[f"{direction}_width_mm"], 1 / row[f"{direction}_density_per_mm"]
        if width >= spacing:
            message = f"{width:g} is not below the {direction} spacing {spacing:.4g} mm"
            self.wrong(message, f"{direction}_width_mm")

    def check_contact(self, row: dict, direction: str, side: str) -> None:
        """Bounds of a contact chord c_t, c_b and offset d_c."""
        column, width = f"{direction}_contact_{side}_mm", row[f"{direction}_width_mm"]
        chord = width if math.isnan(row[column]) else row[column]
        if chord > width:
            self.wrong(f"{chord:g} is above the {direction} width {width:g} mm", column)
        elif row["section"] == "round" and chord == width:
            self.wrong(f"a round section needs a contact chord below its width {width:g} mm", column)

        offset = row[f"{direction}_offset_{side}_mm"]
        if offset >= chord / 2:
            message = f"{offset:g} is not below half the contact chord, {chord / 2:g} mm"
            self.wrong(message, f"{direction}_offset_{side}_mm")


def _filled(texts: dict[str, str | None]) -> set[str]:
    """The columns, as they are kept, whose cell is not empty (None: it holds what is refused)."""
    return {OTHER_UNITS.get(column, (column, 1.0))[0] for column, text in texts.items() if text != ""}
