"""What python-calamine does not tell of a workbook: cells in error, merged ones, and how large it would become.

Error values and formulas that no program has computed read as empty cells there, and a single value
in the last cell of a sheet as 17 thousand million cells. So the sheets' XML is looked through
first.
"""

from __future__ import annotations

import io
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.etree import ElementTree

from ..support.errors import InputError, Problem

LARGEST = 50 * 2**20
"""Bytes that a workbook may unpack to."""

MOST_CELLS = 1_000_000
"""Rows times columns of the filled area of a sheet."""

_WIDEST = 500
"""Of a merged area, so many columns are looked at: more than a family table has."""

READING_ERRORS = (
    zipfile.BadZipFile,
    zlib.error,
    ElementTree.ParseError,
    struct.error,
    EOFError,
    KeyError,
    NotImplementedError,
    OSError,
    RuntimeError,
    ValueError,
)


@dataclass
class Sheet:
    """A sheet's cells by (row, column) from 0: ``faults`` are errors, ``merged`` lie in another's merged area."""

    faults: dict[tuple[int, int], str] = field(default_factory=dict)
    merged: dict[tuple[int, int], str] = field(default_factory=dict)
    percents: set[tuple[int, int]] = field(default_factory=set)
    rows: int = 0
    columns: int = 0

    def fill(self, row: int, column: int) -> None:
        """Hold that a cell is not empty. Raises ValueError where the filled area grows too large."""
        self.rows, self.columns = max(self.rows, row + 1), max(self.columns, column + 1)
        if self.rows * self.columns > MOST_CELLS:
            raise ValueError(
                f"a sheet with something in row {self.rows} and in column number {self.columns} "
                "is larger than a family table can be"
            )

    def merge(self, row: int, column: int, message: str) -> None:
        """Hold that a cell lies in a merged area. Raises ValueError where there are too many."""
        self.merged[row, column] = message
        if len(self.merged) > MOST_CELLS:
            raise ValueError("a sheet has more merged cells than a family table can have")


def scan_workbook(raw: bytes, path: str) -> dict[str, Sheet]:
    """Every sheet of a workbook by name. Raises :class:`InputError` where it is none, or too large."""
    try:
        with zipfile.ZipFile(io.BytesIO(raw)) as archive:
            size = sum(member.file_size for member in archive.infolist())
            if size > LARGEST:
                message = f"unpacks to {size / 2**20:.0f} MB; a family table has at most {LARGEST / 2**20:.0f}"
                raise InputError(Problem(message, path))

            if damaged := archive.testzip():  # reads no more than those sizes
                raise zipfile.BadZipFile(f"{damaged} is damaged")

            names = archive.namelist()
            if "META-INF/manifest.xml" in names and b"encryption-data" in archive.read(
                "META-INF/manifest.xml"
            ):
                raise InputError(
                    Problem("the workbook is protected by a password; save it without one", path)
                )

            if "content.xml" in names:
                return _ods_sheets(archive.read("content.xml"))
            return {name: _xlsx_sheet(archive, part) for name, part in _xlsx_parts(archive).items()}
    except READING_ERRORS as error:
        reason = f"it has no part {error.args[0]!r}" if isinstance(error, KeyError) else error
        raise InputError(Problem(f"cannot be read as a workbook: {reason}", path)) from error


def _local(element: ElementTree.Element) -> str:
    """An element's name without its namespace."""
    return element.tag.rsplit("}", 1)[-1]


def _attribute(element: ElementTree.Element, name: str) -> str:
    """An attribute by its name without its namespace, empty where it is not there."""
    return next(
        (value for key, value in element.attrib.items() if key.rsplit("}", 1)[-1] == name), ""
    )


# ---- Office Open XML (ECMA-376)


def _xlsx_parts(archive: zipfile.ZipFile) -> dict[str, str]:
    """The file in the archive of every sheet, by the sheet's name."""
    relations = ElementTree.fromstring(archive.read("xl/_rels/workbook.xml.rels"))
    targets = {relation.get("Id", ""): relation.get("Target", "") for relation in relations}
    book = ElementTree.fromstring(archive.read("xl/workbook.xml"))

    parts = {}
    for sheet in book.iterfind(".//{*}sheets/{*}sheet"):
        target = targets.get(_attribute(sheet, "id"), "")
        if "worksheets/" in target:
            parts[sheet.get("name", "")] = (
                target.lstrip("/") if target.startswith("/") else f"xl/{target}"
            )
    return parts


def _xlsx_sheet(archive: zipfile.ZipFile, part: str) -> Sheet:
    percents = _percent_styles(archive)
    sheet, row, column = Sheet(), -1, -1
    for event, element in ElementTree.iterparse(archive.open(part), events=("start", "end")):
        kind = _local(element)
        if event == "start" and kind == "row":
            row, column = int(element.get("r", row + 2)) - 1, -1
        elif event == "end" and kind == "c":
            place = _place(element.get("r", ""))
            row, column = place or (row, column + 1)
            _xlsx_cell(sheet, row, column, element, percents)
        elif event == "end" and kind == "mergeCell":
            _merge(sheet, element.get("ref", ""))
        elif event == "end" and kind == "row":
            element.clear()

    return sheet


def _xlsx_cell(
    sheet: Sheet, row: int, column: int, cell: ElementTree.Element, percents: frozenset[str]
) -> None:
    value, formula = cell.findtext("{*}v"), cell.find("{*}f")
    if value is None and formula is None and cell.find("{*}is") is None:
        return

    sheet.fill(row, column)
    if cell.get("t") == "e":
        sheet.faults[row, column] = f"the cell holds the error {value}"
    elif formula is not None and not value and cell.get("t") != "str":
        sheet.faults[row, column] = _UNCOMPUTED
    elif cell.get("s") in percents:
        sheet.percents.add((row, column))


_UNCOMPUTED = "the formula has no stored value; open the workbook in a spreadsheet and save it"


def _place(reference: str) -> tuple[int, int] | None:
    """(row, column) from 0 of a reference such as ``F7``."""
    if not (match := re.fullmatch(r"([A-Z]{1,3})([0-9]{1,7})", reference)):
        return None
    column = 0
    for letter in match[1]:
        column = 26 * column + ord(letter) - ord("A") + 1
    return int(match[2]) - 1, column - 1


def _merge(sheet: Sheet, reference: str) -> None:
    """Hold the cells of a merged area, all but its first, as far as the sheet is filled."""
    first, last = (_place(corner) for corner in (*reference.split(":"), reference)[:2])
    if first is None or last is None:
        return
    for row in range(first[0], min(last[0] + 1, sheet.rows)):
        for column in range(first[1], min(last[1] + 1, sheet.columns)):
            if (row, column) != first:
                sheet.merge(
                    row,
                    column,
                    f"the cell is merged with others ({reference}); split them, a value each",
                )


def _percent_styles(archive: zipfile.ZipFile) -> frozenset[str]:
    """Numbers of the cell styles that show a percentage."""
    if "xl/styles.xml" not in archive.namelist():
        return frozenset()
    styles = ElementTree.fromstring(archive.read("xl/styles.xml"))
    percent = {"9", "10"}  # 0% and 0.00%, built in
    percent |= {
        f.get("numFmtId", "")
        for f in styles.iterfind(".//{*}numFmt")
        if "%" in f.get("formatCode", "")
    }
    formats = styles.iterfind("{*}cellXfs/{*}xf")
    return frozenset(
        str(number) for number, style in enumerate(formats) if style.get("numFmtId") in percent
    )


# ---- OpenDocument 1.3, part 3, section 9


def _ods_sheets(content: bytes) -> dict[str, Sheet]:
    sheets: dict[str, Sheet] = {}
    for table in ElementTree.fromstring(content).iterfind(".//{*}spreadsheet/{*}table"):
        sheet = sheets[_attribute(table, "name")] = Sheet()
        row = 0
        for element in _ods_rows(table):
            _ods_row(sheet, row, element)
            row += _repeats(element, "rows")
    return sheets


def _ods_rows(table: ElementTree.Element) -> Iterator[ElementTree.Element]:
    """Rows of a table, those in groups too."""
    for element in table:
        if _local(element) == "table-row":
            yield element
        elif _local(element) in ("table-rows", "table-row-group", "table-header-rows"):
            yield from _ods_rows(element)


def _ods_row(sheet: Sheet, row: int, element: ElementTree.Element) -> None:
    column = 0
    for cell in element:
        kind, repeats = _local(cell), _repeats(cell, "columns")
        if kind == "covered-table-cell":
            for covered in range(column, column + min(repeats, _WIDEST)):
                sheet.merge(
                    row, covered, "the cell is merged with others; split them, a value each"
                )
        elif kind == "table-cell" and (fault := _ods_cell(cell)) is not None:
            sheet.fill(row + _repeats(element, "rows") - 1, column + repeats - 1)
            if fault:
                sheet.faults[row, column] = fault
            if _attribute(cell, "value-type") == "percentage":
                sheet.percents.add((row, column))

        column += repeats


def _ods_cell(cell: ElementTree.Element) -> str | None:
    """What is wrong with a cell, an empty text where it is sound; None for an empty cell."""
    types: Mapping[str, str] = {
        key: value for key, value in cell.attrib.items() if key.endswith("}value-type")
    }
    shown = "".join(cell.itertext()).strip()
    if not (types or shown):
        return None
    if "error" in types.values() or (
        _attribute(cell, "formula") and re.match(r"#[A-Z/0!?]+|Err:[0-9]+", shown)
    ):
        return f"the cell holds the error {shown}"
    return ""


def _repeats(element: ElementTree.Element, what: str) -> int:
    return int(_attribute(element, f"number-{what}-repeated") or 1)
