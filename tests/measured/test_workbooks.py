"""Family tables as workbooks: read as the same CSV would be, faults told with sheet, row and column letter."""

import datetime
import io
import re
import zipfile
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from odf.opendocument import OpenDocumentSpreadsheet
from odf.table import CoveredTableCell, Table, TableCell, TableRow
from odf.text import P

from fabric_cad.cli import main
from fabric_cad.measured.tables import MEASURED, read_families, read_family
from fabric_cad.measured.workbook_scan import LARGEST
from fabric_cad.measured.workbooks import letters_of
from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError
from fabric_cad.weave.weaves import FAMILIES

HEADER = [
    "name",
    "over",
    "under",
    "weft_density_per_mm",
    "weft_width_mm",
    "weft_crimp",
    "warp_crimp",
    "notes",
]
ROW = ["t32", 3, 2, 0.35, 2.4, 0.004, None, "a note"]


def xlsx(path, *rows, title="sheet1", change=lambda sheet: None):
    book = openpyxl.Workbook()
    book.active.title = title
    for row in rows:
        book.active.append(row)
    change(book.active)
    book.save(path)
    return path


def ods(path, *rows, title="sheet1", change=lambda sheet: None):
    book, sheet = OpenDocumentSpreadsheet(), Table(name=title)
    for row in rows:
        line = TableRow()
        for value in row:
            line.addElement(ods_cell(value))
        sheet.addElement(line)
    change(sheet)
    book.spreadsheet.addElement(sheet)
    book.save(path)
    return path


def ods_cell(value):
    if isinstance(value, bool):
        return TableCell(valuetype="boolean", booleanvalue=str(value).lower())
    if isinstance(value, (int, float)):
        return TableCell(valuetype="float", value=repr(value))
    if isinstance(value, datetime.date):
        return TableCell(valuetype="date", datevalue=value.isoformat())
    cell = TableCell() if value is None else TableCell(valuetype="string")
    if value is not None:
        cell.addElement(P(text=value))
    return cell


KINDS = pytest.mark.parametrize("write", [xlsx, ods], ids=["xlsx", "ods"])


def path_of(folder, write, family="twill"):
    return Path(folder) / f"{family}.{write.__name__}"


def told(path):
    with pytest.raises(InputError) as refused:
        read_family(path)
    return [str(problem).replace(f"{path.parent}/", "") for problem in refused.value.problems]


def bad(column, value):
    return [value if name == column else cell for name, cell in zip(HEADER, ROW)]


@KINDS
@pytest.mark.parametrize("family", FAMILIES)
def test_a_workbook_is_its_csv(here, write, family):
    """Every shipped table, its cells typed in as a person would: numbers as numbers."""
    import csv

    def cell(column, text):
        number = (
            column not in ("name", "pattern", "section", "float_gap", "thicker", "source", "notes")
            and text
        )
        return (float(text) if number else text) or None

    path = Path(f"families/{family}.csv")
    comment, header, *rows = csv.reader(
        path.read_text().splitlines()[-len(read_family(path)) - 2 :]
    )
    rows = [[cell(column, text) for column, text in zip(header, row)] for row in rows]
    book = write(path_of(here, write, family), comment, [], header, *rows, ["# the end"])

    table, same = read_family(path), read_family(book)
    assert (table.names, table.weaves, table.sources) == (same.names, same.weaves, same.sources)
    assert same.lines == tuple(range(4, 4 + len(rows)))
    for column in MEASURED:
        assert np.array_equal(table.measured[column], same.measured[column], equal_nan=True)
        assert np.array_equal(table.scatter[column], same.scatter[column], equal_nan=True)
    assert identify(table).columns == identify(same).columns


@KINDS
@pytest.mark.parametrize(
    ("column", "value", "expected"),
    [
        (
            "weft_width_mm",
            3.1,
            "E2: weft_width_mm: 3.1 is not below the weft spacing 2.857 mm (row t32)",
        ),
        ("weft_crimp", -1, "F2: weft_crimp: -1 is not above 0 (row t32)"),
        (
            "weft_crimp",
            "0,004",
            "F2: weft_crimp: 0,004 has a decimal comma and so is a text; write 0.004 (row t32)",
        ),
        ("weft_crimp", "x", "F2: weft_crimp: 'x' is not a number (row t32)"),
        (
            "weft_crimp",
            True,
            "F2: weft_crimp: TRUE is a truth value; enter a number or a text (row t32)",
        ),
        (
            "weft_crimp",
            datetime.date(2026, 4, 1),
            "F2: weft_crimp: 2026-04-01 is a date, which spreadsheets make of",
        ),
        ("over", 2.5, "B2: over: '2.5' is not a whole number (row t32)"),
        ("name", None, "A2: name: the row has no name"),
        ("under", None, "C2: under: this cell is empty (row t32)"),
    ],
)
def test_faults_are_told_with_sheet_row_and_column(tmp_path, write, column, value, expected):
    path = write(path_of(tmp_path, write), HEADER, bad(column, value))
    (problem,) = told(path)
    assert problem.startswith(f"{path.name}: sheet1!{expected}")


@KINDS
def test_what_identification_refuses_is_placed_too(tmp_path, write):
    header = [name.replace("weft_crimp", "weft_crimp_percent") for name in HEADER]
    path = write(path_of(tmp_path, write), header, bad("weft_crimp", None))
    with pytest.raises(InputError, match=r"twill\.\w+: sheet1!F2: weft_crimp: this cell is empty"):
        identify(read_family(path))


@KINDS
def test_whole_numbers_names_and_free_texts(tmp_path, write):
    row = [22, 3.0, "2", 0.35, "2.4", 0.004, None, datetime.date(2026, 4, 1)]
    table = read_family(write(path_of(tmp_path, write), HEADER, row))
    assert table.names == ("22",) and table.notes == ("2026-04-01",)
    assert (table.weaves[0].over, table.weaves[0].under, table.measured["weft_width_mm"][0]) == (
        3,
        2,
        2.4,
    )


@KINDS
def test_patterns_entered_as_numbers_are_refused(tmp_path, write):
    header = ["name", "pattern", "weft_density_per_mm", "weft_width_mm", "weft_crimp"]
    path = write(path_of(tmp_path, write, "pattern"), header, ["p", 11001100, 0.35, 2.4, 0.004])
    (problem,) = told(path)
    assert (
        "sheet1!B2: pattern: 11001100 is a number, of which a spreadsheet drops the zeros"
        in problem
    )
    path = write(path, header, ["p", datetime.date(2026, 10, 1), 0.35, 2.4, 0.004])
    assert "is a date" in told(path)[0]


@KINDS
def test_a_sheet_with_another_name_and_empty_sheets(tmp_path, write):
    path = write(path_of(tmp_path, write), HEADER, bad("weft_crimp", "x"), title="my 'yarns'")
    assert told(path)[0].startswith(f"{path.name}: 'my 'yarns''!F2: ")


def test_one_sheet_only(tmp_path):
    book = openpyxl.Workbook()
    for row in (HEADER, ROW):
        book.active.append(row)
    path = tmp_path / "twill.xlsx"
    book.create_sheet("empty")
    book.save(path)
    assert read_family(path).names == ("t32",)
    book.create_sheet("old")["B3"] = 1
    book["old"].sheet_state = "hidden"
    book.save(path)
    assert told(path) == ["twill.xlsx: only one sheet may hold something, and 2 do: 'Sheet', 'old'"]


def test_an_empty_workbook_is_an_empty_table(tmp_path):
    assert told(xlsx(tmp_path / "twill.xlsx")) == ["twill.xlsx: the table is empty: no header line"]
    assert told(ods(tmp_path / "twill.ods")) == ["twill.ods: the table is empty: no header line"]


# ---- formulas, errors, percentages, merged cells


def edited(path, part, *changes):
    """The workbook with texts of one of its files replaced, as other programs write them."""
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    text = files[part].decode()
    for before, after in changes:
        assert re.search(before, text), before
        text = re.sub(before, after, text)
    files[part] = text.encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


SHEET = "xl/worksheets/sheet1.xml"


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ('<c r="F2"><f>2/500</f><v>0.004</v></c>', None),
        (
            '<c r="F2"><f>2/500</f><v></v></c>',
            "F2: weft_crimp: the formula has no stored value; open the workbook",
        ),
        (
            '<c r="F2" t="e"><f>1/0</f><v>#DIV/0!</v></c>',
            "F2: weft_crimp: the cell holds the error #DIV/0!",
        ),
        ('<c r="F2" t="e"><v>#N/A</v></c>', "F2: weft_crimp: the cell holds the error #N/A"),
        ('<c r="F2" t="str"><f>"0.0"&amp;"04"</f><v>0.004</v></c>', None),
    ],
)
def test_formulas_count_with_their_stored_value(tmp_path, cell, expected):
    path = edited(xlsx(tmp_path / "twill.xlsx", HEADER, ROW), SHEET, ('<c r="F2".*?</c>', cell))
    if expected is None:
        assert read_family(path).measured["weft_crimp"][0] == 0.004
    else:
        assert told(path)[0].startswith(f"twill.xlsx: sheet1!{expected}")


def test_an_error_in_an_optional_cell_is_not_an_empty_one(tmp_path):
    """python-calamine reads both alike; a fabric would be another without the cell."""
    path = xlsx(
        tmp_path / "twill.xlsx", HEADER, ROW, change=lambda sheet: sheet.__setitem__("G2", "#REF!")
    )
    path = edited(path, SHEET, (r'<c r="G2".*?</c>', '<c r="G2" t="e"><v>#REF!</v></c>'))
    assert "twill.xlsx: sheet1!G2: warp_crimp: the cell holds the error #REF! (row t32)" in told(
        path
    )

    def error(sheet):
        line = TableRow()
        for value in ROW[:6]:
            line.addElement(ods_cell(value))
        cell = TableCell(valuetype="string", formula="of:=1/0", stringvalue="")
        cell.addElement(P(text="#DIV/0!"))
        line.addElement(cell)
        sheet.addElement(line)

    path = ods(tmp_path / "twill.ods", HEADER, change=error)
    assert "twill.ods: sheet1!G2: warp_crimp: the cell holds the error #DIV/0! (row t32)" in told(
        path
    )


def test_percentages(tmp_path):
    """0.4 % is the number 0.004: a crimp, but no crimp in percent."""

    def percent(sheet):
        sheet["F2"].number_format = "0.0%"

    path = xlsx(tmp_path / "twill.xlsx", HEADER, ROW, change=percent)
    assert read_family(path).measured["weft_crimp"][0] == 0.004
    header = [name.replace("weft_crimp", "weft_crimp_percent") for name in HEADER]
    path = xlsx(tmp_path / "twill.xlsx", header, ROW, change=percent)
    assert "sheet1!F2: weft_crimp_percent: the cell has the format percent" in told(path)[0]


def test_merged_cells(tmp_path):
    """A title over the table may be merged, and what is free text; a number belongs to one cell."""
    rows = (["# Twills"], HEADER, ROW, ["u32", *ROW[1:]])
    table = read_family(
        xlsx(tmp_path / "twill.xlsx", *rows, change=lambda sheet: sheet.merge_cells("A1:H1"))
    )
    assert table.names == ("t32", "u32")
    path = xlsx(tmp_path / "twill.xlsx", *rows, change=lambda sheet: sheet.merge_cells("H3:H4"))
    assert read_family(path).notes == ("a note", "")
    path = xlsx(tmp_path / "twill.xlsx", *rows, change=lambda sheet: sheet.merge_cells("G3:G4"))
    expected = "sheet1!G4: warp_crimp: the cell is merged with others (G3:G4); split them, a value each (row u32)"
    assert told(path)[0] == f"twill.xlsx: {expected}"

    def covered(sheet):
        line = TableRow()
        for value in ["u32", *ROW[1:6]]:
            line.addElement(ods_cell(value))
        line.addElement(CoveredTableCell())
        sheet.addElement(line)

    path = ods(tmp_path / "twill.ods", HEADER, ROW, change=covered)
    assert "sheet1!G3: warp_crimp: the cell is merged" in told(path)[0]


def test_surplus_cells_and_columns_far_out(tmp_path):
    path = xlsx(tmp_path / "twill.xlsx", HEADER, [*ROW, None, 7])
    assert told(path) == ["twill.xlsx: sheet1 row 2: 10 cells where the header has 8 (row t32)"]
    assert [letters_of(n) for n in (0, 25, 26, 51, 52, 701, 702)] == [
        "A",
        "Z",
        "AA",
        "AZ",
        "BA",
        "ZZ",
        "AAA",
    ]


# ---- folders


@KINDS
def test_every_command_reads_workbooks(here, capsys, write):
    Path("families/twill.csv").unlink()
    write(path_of("families", write), HEADER, ROW, ["wide", *bad("weft_width_mm", 3.1)[1:]])
    assert main(["list"]) == 2
    printed = capsys.readouterr()
    assert (
        "twill 3*2" in printed.out and "sheet1!E3: weft_width_mm: 3.1 is not below" in printed.err
    )
    assert main(["validate"]) == 2


def test_a_table_there_twice_is_refused(here, capsys):
    xlsx(Path("families/twill.xlsx"), HEADER, ROW)
    tables = read_families("families")
    assert str(tables["twill"]) == (
        "families/twill.csv: this table is there more than once, as twill.csv and twill.xlsx; keep one"
    )
    assert tables["satin"].names


def test_init_keeps_a_workbook_in_place_of_a_table(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("families").mkdir()
    xlsx(Path("families/twill.xlsx"), HEADER, ROW)
    assert main(["init"]) == 0
    assert (
        "families/twill.xlsx: kept" in capsys.readouterr().out
        and not Path("families/twill.csv").exists()
    )
    assert main(["list"]) == 0


# ---- what is no workbook


def zipped(**files):
    raw = io.BytesIO()
    with zipfile.ZipFile(raw, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name.replace("__", "/").replace("_xml", ".xml"), content)
    return raw.getvalue()


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        (b"", "cannot be read as a workbook: File is not a zip file"),
        (b"name,over\nt,3\n", "cannot be read as a workbook: File is not a zip file"),
        (
            b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600),
            "an old workbook (.xls), or one protected by a password",
        ),
        (zipped(a="b"), "cannot be read as a workbook: it has no part"),
        (zipped(content_xml="<a>"), "cannot be read as a workbook: no element found"),
        (zipped(content_xml="<a/>"), "cannot be read as a workbook"),
        (zipped(a=bytes(LARGEST + 1)), "unpacks to 50 MB; a family table has at most 50"),
        (
            zipped(content_xml="x", **{"META-INF__manifest_xml": "<encryption-data/>"}),
            "protected by a password",
        ),
    ],
)
@pytest.mark.parametrize("kind", ["xlsx", "ods"])
def test_files_that_are_no_workbooks(tmp_path, raw, kind, expected):
    path = tmp_path / f"twill.{kind}"
    path.write_bytes(raw)
    (problem,) = told(path)
    assert problem.startswith(f"{path.name}: ") and expected in problem


@pytest.mark.parametrize("write", [xlsx, ods], ids=["xlsx", "ods"])
def test_damaged_workbooks(tmp_path, write):
    """Cut anywhere, or with any byte changed: read as before, or refused."""
    path = write(path_of(tmp_path, write), HEADER, ROW)
    raw = path.read_bytes()
    rng = np.random.default_rng(5)
    for place in rng.integers(0, len(raw), 60).tolist():
        for damaged in (raw[:place], raw[:place] + bytes([raw[place] ^ 0x55]) + raw[place + 1 :]):
            path.write_bytes(damaged)
            try:
                assert read_family(path, partial=True).names in ((), ("t32",))
            except InputError as error:
                assert all(problem.path == str(path) for problem in error.problems)


def test_a_value_in_the_last_cell_of_a_sheet(tmp_path):
    """Which would be 17 thousand million cells to read."""
    path = xlsx(
        tmp_path / "twill.xlsx",
        HEADER,
        ROW,
        change=lambda sheet: sheet.__setitem__("XFD1048576", 1),
    )
    assert (
        "row 1048576 and in column number 16384 is larger than a family table can be"
        in told(path)[0]
    )

    def repeated(sheet):
        line = TableRow(numberrowsrepeated="1048000")
        line.addElement(TableCell(valuetype="float", value="1", numbercolumnsrepeated="16384"))
        sheet.addElement(line)

    path = ods(tmp_path / "twill.ods", HEADER, ROW, change=repeated)
    assert "is larger than a family table can be" in told(path)[0]


def test_empty_formatted_areas_are_no_cells(tmp_path):
    """LibreOffice ends a sheet with a million repeated empty rows."""

    def empty(sheet):
        line = TableRow(numberrowsrepeated="1048000")
        line.addElement(TableCell(numbercolumnsrepeated="16384"))
        sheet.addElement(line)

    assert read_family(ods(tmp_path / "twill.ods", HEADER, ROW, change=empty)).names == ("t32",)
