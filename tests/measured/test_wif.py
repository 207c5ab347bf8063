"""Weaving drafts: what they weave, whichever way they tell it, and what is wrong with them."""

import pytest

from fabric_cad.cli import main
from fabric_cad.measured.tables import read_family
from fabric_cad.measured.wif import read_wif, wif_row
from fabric_cad.support.errors import InputError

TWILL22 = ("0011", "1001", "1100", "0110")


def draft(**sections):
    """A draft of twill 2/2 on four shafts, eight warps and eight picks, changed by ``sections`` (None: without)."""
    numbers = range(8)
    parts = {
        "WIF": "Version=1.1\nDate=April 20, 1997\nDevelopers=wif@mhsoft.com\nSource Program=none",
        "CONTENTS": "THREADING=yes\nTIEUP=yes\nTREADLING=yes",
        "TEXT": "Title=100% twill = 2/2",
        "WEAVING": "Shafts=4\nTreadles=4\nRising Shed=true",
        "WARP": "Threads=8\nUnits=centimeters\nSpacing=0.2",
        "WEFT": "Threads=8",
        "THREADING": "\n".join(f"{k + 1}={k % 4 + 1}" for k in numbers),
        "TIEUP": "1=1,2\n2=2,3\n3=3, 4\n4=1,4",
        "TREADLING": "\n".join(f"{k + 1}={k % 4 + 1}" for k in numbers),
    }
    parts |= {name.replace("_", " ").upper(): text for name, text in sections.items()}
    return (
        "\n\n".join(f"[{name}]\n{text}" for name, text in parts.items() if text is not None) + "\n"
    )


LIFTPLAN = "\n".join(f"{k + 1}={k % 4 + 1},{(k + 1) % 4 + 1}" for k in range(8))


@pytest.fixture
def read(tmp_path):
    def read_text(text, encoding="utf-8"):
        path = tmp_path / "draft.wif"
        path.write_bytes(text.encode(encoding))
        return read_wif(path)

    return read_text


def test_tie_up_and_liftplan_weave_the_same(read):
    assert read(draft()) == TWILL22
    assert read(draft(tieup=None, treadling=None, liftplan=LIFTPLAN)) == TWILL22
    assert read(draft(liftplan=LIFTPLAN)) == TWILL22


def test_a_sinking_shed_weaves_the_complement(read):
    sinking = read(draft(weaving="Rising Shed=no"))
    assert sinking == tuple(row.translate(str.maketrans("01", "10")) for row in TWILL22)
    assert read(draft(weaving=None)) == TWILL22  # rising where the draft does not say


def test_several_treadles_at_once_are_all_their_shafts(read):
    one_shaft_each = "1=1\n2=2\n3=3\n4=4"
    assert read(draft(tieup=one_shaft_each, treadling=LIFTPLAN)) == TWILL22


def test_a_warp_on_two_shafts_rises_with_either(read):
    two = "\n".join(f"{k + 1}={k % 4 + 1},{(k + 1) % 4 + 1}" for k in range(8))
    assert read(draft(tieup="1=1\n2=2\n3=3\n4=4", threading=two)) == (
        "0110",
        "0011",
        "1001",
        "1100",
    )


@pytest.mark.parametrize("threads", [8, 9, 11])
def test_the_repeat_need_not_end_with_the_draft(read, threads):
    cells = "\n".join(f"{k + 1}={k % 4 + 1}" for k in range(threads))
    assert read(draft(warp=f"Threads={threads}", threading=cells)) == TWILL22


def test_a_draft_that_is_no_whole_repeat_of_less_is_kept(read):
    cells = "\n".join(f"{k + 1}={k % 4 + 1}" for k in range(6))
    assert [len(row) for row in read(draft(warp="Threads=6", threading=cells))] == [6] * 4


def test_what_programs_write_differently(read):
    text = draft(
        notes="1=a note\n; a comment\nno value here\n1=another", color_table="1=0,0,0\n1=9,9,9"
    )
    for other in (
        text.replace("\n", "\r\n"),
        "\ufeff" + text,
        text.replace("[WARP]", "[Warp]").replace("Threads=", "THREADS = "),
        text.replace("\n1=1\n", "\n  1=1\n"),
        text.replace("3=3, 4", "3=0,3 ,4,"),
        text.replace("3=3, 4", "3=3,4 ; both"),
        text.replace("3=3, 4", "03=3,4"),
        text.replace("[TIEUP]", "[ Tieup ]"),
        text.replace("[CONTENTS]\nTHREADING=yes\nTIEUP=yes\nTREADLING=yes\n", ""),
        text.replace("Shafts=4\nTreadles=4\n", ""),
        text.replace("Shafts=4\nTreadles=4\n", "Shafts=0\nTreadles=\n"),
        text.replace("Threads=8", "Threads=0"),  # as many as are listed
        text.replace("[WEFT]\nThreads=8", ""),
        text.replace("[THREADING]\n", "[THREADING]\n9=0\n"),  # no thread, on no shaft
        text.replace("[TEXT]\n", "[TEXT]\n[WARP COLORS] default = 3\nfree text\n"),
        text
        + "[WARP]\n\n[LIFTPLAN]\n[TIEUP]\n1=1,2\n[THREADING]\n1=\n",  # blank, and the same again
        text + "\x1a",
    ):
        assert read(other) == TWILL22
    for encoding in ("cp1252", "utf-16"):
        assert read(text.replace("Title=", "Title=é “"), encoding) == TWILL22


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "draft.wif: not a weaving draft: it has no section [WIF]"),
        ("name,over\n", "draft.wif:1: not a weaving draft: this line comes before any [SECTION]"),
        (draft(wif=None), "draft.wif: not a weaving draft: it has no section [WIF]"),
        (draft(weft="Threads=many"), "draft.wif:26: [WEFT] Threads: 'many' is not a whole number"),
        (
            draft(weft="Threads=1000000"),
            "draft.wif:26: [WEFT] Threads: 1000000 is not between 1 and 5000",
        ),
        (draft(threading=None), "draft.wif: [THREADING]: this section is missing or empty"),
        (
            draft(warp="Threads=10"),
            "draft.wif:26: [THREADING]: thread 9 of 10 hangs on no shaft: warp 9 passes under every yarn and never "
            "interlaces, nor do 1 more; write [WARP] Threads=8 if the draft ends there",
        ),
        (
            draft(warp="Threads=7"),
            "draft.wif:34: [THREADING] 8: this is no thread; the draft has 7 of them",
        ),
        (
            draft(treadling=None),
            "draft.wif: [TREADLING]: this section is missing or empty, and there is no [LIFTPLAN]",
        ),
        (draft(tieup=None), "draft.wif: [TIEUP]: this section is missing or empty"),
        (
            draft(tieup="1=1,2\n2=2,3\n3=3,4"),
            "draft.wif:47: [TREADLING] 4: treadle 4 is not in [TIEUP]",
        ),
        (
            draft(tieup="1=1;2\n2=2,3\n3=3,4\n4=4,1"),
            "draft.wif:39: [TIEUP] 1: '1;2' is not a list of whole numbers",
        ),
        (draft(tieup="1=1,-2"), "draft.wif:39: [TIEUP] 1: '1,-2' is not a list of whole numbers"),
        (draft(tieup="one=1"), "draft.wif:39: [TIEUP] One: this key is not a number"),
        (draft(tieup="0=1"), "draft.wif:39: [TIEUP] 0: numbers count from 1"),
        (draft(tieup="1"), "draft.wif:39: [TIEUP]: not a line of the form KEY=VALUE"),
        (
            draft(weaving="Rising Shed=perhaps"),
            "[WEAVING] Rising Shed: 'perhaps' is neither true nor false",
        ),
        (
            draft(tieup="1=1\n1=2"),
            "draft.wif:40: [TIEUP] 1: this key stands twice, at line 39 as '1'",
        ),
        (draft(tieup="1=1\n01=2"), "draft.wif:40: [TIEUP] 01: this key stands twice"),
        (
            draft() + "[WARP]\nThreads=9\n",
            "[WARP] Threads: this key stands twice, at line 21 as '8'",
        ),
        (
            draft(tieup="1=1,2\n2=2,3\n3=3,4\n4=0"),
            "draft.wif:48: [TREADLING] 4: pick 4 of 8 moves no shaft: weft 4 passes over every yarn and never "
            "interlaces, nor do 1 more",
        ),
        (
            draft(tieup="1=1,2\n2=2,3\n3=1,2,3,4\n4=1"),
            "weft 3 passes under every yarn and never interlaces",
        ),
        (
            draft(tieup="1=1\n2=3\n3=1\n4=3"),
            "draft.wif:30: [THREADING] 2: no pick moves shaft 2: warp 2 passes under every yarn and never interlaces",
        ),
        (
            draft(tieup="1=1,2\n2=2,3\n3=3,4,5\n4=1,4"),
            "draft.wif:41: [TIEUP] 3: shaft 5 is beyond the 4 of [WEAVING] Shafts",
        ),
        (
            draft(
                weaving="Shafts=3", threading="\n".join(f"{k + 1}={k % 4 + 1}" for k in range(8))
            ),
            "draft.wif:30: [THREADING] 4: shaft 4 is beyond the 3 of [WEAVING] Shafts",
        ),
        (draft(liftplan="1=1,9\n2=2"), "[LIFTPLAN] 1: shaft 9 is beyond the 4 of [WEAVING] Shafts"),
        (
            draft(weaving="Shafts=4\nTreadles=3"),
            "draft.wif:47: [TREADLING] 4: treadle 4 is beyond the 3 of [WEAVING] Treadles",
        ),
    ],
)
def test_what_is_wrong_is_told_with_its_place(read, text, expected):
    with pytest.raises(InputError) as refused:
        read(text)
    assert expected in str(refused.value)


def test_a_repeat_larger_than_a_table_takes(read):
    cells = "\n".join(f"{k + 1}={k % 2 + 1 if k != 5 else 3}" for k in range(120))
    with pytest.raises(
        InputError, match="its repeat of 4 wefts x 120 warps is more than 100 in a direction"
    ):
        read(draft(warp="Threads=120", threading=cells))


def test_an_unlisted_pick_between_others_lifts_nothing(read):
    picks = "\n".join(f"{k + 1}={k % 4 + 1}" for k in range(8) if k != 4)
    with pytest.raises(
        InputError,
        match=r"\[TREADLING\]: pick 5 of 8 moves no shaft: weft 5 passes over .*interlaces$",
    ):
        read(draft(treadling=picks))
    with pytest.raises(InputError, match="weft 5 passes under every yarn"):
        read(draft(treadling=picks, weaving="Rising Shed=false"))


def cells_of(folder, **sections):
    """The cells of the row of a draft, by column."""
    path = folder / "my.wif"
    path.write_text(draft(**sections))
    header, row = wif_row(path, "mine").splitlines()
    return dict(zip(header.split(","), row.split(","), strict=True))


@pytest.mark.parametrize(
    ("text", "per_mm"),
    [
        ("Units=Decipoints\nSpacing=36", 1 / 1.27),  # 720 to an inch
        ("Units=inches\nSpacing=0.05", 1 / 1.27),
        ("Units=Centimeters\nSpacing=.127", 1 / 1.27),
        ("Units=centimeters\nSpacing=0,127", 1 / 1.27),
        ("Units=cm\nSpacing=0.2117", 12 / 25.4),  # 12 ends an inch, as programs round it
    ],
)
def test_spacings_are_densities(tmp_path, text, per_mm):
    cells = cells_of(
        tmp_path, warp=f"Threads=8\n{text}", weft="Threads=8\nUnits=inches\nSpacing=0.1"
    )
    assert float(cells["warp_density_per_mm"]) == pytest.approx(per_mm, rel=1e-3)
    assert float(cells["weft_density_per_mm"]) == pytest.approx(1 / 2.54, rel=1e-5)
    assert cells["warp_thickness_mm"] == cells["weft_thickness_mm"] == cells["notes"] == ""


def test_a_thickness_below_the_spacing_is_the_yarns(tmp_path):
    both = "Threads=8\nUnits=centimeters\nSpacing=0.2\nThickness="
    cells = cells_of(tmp_path, warp=f"{both}0.15", weft=f"{both}0.2")
    assert (cells["warp_thickness_mm"], cells["weft_thickness_mm"]) == ("1.5", "")


def test_threads_with_spacings_of_their_own_have_their_mean(tmp_path):
    warp = "Threads=8\nUnits=centimeters\nSpacing=0.2"
    cells = cells_of(tmp_path, warp=warp, warp_spacing="1=0.4\n2=0.4")
    assert float(cells["warp_density_per_mm"]) == pytest.approx(8 / (6 * 2 + 2 * 4), rel=1e-5)


def test_a_spacing_in_no_unit_is_noted_and_no_density(tmp_path):
    cells = cells_of(tmp_path, warp="Threads=8\nSpacing=0.2")
    assert cells["warp_density_per_mm"] == cells["weft_density_per_mm"] == ""
    assert cells["notes"] == "warp spacing 0.2 in no unit"


@pytest.mark.parametrize(
    ("warp", "words"),
    [
        (
            "Threads=8\nUnits=furlongs\nSpacing=1",
            ":22: [WARP] Units: 'furlongs' is none of decipoints, inches and",
        ),
        (
            "Threads=8\nUnits=inches\nSpacing=wide",
            ":23: [WARP] Spacing: 'wide' is not a number above 0",
        ),
        (
            "Threads=8\nUnits=inches\nSpacing=-1",
            ":23: [WARP] Spacing: '-1' is not a number above 0",
        ),
    ],
)
def test_a_spacing_that_cannot_be_read_is_told_with_its_line(tmp_path, warp, words):
    with pytest.raises(InputError) as refused:
        cells_of(tmp_path, warp=warp)
    assert words in str(refused.value)


def test_the_command_prints_a_row_that_the_table_takes(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.wif").write_text(draft(weft="Threads=8\nUnits=centimeters\nSpacing=0.25"))
    assert main(["wif", "my.wif", "--name", "mine"]) == 0
    header, row = capsys.readouterr().out.splitlines()
    assert row.startswith("mine,uuoo/ouuo/oouu/uoou,0.4,")
    cells = dict(zip(header.split(","), row.split(","), strict=True))
    cells |= {
        f"{d}_{name}": value
        for d in ("weft", "warp")
        for name, value in (("width_mm", "1.6"), ("crimp", "0.01"))
    }
    cells |= {"weft_thickness_mm": "0.3"}
    (tmp_path / "pattern.csv").write_text(f"{header}\n{','.join(cells.values())}\n")
    table = read_family("pattern.csv")["mine"]
    assert table.weaves[0].pattern == TWILL22
    assert (table.measured["weft_density_per_mm"][0], table.measured["warp_density_per_mm"][0]) == (
        0.4,
        0.5,
    )


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["none.wif", "--name", "mine"], "none.wif: cannot be read: No such file"),
        (["my.wif", "--name", "a b"], "name: 'a b' is no row name"),
    ],
)
def test_the_command_refuses(tmp_path, capsys, monkeypatch, arguments, expected):
    monkeypatch.chdir(tmp_path)
    assert main(["wif", *arguments]) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.startswith(expected)
