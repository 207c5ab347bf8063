"""A row being edited: answers, refusals, steps back, links, and a table in which only that row changes."""

import random
import shutil

import numpy as np
import pytest
from fabrics import DRAWS, table

from fabric_cad.measured.columns import MEASURED
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families, read_family
from fabric_cad.model.identification import identify
from fabric_cad.page.edited import EditedRow, Solution, answer, edited
from fabric_cad.page.figures import comparisons, expected_quality, figures
from fabric_cad.page.links import link_of, row_of
from fabric_cad.page.saving import RowExistsError, save_row
from fabric_cad.page.session import Session
from fabric_cad.support.errors import InputError, OutputError

ROWS = {
    row.names[0]: row for measured in read_families(shipped_families()).values() for row in measured
}


def same_fabric(first, second):
    """Whether two solved fabrics are one to the last digits, whatever they are called."""
    for direction in ("weft", "warp"):
        one, two = first.directions[direction], second.directions[direction]
        assert np.allclose(one.points, two.points, rtol=1e-9, atol=1e-12)
        assert np.isclose(
            [one.width, one.thickness, one.crimp], [two.width, two.thickness, two.crimp], rtol=1e-9
        ).all()
    assert np.array_equal(first.weave.interlacement(), second.weave.interlacement())
    return True


@pytest.mark.parametrize("name", ROWS)
def test_a_row_of_a_table_is_edited_as_the_fabric_it_is(name):
    found = answer(edited(ROWS[name]))
    assert same_fabric(found.fabric, identify(ROWS[name])[name])
    expected = identify(ROWS[name]).comparisons[0]
    assert [told[0] for told in comparisons(found)] == [told[0] for told in expected]
    assert np.allclose(
        [told[1:] for told in comparisons(found)], [told[1:] for told in expected], rtol=1e-9
    )


@pytest.mark.parametrize("name", ROWS)
def test_a_link_holds_the_row(name):
    row = edited(ROWS[name])
    again = row_of(link_of(row))
    assert again.family == row.family
    assert dict(again.cells) == {
        c: text for c, text in row.cells.items() if c not in ("source", "notes")
    }


@pytest.mark.parametrize(
    ("link", "word"),
    [
        ("velvet?name=a", "none of plain"),
        ("plain?nmae=a", "nmae"),
        ("plain?name=a&name=b", "twice"),
        ("plain?name", "holds no row"),
        ("plain?" + "name=a" * 9000, "characters"),
        ("twill?pattern=ou/uo", "unknown column of twill.csv"),
    ],
)
def test_a_link_that_holds_none_is_refused(link, word):
    with pytest.raises(InputError, match=word):
        row_of(link)


def test_a_refusal_names_its_column_and_the_last_good_fabric_stays():
    session = Session(edited(ROWS["twill32"]))
    good = session.good
    session.change("weft_width_mm", "2.9")  # the spacing is 2.857 mm
    assert session.refused and session.good is good
    told = {
        quantity.column: quantity.refusal for quantity in session.quantities() if quantity.refusal
    }
    assert (
        list(told) == ["weft_width_mm"]
        and "not below the weft spacing 2.857 mm" in told["weft_width_mm"]
    )

    session.change("weft_width_mm", "2.5")
    assert not session.refused and session.good.fabric.weft.width == 2.5
    session.change("weft_width_mm", "two")
    assert "is not a number" in session.problems[0].message


def test_crimp_gives_thickness_and_thickness_crimp():
    session = Session(edited(ROWS["twill32"]))
    roles = {quantity.column: quantity for quantity in session.quantities()}
    assert roles["weft_crimp"].role == "identifies" and roles["weft_thickness_mm"].role == "follows"

    thickness = roles["weft_thickness_mm"].model
    session.edit(session.row.changed(weft_crimp="", weft_thickness_mm=repr(thickness)))
    roles = {quantity.column: quantity for quantity in session.quantities()}
    assert roles["weft_thickness_mm"].role == "identifies"
    assert roles["weft_crimp"].role == "follows" and roles["weft_crimp"].model == pytest.approx(
        0.004, rel=1e-9
    )


def test_undo_and_redo_are_each_others_inverse_over_random_edits():
    rng, session = random.Random(5), Session(edited(ROWS["twill22"]))
    rows = [session.row]
    for _ in range(40):
        column = rng.choice(MEASURED[:8])
        session.change(column, f"{rng.uniform(0.001, 3):.4g}")
        if session.row != rows[-1]:
            rows.append(session.row)
    for row in reversed(rows[:-1]):
        session.undo()
        assert session.row == row
    assert not session.can_undo
    for row in rows[1:]:
        session.redo()
        assert session.row == row
    assert not session.can_redo


def test_a_sliders_way_is_one_step():
    session = Session(edited(ROWS["twill22"]))
    for width in ("2.3", "2.2", "2.1"):
        session.change("weft_width_mm", width, moving=True)
    session.undo()
    assert session.row.cells["weft_width_mm"] == "2.4" and not session.can_undo


def test_a_flip_twice_is_the_same_interlacement_and_resizing_repeats():
    row = edited(ROWS["satin8"])
    matrix = identify(ROWS["satin8"])["satin8"].weave.interlacement()
    once = row.flipped([(2, 3), (0, 0)])
    assert once.family == "pattern" and "harness" not in once.cells
    assert (np.array([list(weft) for weft in once.grid()]) != np.where(matrix, "1", "0")).sum() == 2
    assert once.flipped([(2, 3), (0, 0)]).grid() == row.grid()

    double = row.resized(16, 8)
    assert double.grid() == row.grid() * 2
    assert isinstance(answer(double), Solution)


def test_what_is_no_weave_is_told_at_the_pattern():
    plain = edited(ROWS["plain"])
    problems = answer(plain.flipped([(0, 0)]))
    assert {problem.column for problem in problems} == {"pattern"}
    assert "never interlaces" in problems[0].message


@pytest.mark.parametrize("name", [name for name in ROWS if "round" not in name])
def test_figures_are_those_of_the_model(name):
    found = answer(edited(ROWS[name]))
    told = {figure.key: figure for figure in figures(found)}
    fabric = identify(ROWS[name])[name]
    assert told["identified.fabric_thickness_mm"].value == pytest.approx(
        fabric.fabric_thickness, rel=1e-9
    )
    assert told["identified.weft.crimp"].value == pytest.approx(100 * fabric.weft.crimp, rel=1e-9)
    assert 20 < told["volumes.yarn_volume_fraction"].value < 90
    assert ("volumes.areal_density_g_m2" in told) == ("tex" in " ".join(edited(ROWS[name]).cells))
    assert (told["identified.weft.thickness_mm"].std is not None) == bool(ROWS[name].scattered[0])
    assert 0 < expected_quality(found).value <= 1


# ---- saving --------------------------------------------------------------------------------------


def lines_of(path):
    return path.read_bytes().splitlines(keepends=True)


@pytest.mark.parametrize("family", ["plain", "twill", "satin", "pattern"])
@pytest.mark.parametrize("style", ["", "bom crlf", "no end", "semicolons"])
def test_saving_adds_one_line_and_leaves_every_other_byte(here, family, style):
    path = here / "families" / f"{family}.csv"
    raw = path.read_bytes()
    if style == "bom crlf":
        raw = b"\xef\xbb\xbf" + raw.replace(b"\n", b"\r\n")
    elif style == "no end":
        raw = raw.rstrip(b"\n")
    elif style == "semicolons":
        header = "name;over;under;harness;step;pattern;weft_density_per_cm;weft_width_mm;weft_crimp_percent"
        raw = f"{header}\nmine;;;;;;3,5;2,4;0,4\n".encode()
        own = {
            "plain": (),
            "twill": ("over", "under"),
            "satin": ("harness", "step"),
            "pattern": ("pattern",),
        }[family]
        columns = [c for c in header.split(";") if c in own or c.startswith(("name", "weft"))]
        values = {
            "over": "2",
            "under": "2",
            "harness": "5",
            "step": "2",
            "pattern": "ou/uo",
            "name": "mine",
        }
        values |= dict(zip(columns[-3:], ("3,5", "2,4", "0,4")))
        raw = (";".join(columns) + "\n" + ";".join(values[c] for c in columns) + "\n").encode()
    path.write_bytes(raw)

    source = next(row for row in read_family(path) if not row.scattered[0])
    row = edited(source).changed(name="new", weft_width_mm="0.9", source="", notes="")
    saved = save_row(row, "families")
    after = path.read_bytes()
    rest = raw if raw.endswith(b"\n") else raw + b"\n"
    if saved.added:
        assert [line for line in after.splitlines()[1:-1]] == rest.splitlines()[1:]
    else:
        assert after.startswith(rest) and after[len(rest) :].count(b"\n") == 1
    assert same_fabric(identify(read_family(path))["new"], answer(row).fabric)
    assert not saved.replaced


def test_saving_changes_the_row_asked_for_only_and_only_when_asked(here):
    path = here / "families" / "twill.csv"
    before = lines_of(path)
    row = edited(ROWS["twill22_measured"]).changed(weft_width_mm="2.35")
    with pytest.raises(RowExistsError, match="there already"):
        save_row(row, "families")
    assert lines_of(path) == before

    assert save_row(row, "families", replace=True).replaced
    after = lines_of(path)
    different = [(old, new) for old, new in zip(before, after, strict=True) if old != new]
    assert len(different) == 1
    assert different[0][1] == different[0][0].replace(b",2.4,", b",2.35,")


def test_a_row_with_line_breaks_in_a_cell_is_changed_as_a_whole(here):
    path = here / "families" / "plain.csv"
    path.write_text('name,weft_density_per_mm,weft_width_mm,weft_crimp,notes\na,0.22,3.2,0.004,"one\ntwo, three"\n'
                    "# a remark\n\nb,0.22,3.1,0.004,\n")  # fmt: skip
    save_row(edited(read_family(path)["a"]).changed(weft_crimp="0.005"), "families", replace=True)
    assert path.read_text() == (
        'name,weft_density_per_mm,weft_width_mm,weft_crimp,notes\na,0.22,3.2,0.005,"one\ntwo, three"\n'
        "# a remark\n\nb,0.22,3.1,0.004,\n"
    )


def test_a_new_column_is_added_to_the_header_alone(here):
    path = here / "families" / "satin.csv"
    path.write_text(
        "name,harness,step,weft_density_per_mm,weft_width_mm,weft_crimp\ns,5,2,0.7,1.2,0.003\n"
    )
    row = edited(read_family(path)["s"]).changed(name="t", section="flat", lateral_height_mm="0.01")
    assert "lateral_height_mm" in save_row(row, "families").added
    first, second, _ = path.read_text().splitlines()
    assert first.startswith("name,harness,step,weft_density_per_mm,weft_width_mm,weft_crimp,")
    assert second == "s,5,2,0.7,1.2,0.003"


def test_a_header_with_blank_cells_at_its_end_takes_new_columns_in_their_place(here):
    path = here / "families" / "satin.csv"
    path.write_text(
        "name;harness;step;weft_density_per_mm;weft_width_mm;weft_crimp;;\ns;5;2;0,7;1,2;0,003;;\n"
    )
    row = edited(read_family(path)["s"]).changed(name="t", section="flat", lateral_height_mm="0.01")
    save_row(row, "families")
    assert path.read_text().splitlines()[1] == "s;5;2;0,7;1,2;0,003;;"
    assert edited(read_family(path)["t"]) == row


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"name": ""}, "name"),
        ({"name": "../up"}, "no safe file name"),
        ({"name": "satin5"}, "in satin.csv"),
        ({"name": "new", "weft_width_mm": "9"}, "not below the weft spacing"),
    ],
)
def test_what_the_reader_refuses_is_not_saved(here, changes, word):
    path = here / "families" / "plain.csv"
    before = path.read_bytes()
    with pytest.raises(InputError, match=word):
        save_row(edited(ROWS["plain"]).changed(**changes), "families")
    assert path.read_bytes() == before
    assert sorted(p.name for p in path.parent.iterdir() if p.name.startswith(".")) == []


def test_a_link_or_a_workbook_is_not_written_to(here):
    path = here / "families" / "plain.csv"
    shutil.move(path, here / "elsewhere.csv")
    path.symlink_to(here / "elsewhere.csv")
    with pytest.raises(OutputError, match="link"):
        save_row(edited(ROWS["plain"]).changed(name="new"), "families")


def test_random_rows_are_saved_and_read_back(here):
    rng = np.random.default_rng(1)
    for part, draw in DRAWS.items():
        for number in range(4):
            try:
                family, cells = draw(rng)
                row = edited(table(family, cells)).changed(name=f"{part}_{number}")
            except InputError:
                continue
            save_row(row, "families")
            kept = edited(read_family(here / "families" / f"{family}.csv")[row.name])
            assert kept == row


def test_columns_and_families_are_checked_where_a_row_is_made():
    with pytest.raises(InputError, match="unknown column"):
        EditedRow("plain", {"over": "2"})
    with pytest.raises(InputError, match="none of"):
        EditedRow("knit", {})
