"""Identification: the relations of the paper, every sufficient subset, whole tables at once."""

from itertools import combinations

import numpy as np
import pytest
from fabrics import TWILL32, UNBALANCED, random_general_row, random_row, table
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fabric_cad.model.closing import CLOSING
from fabric_cad.model.identification import identify
from fabric_cad.model.lengths import excess_length
from fabric_cad.support.errors import InputError

seeds = st.integers(0, 2**32 - 1)


def identified(seed, draw=random_row):
    """(measured row, solved row, fabric) of a random fabric, or none where it is refused."""
    family, row = draw(np.random.default_rng(seed))
    measured = table(family, row)
    try:
        solved = identify(measured)
    except InputError:
        assume(False)
    return row, solved.row(row["name"]), solved[row["name"]]


@pytest.mark.parametrize(
    ("family", "weave", "density", "width", "crimp", "p", "A"),
    [  # model.md, section 3: standard, lenticular, balanced
        ("twill", {"over": 3, "under": 2}, 0.35, 2.4, 0.004, 0.0892082, 0.354794),
        ("plain", {}, 0.22, 3.2, 0.004, 0.0384288, 0.362208),
        ("twill", {"over": 2, "under": 2}, 0.35, 2.4, 0.004, 0.0797235, 0.317072),
        ("satin", {"harness": 8, "step": 3}, 0.80, 1.0, 0.003, 0.2278977, 0.170923),
        ("twill", {"over": 1, "under": 7}, 0.80, 1.0, 0.003, 0.2278977, 0.170923),
    ],
)
def test_published_values(family, weave, density, width, crimp, p, A):
    row = {
        "name": "r",
        **weave,
        "weft_density_per_mm": density,
        "weft_width_mm": width,
        "weft_crimp": crimp,
    }
    fabric = identify(table(family, row))["r"]
    for direction in (fabric.weft, fabric.warp):
        assert direction.p_low == direction.p_high == pytest.approx(p, abs=6e-8)
        assert direction.amplitude == direction.thickness == pytest.approx(A, abs=6e-7)
    assert fabric.fabric_thickness == pytest.approx(2 * A, abs=1.2e-6)


@given(seeds)
@settings(max_examples=60, deadline=None)
def test_the_relations_of_the_paper_hold(seed):
    _, row, fabric = identified(seed)
    weft, warp = fabric.weft, fabric.warp
    assert weft.amplitude + warp.amplitude == pytest.approx(
        weft.thickness + warp.thickness, rel=1e-12
    )
    # (15)
    outer = max(weft.thickness + weft.amplitude, warp.thickness + warp.amplitude)
    assert fabric.fabric_thickness == pytest.approx(outer, rel=1e-12)
    for d, other in ((weft, warp), (warp, weft)):
        gap = d.crossed_spacing - other.width
        # (11), (12), (A.25), (A.26)
        assert d.slope == pytest.approx(d.p_low * other.width, rel=1e-12)
        # (A.27)-(A.29)
        assert d.amplitude == pytest.approx(d.slope * (other.width / 2 + gap), rel=1e-12)
        # (A.11), (A.12)
        projected = fabric.weave.wefts / 2 * d.crossed_spacing
        assert excess_length(d.slope, other.width, gap) == pytest.approx(
            d.crimp * projected, rel=1e-11
        )


@pytest.mark.parametrize("draw", [random_row, random_general_row])
@given(seed=seeds)
@settings(max_examples=40, deadline=None)
def test_control_points_lie_on_the_conics(draw, seed):
    _, row, fabric = identified(seed, draw)
    for d, (first, second) in ((fabric.weft, ("p11", "p12")), (fabric.warp, ("p21", "p22"))):
        (x1, z1), (x2, z2), (x3, z3), (x4, z4), (x5, z5), (x6, z6) = d.points
        p1, p2 = row[first], row[second]
        assert z1 == z2 and z5 == z6 and x1 == 0
        assert z3 == pytest.approx(z2 + p1 * (x3 - x2) ** 2, abs=1e-12)  # (1)
        assert z4 == pytest.approx(
            z5 - p2 * (x4 - x5) ** 2, abs=1e-12
        )  # (2), its sign as in (A.29)
        slope = (z4 - z3) / (x4 - x3)
        assert 2 * p1 * (x3 - x2) == pytest.approx(slope, rel=1e-9)  # (11)
        assert 2 * p2 * (x5 - x4) == pytest.approx(slope, rel=1e-9)  # (12)
        assert x6 == pytest.approx(fabric.weave.wefts / 2 * d.crossed_spacing)  # (A.1), (A.2)
    # where the warp is on top the midlines are (b1 + b2)/2 apart, and where the weft is: (13), (14)
    apart = (fabric.weft.thickness + fabric.warp.thickness) / 2
    assert fabric.warp.z_high - fabric.weft.z_low == pytest.approx(apart, rel=1e-12)
    assert fabric.weft.z_high - fabric.warp.z_low == pytest.approx(apart, rel=1e-12)
    assert row["p21"] < 0 < row["p11"]


def _shared(fabric) -> dict:
    return {
        "weft_crimp": fabric.weft.crimp,
        "warp_crimp": fabric.warp.crimp,
        "weft_thickness_mm": fabric.weft.thickness,
        "warp_thickness_mm": fabric.warp.thickness,
        "fabric_thickness_mm": fabric.fabric_thickness,
    }


def _outer(fabric) -> str:
    """Which system reaches the fabric's faces."""
    weft, warp = fabric.weft, fabric.warp
    return "weft" if weft.thickness + weft.amplitude >= warp.thickness + warp.amplitude else "warp"


@given(seeds, st.sampled_from(list(combinations(CLOSING, 3))))
@settings(max_examples=150, deadline=None)
def test_every_three_of_the_five_quantities_give_the_same_fabric(seed, given_columns):
    row, solved, fabric = identified(seed)
    if not any(column.startswith("warp_") for column in row):
        row |= {f"warp_{q}": row[f"weft_{q}"] for q in ("density_per_mm", "width_mm")}
    full = _shared(fabric)
    again = {column: value for column, value in row.items() if column not in CLOSING}
    again |= {column: full[column] for column in given_columns} | {"thicker": _outer(fabric)}
    outer = {
        d: fabric.directions[d].thickness + fabric.directions[d].amplitude for d in ("weft", "warp")
    }
    # at equal outer faces a set with the fabric thickness may be a hair outside what the others allow
    assume(abs(outer["weft"] - outer["warp"]) > 1e-6 * fabric.fabric_thickness)
    alone = {
        "weft": {"weft_crimp", "weft_thickness_mm"},
        "warp": {"warp_crimp", "warp_thickness_mm"},
    }
    if set(given_columns) == alone[_outer(fabric)] | {"fabric_thickness_mm"}:
        with pytest.raises(InputError, match="of the same direction again|is below"):
            identify(table(solved["family"], again))
        return
    found = identify(table(solved["family"], again))[row["name"]]
    for column, value in _shared(found).items():
        assert value == pytest.approx(full[column], rel=1e-5), (column, given_columns)


@given(st.lists(seeds, min_size=1, max_size=8))
@settings(max_examples=20, deadline=None)
def test_a_table_is_solved_as_its_rows_are(some):
    rows = []
    for number, seed in enumerate(some):
        rng = np.random.default_rng(seed)
        rows.append(random_row(rng, f"r{number}"))
    rows = [row for family, row in rows if family == rows[0][0]] or rows[:1]
    family = next(f for f, _ in [random_row(np.random.default_rng(some[0]))])
    single, good = {}, []
    for row in rows:
        try:
            single[row["name"]] = identify(table(family, row)).row(row["name"])
            good.append(row)
        except InputError:
            pass
    assume(good)
    whole = identify(table(family, *good))
    for name, expected in single.items():
        assert whole.row(name) == expected


def test_fabric_thickness_alone_leaves_two_solutions():
    base = UNBALANCED | {"fabric_thickness_mm": 0.75}
    solved = {
        asked: identify(table("plain", base | {"thicker": asked} if asked else base)).row(
            "unbalanced"
        )
        for asked in ("weft", "warp", "")
    }
    for asked, other in (("weft", "warp"), ("warp", "weft")):
        row = solved[asked]
        assert row[f"{asked}_thickness_mm"] + row[f"{asked}_amplitude_mm"] == pytest.approx(0.75)
        for d in ("weft", "warp"):  # each names the other
            assert row[f"other_{d}_thickness_mm"] == pytest.approx(
                solved[other][f"{d}_thickness_mm"]
            )
    even = min(
        ("weft", "warp"),
        key=lambda d: abs(solved[d]["weft_thickness_mm"] - solved[d]["warp_thickness_mm"]),
    )
    assert solved[""]["weft_thickness_mm"] == solved[even]["weft_thickness_mm"]


def test_one_solution_names_no_other():
    row = identify(table("plain", UNBALANCED | {"weft_thickness_mm": 0.35})).row("unbalanced")
    assert row["other_weft_thickness_mm"] == ""


def test_what_is_measured_beyond_is_compared():
    row = TWILL32 | {"weft_thickness_mm": 0.36, "fabric_thickness_mm": 0.70}
    solved = identify(table("twill", row))
    compared = {quantity: (measured, model) for quantity, measured, model in solved.comparisons[0]}
    assert compared == {
        "weft_thickness_mm": (0.36, pytest.approx(0.354794, abs=1e-6)),
        "fabric_thickness_mm": (0.70, pytest.approx(0.709587, abs=1e-6)),
    }


@pytest.mark.parametrize(
    ("change", "column", "words"),
    [
        ({"weft_crimp": ""}, "weft_crimp", "a balanced fabric needs one of the three"),
        (
            UNBALANCED,
            "weft_thickness_mm",
            "fill 1 more of weft_thickness_mm, warp_thickness_mm, fabric_thickness_mm",
        ),
        (UNBALANCED | {"warp_crimp": ""}, "warp_crimp", "fill 2 more"),
        (
            UNBALANCED | {"fabric_thickness_mm": 0.6},
            "fabric_thickness_mm",
            "0.6 is below A1 + A2 = 0.718",
        ),
        (
            UNBALANCED | {"weft_thickness_mm": 0.05},
            "warp_crimp",
            "the contact rise at the weft's edges",
        ),
        (
            UNBALANCED | {"weft_thickness_mm": 0.9},
            "weft_thickness_mm",
            "leaves the warp a thickness of",
        ),
        (
            {"section": "flat", "lateral_height_mm": 0.3},
            "lateral_height_mm",
            "0.3 is not below the 0.2",
        ),
    ],
)
def test_what_is_no_fabric_is_refused_with_the_number_that_makes_it_so(change, column, words):
    base = {"name": "x", "weft_density_per_mm": 0.25, "weft_width_mm": 2.8, "weft_crimp": 0.004}
    with pytest.raises(InputError) as refused:
        identify(table("plain", base | change))
    (problem,) = refused.value.problems
    assert problem.column == column and words in problem.message and problem.line == 2


def test_all_refusals_of_a_table_are_listed():
    rows = [
        UNBALANCED | {"name": f"r{k}", "fabric_thickness_mm": w}
        for k, w in enumerate((0.5, 0.8, 0.6))
    ]
    with pytest.raises(InputError) as refused:
        identify(table("plain", *rows))
    assert [problem.row for problem in refused.value.problems] == ["r0", "r2"]


@given(seeds)
@settings(max_examples=60, deadline=None)
def test_the_general_trajectory(seed):
    """(A.1)-(A.12), (A.25)-(A.29) with chords and offsets of their own on top and bottom."""
    given_row, _, fabric = identified(seed, random_general_row)
    balanced = not any(column.startswith("warp_") for column in given_row)
    for name, other in (("weft", "warp"), ("warp", "weft")):
        source = "weft" if balanced else other
        width = given_row[f"{source}_width_mm"]
        chord = {
            side: given_row.get(f"{source}_contact_{side}_mm", width) for side in ("top", "bottom")
        }
        offset = {
            side: given_row.get(f"{source}_offset_{side}_mm", 0.0) for side in ("top", "bottom")
        }
        d = fabric.directions[name]
        a, (low, high) = d.crossed_spacing, fabric.weave.floats(name)
        # the weft starts low, under the bottom of its warps; the warp high, on the top of its wefts
        first, second = ("bottom", "top") if name == "weft" else ("top", "bottom")
        start = low if name == "weft" else high
        x1, x2, x3, x4, x5, x6 = (x for x, _ in d.points)
        assert x2 == pytest.approx((start - 1) / 2 * a + offset[first])  # (A.9), (A.10)
        assert x3 == pytest.approx((start - 1) / 2 * a + chord[first] / 2)  # (A.5), (A.6)
        assert x4 == pytest.approx((start + 1) / 2 * a - chord[second] / 2)  # (A.7), (A.8)
        assert x5 == pytest.approx((start + 1) / 2 * a - offset[second])  # (A.3), (A.4)
        u_first, u_second, gap = x3 - x2, x5 - x4, x4 - x3
        p_first, p_second = (d.p_low, d.p_high) if name == "weft" else (d.p_high, d.p_low)
        assert p_second == pytest.approx(p_first * u_first / u_second)  # (A.25), (A.26)
        assert d.slope == pytest.approx(2 * p_first * u_first)
        assert d.amplitude == pytest.approx(
            d.slope * (u_first / 2 + gap + u_second / 2)
        )  # (A.27)-(A.29)
        excess = excess_length(d.slope, u_first + u_second, gap)
        assert excess == pytest.approx(d.crimp * (low + high) / 2 * a, rel=1e-9)  # (A.11), (A.12)


@pytest.mark.parametrize(
    ("cells", "parameters"),
    [
        ({}, 3),
        ({"weft_contact_top_mm": 2.3}, 4),
        ({"weft_contact_top_mm": 2.3, "weft_offset_top_mm": 0.1}, 6),
        ({"weft_contact_top_mm": 2.3, "weft_contact_bottom_mm": 2.3, "section": "round"}, 9),
    ],
)
def test_number_of_parameters(cells, parameters):
    assert identify(table("twill", TWILL32 | cells)).row("twill32")["parameters"] == parameters
    warp = {
        "warp_density_per_mm": 0.35,
        "warp_width_mm": 2.4,
        "warp_crimp": 0.004,
        "weft_thickness_mm": 0.36,
    }
    warp |= {column.replace("weft", "warp"): value for column, value in cells.items()}
    both = identify(table("twill", TWILL32 | cells | warp)).row("twill32")
    assert both["parameters"] == {3: 7, 4: 8, 6: 12, 9: 18}[parameters]


@pytest.mark.parametrize(
    ("cells", "column", "words"),
    [
        ({"weft_contact_top_mm": 2.5}, "weft_contact_top_mm", "2.5 is above the weft width 2.4 mm"),
        (
            {"weft_offset_top_mm": 1.3},
            "weft_offset_top_mm",
            "1.3 is not below half the contact chord, 1.2 mm",
        ),
        (
            {"section": "round"},
            "weft_contact_top_mm",
            "needs a contact chord below its width 2.4 mm",
        ),
        (
            {"section": "round", "weft_contact_top_mm": 2.0, "weft_contact_bottom_mm": 2.35},
            "weft_contact_top_mm",
            "a chord of 2 mm leaves arcs",
        ),
    ],
)
def test_contacts_that_do_not_fit_are_refused(cells, column, words):
    with pytest.raises(InputError) as refused:
        identify(table("twill", TWILL32 | cells))
    problem = refused.value.problems[0]
    assert problem.column == column and words in problem.message
