"""A study's rows and figures: the same as the reader, the identification and the report have of single rows."""

import json
from dataclasses import replace

import numpy as np
import pytest
from fabrics import UNBALANCED, random_general_row, random_row, skin_of, table
from hypothesis import given, settings
from hypothesis import strategies as some
from scipy.integrate import quad

from fabric_cad.cell.pipeline import Stages, checked_report, make_step
from fabric_cad.measured.relations import out_of_bounds
from fabric_cad.measured.tables import FLOAT_GAPS
from fabric_cad.model.identification import identify, identify_rows
from fabric_cad.study.design import DESIGNS, Samples
from fabric_cad.study.factors import Values
from fabric_cad.study.figures import flat
from fabric_cad.study.rows import base_value, study_rows
from fabric_cad.study.store import unit_key
from fabric_cad.study.table_figures import identified_figures
from fabric_cad.study.units import Work
from fabric_cad.support.errors import InputError
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.volumes import yarn_volumes

PLAIN = {"name": "base", "weft_density_per_mm": 0.22, "weft_width_mm": 3.2, "weft_crimp": 0.004}
TWILL = PLAIN | {"over": 2, "under": 2}


def sampled(base, **values):
    return study_rows(base, Samples({name: np.array(each) for name, each in values.items()}))


def test_a_unit_is_the_base_row_with_its_factors():
    base = table("plain", PLAIN | {"weft_crimp_std": 0.0004})
    rows, refused = sampled(base, weft_crimp_percent=[0.3, 0.5], weft_width_mm=[3.0, 3.1])
    assert not refused and rows.names == ("base_0", "base_1")
    np.testing.assert_allclose(rows.measured["weft_crimp"], [0.003, 0.005], rtol=1e-15)
    one = table("plain", PLAIN | {"name": "base_1", "weft_width_mm": 3.1, "weft_crimp": 0.5 * 0.01})
    assert identify(rows)["base_1"] == identify(one)["base_1"]
    assert not rows.scattered.any()
    assert base_value(base, "weft_crimp_percent") == pytest.approx(0.4)
    assert (
        base_value(base, "section") == "lenticular" and base_value(base, "float_gap") == "symmetric"
    )


def test_columns_of_texts_may_vary():
    rows, refused = sampled(
        table("twill", TWILL), float_gap=["flat", "symmetric"], section=["lenticular", "lenticular"]
    )
    assert (
        not refused
        and rows.float_gaps == ("flat", "symmetric")
        and rows.sections == ("lenticular", "lenticular")
    )
    flat, symmetric = (identify(rows)[name] for name in rows.names)
    assert (flat.float_gap, symmetric.float_gap) == ("flat", "symmetric")
    assert replace(flat, name="", float_gap="") == replace(symmetric, name="", float_gap="")
    keys = {unit_key(rows[name], Work("cell", {}, 600.0, None), False) for name in rows.names}
    assert len(keys) == 2


def test_weave_columns_may_vary():
    rows, refused = sampled(table("twill", TWILL), over=[1, 3, 3, 200], under=[1, 1, 2, 1])
    assert [(each.over, each.under) for each in rows.weaves[:3]] == [(1, 1), (3, 1), (3, 2)]
    assert {at: str(each.message) for at, each in refused.items()} == {
        3: "200 is not between 1 and 100"
    }
    satin = table("satin", PLAIN | {"harness": 5, "step": 2})
    _, refused = sampled(satin, harness=[5, 6, 8], step=[3, 2, 9])
    assert {at: each.message for at, each in refused.items()} == {
        1: "2 is not coprime to the harness 6",
        2: "9 is not below the harness 8",
    }
    pattern = table("pattern", PLAIN | {"pattern": "ou/uo"})
    rows, refused = sampled(pattern, pattern=["oouu/uuoo", "oo/uo"])
    assert rows.weaves[0].pattern == ("1100", "0011") and list(refused) == [1]


_COLUMNS = (
    "weft_density_per_mm",
    "weft_width_mm",
    "weft_crimp",
    "weft_contact_top_mm",
    "weft_offset_bottom_mm",
)


@settings(deadline=None, max_examples=200)
@given(
    values=some.fixed_dictionaries(
        {name: some.sampled_from([-1.0, 0.0, 0.1, 0.3, 2.0, 3.0, 5.0]) for name in _COLUMNS}
    ),
    section=some.sampled_from(["lenticular", "round", "flat"]),
)
def test_a_row_is_refused_as_the_reader_would(values, section):
    lateral = {"lateral_height_mm": 0.01} if section == "flat" else {}
    row = PLAIN | values | lateral | {"section": section}
    base = table("plain", PLAIN | lateral | ({"section": "flat"} if lateral else {}))
    rows, refused = sampled(
        base, **{name: [each] for name, each in values.items()}, section=[section]
    )
    try:
        table("plain", row)
        told = []
    except InputError as error:
        told = [(each.column, each.message.replace(".0 is", " is")) for each in error.problems]
    assert bool(refused) == bool(told)
    assert {(each.column, each.message) for each in refused.values()} <= set(told)


def test_bad_rows_are_refused_and_the_others_solved_alone():
    rows, refused = sampled(
        table("plain", PLAIN), weft_crimp=[0.004, 5.0, 1e-3], weft_width_mm=[3.2, 3.2, 4.54]
    )
    assert not refused and not out_of_bounds(rows)
    wide = replace(rows, measured=rows.measured | {"weft_thickness_mm": np.full(3, np.nan)})
    bad = replace(wide, measured=wide.measured | {"weft_crimp": np.array([0.004, np.nan, 1e-3])})
    found = identify_rows(bad)
    assert found.rows.tolist() == [0, 2] and list(found.refused) == [1]
    for at, row in enumerate(found.rows.tolist()):
        alone = identify(bad.take([row]))
        assert {name: values[at] for name, values in found.columns.items()} == alone.row(
            bad.names[row]
        )


@pytest.mark.parametrize("float_gap", FLOAT_GAPS)
@pytest.mark.parametrize("seed", range(40))
def test_volumes_are_integrals_of_the_sections(seed, float_gap):
    draw, form = (
        (random_row, {})
        if seed % 2
        else (random_general_row, {"form": ("lenticular", "flat")[seed % 4 // 2]})
    )
    family, row = draw(np.random.default_rng(seed), **form)
    row["float_gap"] = float_gap
    measured = table(family, row)
    found = identify_rows(measured)
    if found.refused:
        pytest.skip("no fabric")
    volumes = yarn_volumes(found.columns, measured.weaves)
    fabric = identify(measured)["random" if seed % 2 else "general"]
    total = {"weft": 0.0, "warp": 0.0}
    for yarn in yarns_of(fabric.weave.interlacement()):
        total[yarn.direction] += volume_of(skin_of(fabric, yarn))
    for direction, exact in total.items():
        assert volumes[direction][0] == pytest.approx(exact, rel=1e-9)


def rates_of(patch, u, v, order_u, order_v):
    """Points of a patch, or derivatives of some orders, on the grid u x v."""
    from scipy.interpolate import BSpline

    (ku, du), (kv, dv) = patch.along, patch.across
    rows = BSpline(ku, patch.poles[..., :3], du)(u, order_u)
    return BSpline(kv, rows.transpose(1, 0, 2), dv)(v, order_v).transpose(1, 0, 2)


def volume_of(surface):
    """Volume under a skin's upper patches less that under the lower ones, by Gauss quadrature over their knot spans."""
    nodes, weights = np.polynomial.legendre.leggauss(6)
    volume = 0.0
    for patch in surface.patches:
        sign = {"top": 1, "bottom": -1}.get(patch.side) or (
            1 if patch.side.endswith("upper") else -1
        )
        if patch.side in ("left", "right"):
            continue  # upright
        (ku, _), (kv, _) = patch.along, patch.across
        for u0, u1 in zip(np.unique(ku), np.unique(ku)[1:]):
            for v0, v1 in zip(np.unique(kv), np.unique(kv)[1:]):
                u, v = (u0 + u1 + (u1 - u0) * nodes) / 2, (v0 + v1 + (v1 - v0) * nodes) / 2
                points, along, across = (
                    rates_of(patch, u, v, *orders) for orders in ((0, 0), (1, 0), (0, 1))
                )
                plan = along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]
                scale = (u1 - u0) * (v1 - v0) / 4
                volume += sign * scale * float(weights @ (points[..., 2] * plan) @ weights)
    return volume


def test_the_quadrature_of_this_test_knows_a_closed_form():
    assert quad(lambda v: 0.18 * (1 - (v / 1.6) ** 2), -1.6, 1.6)[0] == pytest.approx(
        0.18 * 3.2 * 2 / 3
    )


@pytest.mark.parametrize(
    ("family", "row"),
    [
        (
            "plain",
            PLAIN
            | {
                "weft_thickness_mm": 0.37,
                "weft_linear_density_tex": 1870,
                "fibre_density_g_cm3": 2.5,
            },
        ),
        ("pattern", PLAIN | {"pattern": "ou/uo"}),
        (
            "plain",
            UNBALANCED | {"name": "base", "fabric_thickness_mm": 0.75},
        ),
    ],
)
def test_identified_figures_are_those_of_the_report(family, row, tmp_path):
    measured = table(family, row)
    stages = Stages()
    report = flat(checked_report(make_step(measured, tmp_path, stages), None, stages).content())
    figures = identified_figures(measured, identify_rows(measured))
    found = {name: values[0] for name, values in figures.items()}
    assert json.loads(json.dumps(report)) == report
    assert [name for name in report if not name.startswith("consistency.")] == list(found)
    for name, value in found.items():
        assert value == report[name] or value == pytest.approx(report[name], rel=1e-10), name


def test_designs_take_units_from_the_base_row():
    base = table("twill", TWILL)
    samples = DESIGNS["one-at-a-time"](
        {"over": Values((1, 2, 3))}, {"over": base_value(base, "over")}, 0, 0
    )
    rows, refused = study_rows(base, samples)
    assert [each.over for each in rows.weaves] == [2, 1, 3] and not refused
