"""Weaving drafts: what they weave, whichever way they tell it, and what is wrong with them."""

import pytest

from fabric_cad.cli import main
from fabric_cad.errors import InputError
from fabric_cad.tables import read_family
from fabric_cad.wif import read_wif

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
    return "\n\n".join(f"[{name}]\n{text}" for name, text in parts.items() if text is not None) + "\n"


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
    assert read(draft(tieup="1=1\n2=2\n3=3\n4=4", threading=two)) == ("0110", "0011", "1001", "1100")


@pytest.mark.parametrize("threads", [8, 9, 11])
def test_the_repeat_need_not_end_with_the_draft(read, threads):
    cells = "\n".join(f"{k + 1}={k % 4 + 1}" for k in range(threads))
    assert read(draft(warp=f"Threads={threads}", threading=cells)) == TWILL22


def test_a_draft_that_is_no_whole_repeat_of_less_is_kept(read):
    cells = "\n".join(f"{k + 1}={k % 4 + 1}" for k in range(6))
    assert [len(row) for row in read(draft(warp="Threads=6", threading=cells))] == [6] * 4


def test_what_programs_write_differently(read):
    text = draft(notes="1=a note\n; a comment\nno value here")
    for other in (
        text.replace("\n", "\r\n"),
        "\ufeff" + text,
        text.replace("[WARP]", "[Warp]").replace("Threads=", "THREADS = "),
        text.replace("\n1=1\n", "\n  1=1\n"),
        text.replace("3=3, 4", "3=0,3 ,4"),
    ):
        assert read(other) == TWILL22
    assert read(text.replace("Title=", "Title=é "), "latin-1") == TWILL22


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "draft.wif: not a weaving draft: it has no section [WIF]"),
        ("name,over\n", "draft.wif:1: not a weaving draft: this line comes before any [SECTION]"),
        (draft(wif=None), "draft.wif: not a weaving draft: it has no section [WIF]"),
        (draft(warp=None), "draft.wif: [WARP]: this section is missing or empty"),
        (draft(weft="Units=Inches"), "draft.wif: [WEFT] Threads: this key is missing"),
        (draft(weft="Threads=many"), "draft.wif: [WEFT] Threads: 'many' is not a list of whole numbers"),
        (draft(weft="Threads=0"), "draft.wif: [WEFT] Threads: 0 is not between 1 and 5000"),
        (draft(weft="Threads=1000000"), "draft.wif: [WEFT] Threads: 1000000 is not between 1 and 5000"),
        (draft(threading=None), "draft.wif: [THREADING]: this section is missing or empty"),
        (draft(warp="Threads=10"), "draft.wif: [THREADING]: thread 9 of 10 is missing, and 1 more"),
        (draft(warp="Threads=7"), "draft.wif: [THREADING] 8: this is no thread; the draft has 7 of them"),
        (draft(treadling=None), "draft.wif: [TREADLING]: this section is missing or empty, and there is no [LIFTPLAN]"),
        (draft(tieup=None), "draft.wif: [TIEUP]: this section is missing or empty"),
        (draft(tieup="1=1,2\n2=2,3\n3=3,4"), "draft.wif: [TREADLING] 4: treadle 4 is not in [TIEUP]"),
        (draft(tieup="1=1;2\n2=2,3\n3=3,4\n4=4,1"), "draft.wif: [TIEUP] 1: '1;2' is not a list of whole numbers"),
        (draft(weaving="Rising Shed=perhaps"), "draft.wif: [WEAVING] Rising Shed: 'perhaps' is neither true nor false"),
        (draft(tieup="1=1\n1=2"), "[TIEUP] 1: this key stands twice"),
        (draft() + "[WARP]\n", "[WARP]: this section stands twice"),
        (draft(tieup="1=1,2\n2=2,3\n3=1,2,3,4\n4=0"), "weft 3 passes under every yarn and never interlaces"),
        (draft(tieup="1=1\n2=3\n3=1\n4=3"), "warp 2 passes under every yarn and never interlaces"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(read, text, expected):
    with pytest.raises(InputError) as refused:
        read(text)
    assert expected in str(refused.value)


def test_a_repeat_larger_than_a_table_takes(read):
    cells = "\n".join(f"{k + 1}={k % 2 + 1 if k != 5 else 3}" for k in range(120))
    with pytest.raises(InputError, match="its repeat of 4 wefts x 120 warps is more than 100 in a direction"):
        read(draft(warp="Threads=120", threading=cells))


def test_the_command_prints_a_row_that_the_table_takes(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my.wif").write_text(draft())
    assert main(["wif", "my.wif", "--name", "mine"]) == 0
    header, row = capsys.readouterr().out.splitlines()
    assert row.startswith("mine,uuoo/ouuo/oouu/uoou,,")
    cells = dict(zip(header.split(","), row.split(","), strict=True))
    cells |= {"weft_density_per_mm": "0.35", "weft_width_mm": "2.4", "weft_crimp": "0.004"}
    (tmp_path / "pattern.csv").write_text(f"{header}\n{','.join(cells.values())}\n")
    assert read_family("pattern.csv")["mine"].weaves[0].pattern == TWILL22


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
