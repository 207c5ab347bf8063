"""What is wrong with a row or a file of tables stops what uses it, and nothing else; it is told safely."""

from pathlib import Path

import pytest

from fabric_cad.cell.pipeline import find_row
from fabric_cad.cli import main
from fabric_cad.measured.tables import WEAVE_COLUMNS, read_families, read_family
from fabric_cad.support.errors import ArgumentError, InputError, Problem, UnknownRowError

HEADER = "name,over,under,weft_density_per_mm,weft_width_mm,weft_crimp"
GOOD = "good,3,2,0.35,2.4,0.004"
TOO_WIDE = "wide,3,2,0.35,2.9,0.004"
UNFINISHED = "unfinished,3,2,,,"
NO_FABRIC = "thin,3,2,0.35,2.4,"  # density and width alone identify nothing


def write(folder, *rows, name="twill.csv", header=HEADER, encoding="utf-8"):
    path = Path(folder) / name
    path.write_bytes("\n".join([header, *rows, ""]).encode(encoding))
    return path


def told(error):
    return [str(problem) for problem in error.value.problems]


# ---- a row's problems are its own


def test_a_table_is_read_without_its_wrong_rows_when_asked(tmp_path):
    path = write(tmp_path, TOO_WIDE, GOOD, UNFINISHED)
    with pytest.raises(InputError) as whole:
        read_family(path)
    table = read_family(path, partial=True)
    assert table.names == ("good",) and table.lines == (3,)
    assert table.refused == whole.value.problems
    assert {problem.row for problem in table.refused} == {"wide", "unfinished"}
    assert table["good"].refused == ()
    with pytest.raises(InputError, match="2.9 is not below the weft spacing"):
        table["wide"]


def test_a_sound_row_is_found_beside_wrong_ones(tmp_path):
    write(tmp_path, TOO_WIDE, GOOD, UNFINISHED, NO_FABRIC)
    row, others = find_row(tmp_path, "good")
    assert row.names == ("good",)
    assert [problem.row for error in others for problem in error.problems] == [
        "wide",
        "unfinished",
        "unfinished",
    ]
    with pytest.raises(InputError) as refused:
        find_row(tmp_path, "unfinished")
    assert [(problem.line, problem.column) for problem in refused.value.problems] == [
        (4, "weft_density_per_mm"),
        (4, "weft_width_mm"),
    ]


def test_list_shows_sound_rows_and_names_the_wrong(here, capsys):
    write("families", TOO_WIDE, GOOD, NO_FABRIC)
    assert main(["list"]) == 2
    printed = capsys.readouterr()
    rows = [line.split()[0] for line in printed.out.splitlines()]
    assert {"plain", "good", "satin8"} <= set(rows) and not {"wide", "thin"} & set(rows)
    assert [line.split()[0] for line in printed.err.splitlines()] == [
        "families/twill.csv:2:",
        "families/twill.csv:4:",
    ]


@pytest.mark.parametrize("wrong", [TOO_WIDE, UNFINISHED, NO_FABRIC])
def test_a_wrong_row_stops_its_own_cell_only(here, capsys, monkeypatch, wrong):
    write("families", wrong, GOOD)
    made = []
    monkeypatch.setattr(
        "fabric_cad.cell.pipeline.make_cell",
        lambda row, *rest: made.append(row.names) or {"warnings": []},
    )
    monkeypatch.setattr("fabric_cad.cell.summary.summary", lambda report: "made")
    assert main(["cell", "good"]) == 0 and made == [("good",)]
    monkeypatch.undo()
    capsys.readouterr()
    monkeypatch.chdir(here)
    assert main(["cell", wrong.split(",")[0], "-q"]) == 2
    assert capsys.readouterr().err.startswith("families/twill.csv:2: ")
    assert not Path("build").exists() or not any(Path("build").iterdir())


@pytest.mark.parametrize("command", ["solve", "validate"])
def test_whole_tables_are_refused_with_a_wrong_row(here, capsys, command):
    write("families", TOO_WIDE, GOOD)
    assert main([command]) == 2
    assert "families/twill.csv:2" in capsys.readouterr().err
    assert not Path("build/families/twill.csv").exists()


def test_a_table_that_cannot_be_read_stops_no_other(here, capsys):
    Path("families/twill.csv").write_text("name,ovr\nx,1\n")
    assert find_row("families", "plain")[0].names == ("plain",)
    assert main(["list"]) == 2
    printed = capsys.readouterr()
    assert "satin8" in printed.out and "families/twill.csv:1: ovr: unknown column" in printed.err
    with pytest.raises(InputError) as refused:  # it may hold the row
        find_row("families", "twill32")
    assert (
        "no row is called 'twill32'" in told(refused)[0] and "twill.csv:1: ovr" in told(refused)[1]
    )


def test_a_name_that_stands_twice_is_no_row(tmp_path):
    plain = "name,weft_density_per_mm,weft_width_mm,weft_crimp"
    write(tmp_path, GOOD, "Same,3,2,0.35,2.4,0.004", "same,3,2,0.35,2.4,0.005")
    write(tmp_path, "good,0.2,3,0.004", "other,0.2,3,0.004", name="plain.csv", header=plain)
    for name in ("good", "same"):
        with pytest.raises(InputError, match="this row name is also at"):
            find_row(tmp_path, name)
    tables = read_families(tmp_path, partial=True)
    assert tables["plain"].names == ("other",) and tables["twill"].names == ()
    assert "twill.csv:2" in str(tables["plain"].refused[0]) and "plain.csv:2" in str(
        tables["twill"].refused[-1]
    )


# ---- short rows


@pytest.mark.parametrize("family", WEAVE_COLUMNS)
def test_a_row_of_a_name_only_lacks_its_cells(tmp_path, family):
    needed = [*WEAVE_COLUMNS[family], "weft_density_per_mm", "weft_width_mm"]
    path = write(tmp_path, "r", name=f"{family}.csv", header=",".join(["name", *needed]))
    with pytest.raises(InputError) as refused:
        read_family(path)
    assert told(refused) == [f"{path}:2: {column}: this cell is empty (row r)" for column in needed]


@pytest.mark.parametrize("family", WEAVE_COLUMNS)
def test_every_beginning_of_a_row_is_read_or_refused(tmp_path, family, here):
    first, row = [
        line for line in Path(f"families/{family}.csv").read_text().splitlines() if line[0] != "#"
    ][:2]
    for cells in range(1, row.count(",") + 2):
        path = write(tmp_path, ",".join(row.split(",")[:cells]), name=f"{family}.csv", header=first)
        table = read_family(path, partial=True)
        assert len(table) + bool(table.refused) == 1


# ---- what is told


def test_a_cell_cannot_act_on_the_terminal(tmp_path):
    nasty = "\x1b]0;title\x07\u202e"
    path = write(tmp_path, f"a{nasty},3,2,0.35,2.4{nasty},0.004", header=HEADER)
    with pytest.raises(InputError) as refused:
        read_family(path)
    text = str(refused.value) + str(Problem(nasty, f"a{nasty}", 1, nasty, nasty, nasty))
    assert text.replace("\n", "").isprintable() and "\\x1b]0;title" in text and "\\u202e" in text


def test_problems_beyond_fifty_are_counted(tmp_path):
    path = write(tmp_path, *(f"r{number},3,2,0.35,2.4,x" for number in range(1000)))
    with pytest.raises(InputError) as refused:
        read_family(path)
    lines = str(refused.value).splitlines()
    assert len(refused.value.problems) == 1000 and len(lines) == 51
    assert lines[-1] == f"{path}: and 950 more"


@pytest.mark.parametrize("digits", ["٠.٣٥", "０.３５", "0.3٥", "०", "²"])
def test_digits_of_other_scripts_are_no_numbers(tmp_path, digits):
    for row in (f"r,3,2,{digits},2.4,0.004", f"r,{digits[-1]},2,0.35,2.4,0.004"):
        with pytest.raises(InputError, match="is not a (whole )?number"):
            read_family(write(tmp_path, row))


@pytest.mark.parametrize(
    "option",
    [["study", "s.toml", "--workers"], ["cell", "plain", "--across"], ["cell", "plain", "--size"]],
)
@pytest.mark.parametrize("digits", ["٣", "1_0", "²", "nan"])
def test_options_take_ascii_numbers_only(here, capsys, option, digits):
    with pytest.raises(SystemExit) as stopped:
        main([*option, digits])
    assert stopped.value.code == 2 and repr(digits) in capsys.readouterr().err


# ---- files


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-8-sig"])
def test_text_with_a_byte_order_mark(tmp_path, encoding):
    mark = "\ufeff" if encoding.endswith("e") else ""
    path = write(tmp_path, f"{GOOD},naïve", header=f"{mark}{HEADER},notes", encoding=encoding)
    table = read_family(path)
    assert (
        table.names == ("good",)
        and table.notes == ("naïve",)
        and table.measured["weft_crimp"][0] == 0.004
    )


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        (f"{HEADER}\n{GOOD}\n".encode("utf-16-le"), ":1: this line holds a NUL character"),
        (f"{HEADER}\n{GOOD}\n\0".encode(), ":3: this line holds a NUL character"),
        (f"\ufeff{HEADER}".encode("utf-16-le") + b"\n", ":1: not UTF-16 text"),
        (b"PK\x03\x04...", ": this is a workbook"),
        (b"\xd0\xcf\x11\xe0...", ": this is an old or an encrypted workbook"),
        (f"sep=\xb5\xb5\n{HEADER}\n".encode(), ":1: sep=\xb5\xb5: unknown column"),
    ],
)
def test_files_that_are_no_text_tables(tmp_path, raw, expected):
    path = tmp_path / "twill.csv"
    path.write_bytes(raw)
    with pytest.raises(InputError) as refused:
        read_family(path)
    assert f"{path}{expected}" in told(refused)[0]


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("Twill.csv", "twill.csv"),
        ("TWILL.CSV", "twill.csv"),
        ("twil.csv", "twill.csv"),
        ("satins.xls", "satin.xlsx"),
        ("twill.csv.txt", "twill.csv"),
        ("Plain.ods", "plain.ods"),
    ],
)
def test_files_nearly_called_as_tables_are_named(tmp_path, capsys, name, meant):
    write(tmp_path, GOOD, name=name)
    hint = f"{tmp_path / name}: this file is not read; a table of that kind is called {meant}"
    with pytest.raises(InputError) as alone:
        read_families(tmp_path)
    assert "no family table in this folder" in told(alone)[0] and told(alone)[1] == hint
    header = HEADER.replace("over,under", "pattern")
    write(tmp_path, "r,oouu/ouuo/uuoo/uoou,0.2,3,0.004", name="pattern.csv", header=header)
    assert main(["list", "--families", str(tmp_path)]) == 0
    assert f"note: {hint}\n" in capsys.readouterr().err
    with pytest.raises(InputError) as beside:
        find_row(tmp_path, "good")
    assert told(beside)[1] == hint
    with pytest.raises(InputError, match=f"not a family table; did you mean {meant}"):
        read_family(tmp_path / name)


@pytest.mark.parametrize(
    "name", ["simulation.toml", "notes.txt", "~$twill.xlsx", ".~lock.twill.ods#", "knit.csv"]
)
def test_other_files_are_left_alone(here, capsys, name):
    Path("families", name).write_text("") if name != "simulation.toml" else None
    assert main(["list"]) == 0
    assert "not read" not in capsys.readouterr().err


# ---- tables as a library's values


def test_tables_are_iterated_and_asked(here):
    from fabric_cad import identify

    family = read_family("families/plain.csv")
    for table in (family, identify(family)):
        assert "plain" in table and "no" not in table and table.names[0] == "plain"
        assert len(list(table)) == len(table) == len(table.names)
        with pytest.raises(
            UnknownRowError, match="no row is called 'plane'; did you mean plain"
        ) as unknown:
            table["plane"]
        assert isinstance(unknown.value, KeyError) and isinstance(unknown.value, InputError)
        with pytest.raises(ArgumentError, match="named by a text, not int 3"):
            table[3]
    assert [row.names for row in family] == [(name,) for name in family.names]
    assert [fabric.name for fabric in identify(family)] == list(family.names)


def test_arguments_of_the_wrong_kind(here):
    import fabric_cad

    table = fabric_cad.read_family("families/plain.csv")
    for call in (
        lambda: fabric_cad.read_family(7),
        lambda: fabric_cad.identify("families/plain.csv"),
        lambda: fabric_cad.propagate(None),
        lambda: fabric_cad.build_cell(table),
        lambda: fabric_cad.make_cell("plain", "build"),
        lambda: fabric_cad.make_cell(table, "build"),
    ):
        with pytest.raises(ArgumentError, match="expected .*, got") as refused:
            call()
        assert isinstance(refused.value, TypeError)
