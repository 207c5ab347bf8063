"""Family tables: every spreadsheet dialect reads the same, everything wrong is told at once."""

import numpy as np
import pytest

from fabric_cad.measured.tables import MEASURED, read_families, read_family
from fabric_cad.support.errors import InputError

HEADER = (
    "name,over,under,weft_density_per_mm,weft_width_mm,weft_crimp,"
    "warp_density_per_mm,warp_width_mm,warp_crimp,notes"
)
ROW = "t32,3,2,0.35,2.4,0.004,,,,a note"


def write(folder, text, name="twill.csv", encoding="utf-8"):
    path = folder / name
    path.write_bytes(text.encode(encoding))
    return path


def problems(folder, text, name="twill.csv"):
    with pytest.raises(InputError) as refused:
        read_family(write(folder, text, name))
    return [str(problem).replace(str(folder) + "/", "") for problem in refused.value.problems]


def semicolons(text):
    """The table as a continental spreadsheet saves it."""
    return text.replace(",", ";").replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        f"{HEADER}\n{ROW}\n",
        f"\ufeff{HEADER}\n{ROW}\n",
        f"{HEADER}\r\n{ROW}\r\n",
        f"{HEADER}\r{ROW}\r",
        semicolons(f"{HEADER}\n{ROW}\n"),
        f"\ufeff{semicolons(HEADER)}\r\n\r\n{semicolons(ROW)}\r\n",
        f"{HEADER}\n{ROW}\n".replace(",", ";"),
        f"{HEADER}\n{ROW}\n".replace(",", "\t"),
        f"sep=;\n{semicolons(HEADER)}\n{semicolons(ROW)}\n",
        f'# a comment\n\n  \n{HEADER}\n,,,,,,,,,\n# another, with a " in it\n{ROW}\n\n',
        f'{HEADER}\n"# quoted by a spreadsheet",,,,,,,,,\n{ROW}\n',
        f"{HEADER}\n{ROW}\n".replace(",", " , "),
        f"{HEADER}\n" + '"t32","3","2","0.35","2.4","0.004","","","","a note"' + "\n",
        f"{HEADER},,\n{ROW},,\n",
        f"{HEADER}\nt32,3.0,2.0,3.5e-1,+2.4,.004,,,,a note\n",
    ],
)
def test_every_dialect_reads_the_same(tmp_path, text):
    table = read_family(write(tmp_path, text))
    assert table.names == ("t32",) and table.notes == ("a note",)
    assert (table.weaves[0].over, table.weaves[0].under) == (3, 2)
    assert [table.measured[f"weft_{q}"][0] for q in ("density_per_mm", "width_mm", "crimp")] == [
        0.35,
        2.4,
        0.004,
    ]
    assert table.balanced.all()
    given = {"weft_density_per_mm", "weft_width_mm", "weft_crimp"}
    assert all(np.isnan(table.measured[column][0]) for column in MEASURED if column not in given)


@pytest.mark.parametrize(
    ("column", "cell", "kept", "value"),
    [
        ("weft_density_per_cm", "3.5", "weft_density_per_mm", 0.35),
        ("weft_density_per_inch", "8.89", "weft_density_per_mm", 0.35),
    ],
)
def test_other_units_of_density(tmp_path, column, cell, kept, value):
    text = f"name,{column},weft_width_mm,weft_crimp_percent\nr,{cell},2.4,0.4\n"
    table = read_family(write(tmp_path, text, "plain.csv"))
    assert table.measured[kept][0] == pytest.approx(value, rel=1e-15)
    assert table.measured["weft_crimp"][0] == pytest.approx(0.004, rel=1e-15)


def test_line_numbers_are_those_of_the_file(tmp_path):
    text = f'# one\n\n{HEADER}\n{ROW[:-6]}"a note\nof two lines"\n# six\nbad,3,2,x,2.4,0.004,,,,\n'
    assert problems(tmp_path, text) == [
        "twill.csv:7: weft_density_per_mm: 'x' is not a number (row bad)"
    ]


def bad(cells: dict) -> str:
    row = dict(zip(HEADER.split(","), ROW.split(","))) | cells
    return f"{HEADER}\n{','.join(row.values())}\n"


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ({"weft_crimp": "abc"}, "twill.csv:2: weft_crimp: 'abc' is not a number (row t32)"),
        ({"weft_crimp": "nan"}, "twill.csv:2: weft_crimp: 'nan' is not a number (row t32)"),
        ({"weft_crimp": "1e999"}, "twill.csv:2: weft_crimp: '1e999' is not a number (row t32)"),
        ({"weft_crimp": "1_0"}, "twill.csv:2: weft_crimp: '1_0' is not a number (row t32)"),
        ({"weft_crimp": "-0.004"}, "twill.csv:2: weft_crimp: -0.004 is not above 0 (row t32)"),
        ({"weft_crimp": "0"}, "twill.csv:2: weft_crimp: 0 is not above 0 (row t32)"),
        (
            {"weft_crimp": "0.4%"},
            "twill.csv:2: weft_crimp: '0.4%' is not a number; use the column weft_crimp_percent (row t32)",
        ),
        (
            {"weft_width_mm": '"2,4"'},
            "twill.csv:2: weft_width_mm: 2,4 has a decimal comma in a comma-separated file; write 2.4 (row t32)",
        ),
        (
            {"weft_width_mm": "2,4"},
            "twill.csv:2: 11 cells where the header has 10 (a decimal comma needs ';' as the separator) (row t32)",
        ),
        (
            {"weft_width_mm": "2.9"},
            "twill.csv:2: weft_width_mm: 2.9 is not below the weft spacing 2.857 mm (row t32)",
        ),
        (
            {"warp_width_mm": "2.5"},
            "twill.csv:2: warp_density_per_mm: this cell is empty "
            "(leave every warp cell empty for a balanced fabric) (row t32)",
        ),
        ({"over": "0"}, "twill.csv:2: over: 0 is not between 1 and 100 (row t32)"),
        ({"over": "2.5"}, "twill.csv:2: over: '2.5' is not a whole number (row t32)"),
        ({"over": ""}, "twill.csv:2: over: this cell is empty (row t32)"),
        ({"name": ""}, "twill.csv:2: name: the row has no name"),
    ],
)
def test_one_wrong_cell_one_clear_message(tmp_path, cells, expected):
    assert problems(tmp_path, bad(cells)) == [expected]


@pytest.mark.parametrize(
    "name", ["../up", "a b", "a/b", "-q", "naïve", "NUL", "families", "x" * 81, "a.b"]
)
def test_names_are_safe_file_names(tmp_path, name):
    (problem,) = problems(tmp_path, bad({"name": name}))
    assert problem.startswith(f"twill.csv:2: name: '{name}' is no safe file name")


def test_the_message_of_the_manual(tmp_path):
    text = f"{HEADER}\n" + "\n" * 5 + "twill32,3,2,0.35,2.4,0.004,0.35,3.1,0.004,\n"
    assert problems(tmp_path, text) == [
        "twill.csv:7: warp_width_mm: 3.1 is not below the warp spacing 2.857 mm (row twill32)"
    ]


def test_everything_wrong_in_a_table_is_listed(tmp_path):
    text = f"{HEADER}\nt32,3,2,0.35,2.9,z,,,,\nt32,3,2,0.35,2.4,0.004,,,,\nb,0,2,0.35,2.4,-1,,,,\n"
    assert problems(tmp_path, text) == [
        "twill.csv:2: weft_crimp: 'z' is not a number (row t32)",
        "twill.csv:2: weft_width_mm: 2.9 is not below the weft spacing 2.857 mm (row t32)",
        "twill.csv:3: name: this row name is also at line 2 (row t32)",
        "twill.csv:4: over: 0 is not between 1 and 100 (row b)",
        "twill.csv:4: weft_crimp: -1 is not above 0 (row b)",
    ]


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (
            "weft_widht_mm",
            "twill.csv:1: weft_widht_mm: unknown column of twill.csv; did you mean weft_width_mm?",
        ),
        (
            "Weft_Crimp",
            "twill.csv:1: Weft_Crimp: unknown column of twill.csv; did you mean weft_crimp?",
        ),
        ("over", "twill.csv:1: over: this column stands twice in the header"),
        ("harness", "twill.csv:1: harness: unknown column of twill.csv; did you mean"),
    ],
)
def test_unknown_columns_suggest_the_nearest(tmp_path, header, expected):
    (problem,) = problems(tmp_path, f"{HEADER},{header}\n{ROW},\n")
    assert problem.startswith(expected)


def test_missing_columns(tmp_path):
    assert problems(tmp_path, "name,over,weft_width_mm\nr,1,1\n") == [
        "twill.csv:1: under: this column is missing",
        "twill.csv:1: weft_density_per_mm: this column is missing",
    ]


@pytest.mark.parametrize(
    ("harness", "step", "expected"),
    [
        ("8", "2", "satin.csv:2: step: 2 is not coprime to the harness 8 (row s)"),
        ("8", "9", "satin.csv:2: step: 9 is not below the harness 8 (row s)"),
        ("2", "1", "satin.csv:2: harness: 2 is not at least 3 (row s)"),
    ],
)
def test_satin_steps(tmp_path, harness, step, expected):
    text = f"name,harness,step,weft_density_per_mm,weft_width_mm,weft_crimp\ns,{harness},{step},0.8,1,0.003\n"
    assert problems(tmp_path, text, "satin.csv") == [expected]


def test_a_quantity_in_two_units(tmp_path):
    text = "name,weft_density_per_mm,weft_density_per_cm,weft_width_mm\nr,0.35,3.5,2.4\n"
    (problem,) = problems(tmp_path, text, "plain.csv")
    assert "given twice, in two units" in problem


def test_other_encodings_are_told(tmp_path):
    path = write(tmp_path, f"{HEADER}\n{ROW} \u00e9\n", encoding="latin-1")
    with pytest.raises(InputError, match=r"twill.csv:2: not UTF-8 text"):
        read_family(path)


@pytest.mark.parametrize("text", ["", "\n\n", "# only a comment\n"])
def test_empty_tables(tmp_path, text):
    assert problems(tmp_path, text) == ["twill.csv: the table is empty: no header line"]


def test_a_header_alone_is_a_table_of_no_rows(tmp_path):
    from fabric_cad.model.identification import identify

    table = read_family(write(tmp_path, HEADER + "\n"))
    assert len(table) == 0 and len(identify(table)) == 0


def test_names_are_unique_over_all_tables(tmp_path):
    write(
        tmp_path,
        "name,weft_density_per_mm,weft_width_mm,weft_crimp\nt32,0.2,3,0.004\n",
        "plain.csv",
    )
    write(tmp_path, f"{HEADER}\nT32{ROW[3:]}\n")
    tables = read_families(tmp_path)
    (problem,) = tables["twill"].problems
    assert problem.column == "name" and "plain.csv:2" in problem.message


def test_folders_without_tables(tmp_path):
    with pytest.raises(InputError, match="no family table in this folder"):
        read_families(tmp_path)
    with pytest.raises(InputError, match="no such folder of family tables; 'fabric-cad init'"):
        read_families(tmp_path / "missing")
    with pytest.raises(InputError, match="cannot be read"):
        (tmp_path / "plain.csv").mkdir()
        read_family(tmp_path / "plain.csv")
    with pytest.raises(InputError, match="not a family table"):
        read_family(tmp_path / "knit.csv")
