"""Family tables, as CSV, xlsx and ods, spoilt: ``list``, ``solve``, ``validate`` and ``cell`` of them."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from .mutations import encoded, pick, spoil_bytes, spoil_cells, spoil_text
from .trial import Trial

SHIPPED = Path(__file__).parents[2] / "families"
FAMILIES = ("plain", "twill", "satin", "pattern")
COMMANDS = (("list",), ("solve",), ("validate",), ("cell", ""))
LEAVES = r"build/families(/(plain|twill|satin|pattern)\.csv)?"
"""What ``solve`` leaves: the tables that can be solved, also where others are refused."""
CSV_PLACE = r"families/\w+\.csv:(\d+: | the table is empty)"
WORKBOOK_PLACE = r"families/\w+\.(xlsx|ods): (\S.*![A-Z]+\d+: |\S.* row \d+: |cannot be read|only one sheet|.* empty)"


def shipped_cells(family: str) -> list[list[str]]:
    """The rows of cells of a shipped table, header first."""
    text = (SHIPPED / f"{family}.csv").read_text(encoding="utf-8")
    return list(csv.reader(line + "\n" for line in text.splitlines() if not line.startswith("#")))


def trial(seed: int) -> Trial:
    """A spoilt table, beside a sound one every other time."""
    rng = np.random.default_rng((1, seed))
    family, command = pick(rng, FAMILIES), COMMANDS[seed % len(COMMANDS)]
    cells = shipped_cells(family)
    if command == ("cell", ""):
        command = ("cell", pick(rng, [row[0] for row in cells[1:]]))
    kind = "xlsx" if seed % 10 == 3 else "ods" if seed % 10 == 7 else "csv"
    content = csv_bytes(rng, cells) if kind == "csv" else workbook_bytes(rng, cells, kind)
    files = {f"families/{family}.{kind}": content}
    if rng.random() < 0.5:
        other = pick(rng, [name for name in FAMILIES if name != family])
        files[f"families/{other}.csv"] = (SHIPPED / f"{other}.csv").read_bytes()
    name = f"{' '.join(command)} of a spoilt {family}.{kind}"
    place = CSV_PLACE if kind == "csv" else WORKBOOK_PLACE
    if (
        command[0] == "cell" or kind != "csv"
    ):  # the row is gone, or the workbook is no file that is read
        place += "|^families: no "
    leaves = LEAVES if command == ("solve",) else r"(?!)"
    return Trial(name, command, files, place, leaves, leaves, fresh=seed % 50 == 10)


def csv_bytes(rng: np.random.Generator, cells: list[list[str]]) -> bytes:
    """A table as CSV, spoilt in its cells, its text or its bytes."""
    level = rng.random()
    text = csv_text(
        spoil_cells(rng, cells) if level < 0.6 else cells, ";" if rng.random() < 0.2 else ","
    )
    if 0.6 <= level < 0.85:
        text = spoil_text(rng, text)
    content = encoded(rng, text)
    return spoil_bytes(rng, content) if level >= 0.85 else content


def csv_text(cells: list[list[str]], separator: str = ",") -> str:
    """Rows of cells as a CSV text."""
    text = io.StringIO()
    csv.writer(text, delimiter=separator, lineterminator="\n", escapechar="\\").writerows(cells)
    return text.getvalue()


def workbook_bytes(rng: np.random.Generator, cells: list[list[str]], kind: str) -> bytes:
    """A table as a workbook of one sheet or two, spoilt in its cells or, one in four, in its bytes."""
    if whole := rng.random() < 0.75:
        cells = spoil_cells(rng, cells)
    sheets = 2 if rng.random() < 0.1 else 1
    typed = [[_value(rng, cell) for cell in row] for row in cells]
    content = {"xlsx": _xlsx, "ods": _ods}[kind](typed, sheets)
    return content if whole else spoil_bytes(rng, content)


def _value(rng: np.random.Generator, cell: str):
    """A cell as a spreadsheet would hold it: numbers as numbers, now and then something else."""
    if rng.random() < 0.005:
        import datetime

        return pick(
            rng,
            (True, datetime.date(2026, 10, 1), datetime.timedelta(hours=3), 1e300, -1, 0.1 + 0.2),
        )
    try:
        return float(cell) if cell.isascii() and np.isfinite(float(cell)) else cell
    except ValueError:
        return "".join(mark for mark in cell if mark in "\t\n" or mark >= " ")  # what XML can hold


def _xlsx(cells: list[list], sheets: int) -> bytes:
    from openpyxl import Workbook
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    book = Workbook()
    for number in range(sheets):
        sheet = book.active if number == 0 else book.create_sheet()
        for row in cells:
            sheet.append(
                [
                    ILLEGAL_CHARACTERS_RE.sub("", cell) if isinstance(cell, str) else cell
                    for cell in row
                ]
            )
    content = io.BytesIO()
    book.save(content)
    return content.getvalue()


def _ods(cells: list[list], sheets: int) -> bytes:
    from odf.opendocument import OpenDocumentSpreadsheet
    from odf.table import Table, TableCell, TableRow
    from odf.text import P

    book = OpenDocumentSpreadsheet()
    for number in range(sheets):
        sheet = Table(name=f"Sheet{number + 1}")
        for row in cells:
            line = TableRow()
            for cell in row:
                if isinstance(cell, float):
                    written = TableCell(valuetype="float", value=cell)
                else:
                    written = TableCell(valuetype="string")
                written.addElement(P(text=str(cell).replace("\x7f", "")))
                line.addElement(written)
            sheet.addElement(line)
        book.spreadsheet.addElement(sheet)
    content = io.BytesIO()
    book.write(content)
    return content.getvalue()
