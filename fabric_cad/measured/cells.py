"""The text of one cell: the number it stands for, or why it stands for none."""

from __future__ import annotations

import re
from collections.abc import Sequence

from ..support.errors import quoted
from ..support.numerals import number, whole
from .columns import FREE_TEXTS
from .records import Record


def with_point(text: str, separator: str) -> str:
    """The text with the decimal mark a point where the file may have decimal commas."""
    return text.replace(",", ".") if separator not in ("", ",") else text


def measurement(text: str, column: str, separator: str) -> float:
    """The number of a cell. Raises ValueError: why it is none, and what to write."""
    try:
        return number(with_point(text, separator))
    except ValueError:
        raise ValueError(_no_number(text, column, separator)) from None


def whole_number(text: str, separator: str) -> int:
    """The whole number of a cell, which a spreadsheet may have written ``2.0``. Raises ValueError."""
    if not text:
        raise ValueError("this cell is empty")
    return whole(re.sub(r"\.0+$", "", with_point(text, separator)))


def _no_number(text: str, column: str, separator: str) -> str:
    if separator in ("", ",") and re.fullmatch(r"[+-]?[0-9]+,[0-9]+", text):
        where = "in a comma-separated file" if separator else "and so is a text"
        return f"{text} has a decimal comma {where}; write {text.replace(',', '.')}"

    percent = re.sub(r"crimp(_std)?$", r"crimp_percent\1", column)
    hint = f"; use the column {percent}" if text.endswith("%") and percent != column else ""
    return f"{quoted(with_point(text, separator))} is not a number{hint}"


def sheet_fault(record: Record, place: int, column: str, text: str) -> str | None:
    """Why a workbook's cell, number ``place`` of its line, is refused for what it is.

    None in a text table.
    """
    fault = record.faults.get(place)
    if column in FREE_TEXTS:
        return None if text else fault  # a date is as good a note as any

    if column == "pattern" and place in record.numbers:
        return f"{text} is a number, of which a spreadsheet drops the zeros it starts with; write o and u for 1 and 0"
    if column.removesuffix("_std").endswith("_percent") and place in record.percents:
        return (
            "the cell has the format percent, in which 0.4 % is the number 0.004, and its column counts in "
            "percent already; give it the format number, and enter it again"
        )

    return fault or record.merged.get(place)


def width_fault(record: Record, header: Sequence[str], separator: str) -> str | None:
    """Why a line has more cells than the header."""
    filled = [place for place, text in enumerate(record.cells) if text or place in record.faults]
    if not filled or filled[-1] < len(header):
        return None
    hint = " (a decimal comma needs ';' as the separator)" if separator == "," else ""
    return f"{filled[-1] + 1} cells where the header has {len(header)}{hint}"
