"""Weaves given by a pattern: how a cell is read, what is refused, and that the model's relations hold."""

import numpy as np
import pytest
from fabrics import TWILL32, skin_of, table
from hypothesis import assume, given
from hypothesis import strategies as st

from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import MOST_YARNS, read_families, read_family
from fabric_cad.model.identification import identify
from fabric_cad.model.lengths import excess_length
from fabric_cad.model.solved import read_solved
from fabric_cad.support.errors import InputError
from fabric_cad.weave.faults import pattern_faults
from fabric_cad.weave.patterns import read_pattern, written
from fabric_cad.weave.weaves import FAMILIES, Weave, yarns_of

HEADER = "name,pattern,weft_density_per_mm,weft_width_mm,weft_crimp"
ROW = {key: TWILL32[key] for key in ("weft_density_per_mm", "weft_width_mm", "weft_crimp")}
BASKET = ("1100", "1100", "0011", "0011")


def problems(folder, *cells):
    path = folder / "pattern.csv"
    lines = [HEADER, *(f"r{k},{cell},0.35,2.4,0.004" for k, cell in enumerate(cells))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    with pytest.raises(InputError) as refused:
        read_family(path)
    return [str(problem).replace(str(folder) + "/", "") for problem in refused.value.problems]


@pytest.mark.parametrize(
    "cell",
    [
        "1100 1100 0011 0011",
        "1100/1100/0011/0011",
        "1100 | 1100 | 0011 | 0011",
        "oouu/oouu/uuoo/uuoo",
        "OOUU OOUU  UUOO UUOO ",
        '"1100\n1100\n0011\n0011"',
        '"oouu\r\noouu\r\nuuoo\r\nuuoo"',
    ],
)
def test_every_way_of_writing_reads_the_same(tmp_path, cell):
    path = tmp_path / "pattern.csv"
    path.write_bytes(f"{HEADER}\nr,{cell},0.35,2.4,0.004\nnext,ou/uo,0.35,2.4,0.004\n".encode())
    basket, plain = read_family(path).weaves
    assert basket == Weave(pattern=BASKET) and plain == Weave(pattern=("10", "01"))


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ("", "this cell is empty"),
        ("/", "this cell is empty"),
        ("110", "'110' is one weft only; part the wefts by a space, / or |"),
        ("110/111/001", "weft 2 passes over every yarn and never interlaces"),
        ("100/010", "warp 3 passes over every yarn and never interlaces"),
        ("oouu/oouu/uuoo/uuo", "weft 4 has 3 marks where weft 1 has 4"),
        (
            "1100 110 11",
            "weft 2 has 3 marks where weft 1 has 4; "
            "a spreadsheet drops the zeros a number starts with: write o and u for 1 and 0",
        ),
        ("1O0/001", "'1O0/001' has digits and letters; write 1 and 0, or o and u"),
        (
            "10-Jan",
            "'10-Jan' has - a j n in it; a pattern is of 1 and 0, or of o and u, for a weft over and under a warp "
            "(a spreadsheet makes a date of 10/01, but not of ou/uo)",
        ),
        (
            "/".join(["10", "01"] * 51),
            f"102 wefts x 2 warps are more than {MOST_YARNS} in a direction",
        ),
    ],
)
def test_what_is_no_pattern_is_told(tmp_path, cell, expected):
    assert problems(tmp_path, "10/01", cell)[0] == f"pattern.csv:3: pattern: {expected} (row r1)"


def test_everything_wrong_with_patterns_is_listed(tmp_path):
    assert problems(tmp_path, "111/000/101", "10", "10/01") == [
        "pattern.csv:2: pattern: weft 1 passes over every yarn and never interlaces (row r0)",
        "pattern.csv:2: pattern: weft 2 passes under every yarn and never interlaces (row r0)",
        "pattern.csv:3: pattern: '10' is one weft only; part the wefts by a space, / or | (row r1)",
    ]


def test_a_fabric_in_two_layers_is_refused():
    """Two plain weaves one above the other: every yarn interlaces, and nothing ties them together."""
    wefts, warps = np.ogrid[:4, :4]
    same = (wefts + warps) % 2 == 0
    over = np.where(same, (wefts // 2 + warps // 2) % 2, wefts % 2 == 0)
    pattern = tuple("".join(map(str, row)) for row in over.tolist())
    (fault,) = pattern_faults(pattern)
    assert fault.startswith(
        "weft 1, 3 and warp 1, 3 lie over all other yarns: the weave falls into separate layers"
    )
    with pytest.raises(ValueError, match="separate layers"):
        Weave(pattern=pattern)
    tied = ("0" if pattern[0][1] == "1" else "1").join((pattern[0][:1], pattern[0][2:]))
    assert pattern_faults((tied, *pattern[1:])) == ()


def test_a_twill_spelt_as_a_pattern_is_the_twill():
    weave = Weave(3, 2)
    spelt = written("".join(str(int(over)) for over in row) for row in weave.interlacement())
    assert spelt == "ooouu/uooou/uuooo/ouuoo/oouuo"
    twill = identify(table("twill", TWILL32))
    pattern = identify(table("pattern", {"name": "twill32", "pattern": spelt} | ROW))
    told = {"family", "over", "under", "step", "pattern"}
    one, other = (solved.row("twill32") for solved in (twill, pattern))
    assert {k: v for k, v in one.items() if k not in told} == {
        k: v for k, v in other.items() if k not in told
    }
    one, other = twill["twill32"], pattern["twill32"]
    assert (one.weft, one.warp, one.period) == (other.weft, other.warp, other.period)
    yarns = [yarns_of(fabric.weave.interlacement()) for fabric in (one, other)]
    assert yarns[0] == yarns[1]
    for yarn in yarns[0]:
        first, second = (skin_of(fabric, yarn) for fabric in (one, other))
        assert all(
            np.array_equal(a.poles, b.poles)
            for a, b in zip(first.patches, second.patches, strict=True)
        )


@st.composite
def patterns(draw):
    """Random interlacements of 2 to 7 wefts and warps in which every yarn interlaces."""
    wefts, warps = draw(st.integers(2, 7)), draw(st.integers(2, 7))
    row = st.integers(1, 2**warps - 2).map(
        lambda number: f"{number:0{warps}b}"
    )  # a weft that interlaces
    pattern = tuple(draw(st.lists(row, min_size=wefts, max_size=wefts)))
    assume(not pattern_faults(pattern))
    return pattern


@given(patterns())
def test_a_written_pattern_reads_back(pattern):
    assert read_pattern(written(pattern)) == pattern


@given(
    patterns(), st.floats(0.0005, 0.02), st.floats(0.0005, 0.02) | st.none(), st.floats(0.7, 1.4)
)
def test_yarns_have_their_crimp_on_average(pattern, weft_crimp, warp_crimp, ratio):
    """model: T transitions' excess length = e N a, N the yarns crossed in the cell, averaged over the yarns."""
    row = ROW | {"name": "r", "pattern": written(pattern), "weft_crimp": weft_crimp}
    if warp_crimp is not None:
        row |= {
            "warp_density_per_mm": 0.35 * ratio,
            "warp_width_mm": 2.4 / ratio,
            "warp_crimp": warp_crimp,
            "weft_thickness_mm": 0.3,
        }
    try:
        fabric = identify(table("pattern", row))["r"]
    except InputError:
        assume(False)
    yarns = yarns_of(fabric.weave.interlacement())
    for name, crimp in (("weft", weft_crimp), ("warp", warp_crimp)):
        direction, other = fabric.directions[name], fabric.crossed(name)
        excess = excess_length(
            direction.slope, other.width, direction.crossed_spacing - other.width
        )
        transitions = [
            sum(a != b for a, b in zip(yarn.high, yarn.high[1:] + yarn.high[:1]))
            for yarn in yarns
            if yarn.direction == name
        ]
        length = fabric.weave.crossed_by(name) * direction.crossed_spacing
        assert np.mean(transitions) * excess == pytest.approx(direction.crimp * length, rel=1e-9)
        assert crimp is None or direction.crimp == crimp
    if warp_crimp is None:  # balanced: yarns of one shape
        assert (
            fabric.weft.slope == fabric.warp.slope
            and fabric.weft.amplitude == fabric.warp.thickness
        )


def test_the_solved_table_keeps_the_pattern(tmp_path):
    solved = identify(table("pattern", {"name": "r", "pattern": written(BASKET)} | ROW))
    solved.write(tmp_path / "solved.csv")
    fabric = read_solved(tmp_path / "solved.csv")
    assert fabric.weave == Weave(pattern=BASKET) and fabric == solved["r"]


def test_the_report_tells_the_pattern(tmp_path):
    from fabric_cad.cell.pipeline import make_cell
    from fabric_cad.cell.summary import summary

    row = table("pattern", {"name": "rib", "pattern": "110/001"} | ROW)
    report = make_cell(row, tmp_path, {"size": 1.0})
    assert report["weave"] == {
        "over": None,
        "under": None,
        "step": None,
        "wefts": 2,
        "warps": 3,
        "pattern": ["110", "001"],
    }
    assert summary(report).startswith(
        "rib: pattern 2 wefts x 3 warps, lenticular sections, 3 parameters\n"
    )


def test_every_family_has_rows_and_a_master():
    from importlib import import_module

    tables = read_families(shipped_families())
    assert tuple(tables) == FAMILIES and all(len(rows) for rows in tables.values())
    for family in FAMILIES:
        assert callable(import_module(f"fabric_cad.masters.{family}").cell)
