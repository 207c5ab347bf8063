"""Scatter of measurements: first order against sampling, closed forms, bounds, and how it is given and told."""

import csv
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from fabrics import TWILL32, UNBALANCED, random_row, table
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import fabric_cad
from fabric_cad.cli import main
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import MEASURED, read_families
from fabric_cad.model.closing import CLOSING
from fabric_cad.model.identification import identify
from fabric_cad.model.lengths import _excess_derivative
from fabric_cad.model.scatter import doubts, propagate
from fabric_cad.model.validation import plus_minus
from fabric_cad.support.errors import InputError

seeds = st.integers(0, 2**32 - 1)
SAMPLES = 8000
BALANCED = {"name": "x", "weft_density_per_mm": 0.22, "weft_width_mm": 3.2}
FLAT = UNBALANCED | {"section": "flat", "lateral_height_mm": 0.03, "weft_thickness_mm": 0.33}


def measurements(row: dict) -> list[str]:
    return [column for column in row if column in MEASURED]


def with_scatter(row: dict, share: float) -> dict:
    """The row with a standard deviation of that share of every measured value."""
    return row | {f"{column}_std": share * row[column] for column in measurements(row)}


def spread_of(family: str, row: dict) -> tuple[dict, dict]:
    """(mean, std) by column of a table of one row."""
    spread = propagate(table(family, row))
    return {c: float(v[0]) for c, v in spread.mean.items()}, spread.row(0)


@pytest.mark.parametrize(
    ("family", "row"),
    [
        ("twill", TWILL32),
        ("plain", BALANCED | {"fabric_thickness_mm": 0.7}),
        ("plain", UNBALANCED | {"weft_thickness_mm": 0.33}),
        ("plain", FLAT),
        ("plain", UNBALANCED | {"fabric_thickness_mm": 0.8, "thicker": "weft"}),
        ("plain", UNBALANCED | {"fabric_thickness_mm": 0.8, "thicker": "warp"}),
        (
            "plain",
            {k: v for k, v in UNBALANCED.items() if k != "warp_crimp"}
            | dict.fromkeys(CLOSING[2:4], 0.36),
        ),
        (
            "satin",
            {"name": "s", "harness": 8, "step": 3, "weft_density_per_mm": 0.8, "weft_width_mm": 1.0}
            | {"warp_density_per_mm": 0.7, "warp_width_mm": 1.2}
            | {"weft_crimp": 0.003, "warp_thickness_mm": 0.17, "fabric_thickness_mm": 0.4},
        ),
    ],
)
def test_first_order_agrees_with_sampling(family, row):
    """8000 samples, scatter 0.4 %: their standard deviations are known to 0.8 %, agreement asked to 4 %."""
    rng = np.random.default_rng(2005)
    scattered = with_scatter(row, 0.004)
    drawn = {c: rng.normal(row[c], scattered[f"{c}_std"], SAMPLES) for c in measurements(row)}
    sampled = identify(
        table(
            family,
            *(
                row | {"name": f"n{k}"} | {c: v[k] for c, v in drawn.items()}
                for k in range(SAMPLES)
            ),
        )
    )
    mean, std = spread_of(family, scattered)
    assert {
        "weft_slope",
        "warp_amplitude_mm",
        "p21",
        "M15_z_mm",
        "fabric_thickness_mm",
        "weft_low_edge_q",
    } <= set(std)
    for column, expected in std.items():
        found = np.array(sampled.columns[column])
        assert np.std(found) == pytest.approx(expected, rel=0.04, abs=1e-12), column
        assert np.mean(found) == pytest.approx(mean[column], abs=0.1 * expected + 1e-12), column


def test_fabric_thickness_scatters_twice_as_the_yarns_of_a_balanced_fabric():
    _, std = spread_of(
        "plain", BALANCED | {"weft_thickness_mm": 0.36, "weft_thickness_mm_std": 0.015}
    )
    for d in ("weft", "warp"):
        assert (
            std[f"{d}_thickness_mm"] == std[f"{d}_amplitude_mm"] == pytest.approx(0.015, rel=1e-12)
        )
    assert std["fabric_thickness_mm"] == pytest.approx(0.03, rel=1e-12)
    _, std = spread_of(
        "plain", BALANCED | {"fabric_thickness_mm": 0.72, "fabric_thickness_mm_std": 0.03}
    )
    assert std["weft_thickness_mm"] == pytest.approx(0.015, rel=1e-10)


def test_a_crimp_alone_follows_the_length_equation():
    mean, std = spread_of("plain", BALANCED | {"weft_crimp": 0.004, "weft_crimp_std": 0.0003})
    spacing, width = 1 / 0.22, 3.2
    slope = (
        0.0003 * spacing / _excess_derivative(np.array(mean["weft_slope"]), width, spacing - width)
    )  # (A.11)
    assert std["weft_crimp"] == pytest.approx(0.0003, rel=1e-9)
    assert std["weft_slope"] == std["warp_slope"] == pytest.approx(slope, rel=1e-8)
    assert std["weft_amplitude_mm"] == pytest.approx(
        slope * (spacing - width / 2), rel=1e-8
    )  # (A.27)-(A.29)
    assert std["p11"] == pytest.approx(slope / width, rel=1e-8)
    assert std["weft_width_mm"] == std["weft_crossed_spacing_mm"] == std["M15_x_mm"] == 0


def test_independent_measurements_add_as_squares():
    row = UNBALANCED | {"weft_thickness_mm": 0.33}
    scatter = {"weft_crimp_std": 3e-4, "warp_crimp_std": 2e-4, "weft_thickness_mm_std": 0.01}
    _, std = spread_of("plain", row | scatter)
    # A1 + A2 = b1 + b2
    parts = [std["weft_amplitude_mm"], std["warp_amplitude_mm"], std["weft_thickness_mm"]]
    assert std["warp_thickness_mm"] == pytest.approx(np.linalg.norm(parts), rel=1e-9)


@given(seeds, st.floats(1e-4, 0.2))
@settings(max_examples=30, deadline=None)
def test_properties_of_a_propagation(seed, share):
    family, row = random_row(np.random.default_rng(seed))
    scattered = with_scatter(row, share)
    try:
        measured = table(family, scattered)
        solved = identify(measured)
    except InputError:
        assume(False)
    spread = propagate(measured, solved)
    assert all(np.isfinite(values).all() and (values >= 0).all() for values in spread.std.values())
    for column, values in spread.mean.items():
        assert values == solved.columns[column]
    # squares add over the measurements
    squares = dict.fromkeys(spread.std, 0.0)
    for column in measurements(row):
        for name, value in spread_of(family, row | {f"{column}_std": scattered[f"{column}_std"]})[
            1
        ].items():
            squares[name] += value**2
    for name, values in spread.std.items():
        assert values[0] == pytest.approx(np.sqrt(squares[name]), rel=1e-12)
    # what identifies a fabric scatters as it was given
    for column in solved.columns["identified_by"][0].split():
        assert spread.std[column][0] == pytest.approx(scattered[f"{column}_std"], rel=1e-6)
    # in proportion
    twice = propagate(table(family, with_scatter(row, 2 * share)))
    for name, values in spread.std.items():
        assert twice.std[name][0] == pytest.approx(2 * values[0], rel=1e-9)


def test_a_table_is_propagated_as_its_rows_are():
    rows = [
        BALANCED | {"name": "none", "weft_crimp": 0.004},
        with_scatter(BALANCED | {"name": "one", "weft_crimp": 0.005}, 0.01),
        UNBALANCED
        | {
            "name": "two",
            "weft_thickness_mm": 0.33,
            "warp_crimp_std": 1e-4,
            "warp_width_mm_std": 0,
        },
    ]
    whole = propagate(table("plain", *rows))
    for at, row in enumerate(rows):
        assert whole.row(at) == pytest.approx(spread_of("plain", row)[1], nan_ok=True, rel=1e-12)
    assert all(np.isnan(value) for value in whole.row(0).values())
    assert not any(np.isnan(value) for value in [*whole.row(1).values(), *whole.row(2).values()])


def test_no_step_changes_the_solution_taken():
    """Directions alike: both solutions are equally even, and the least change would prefer the other."""
    alike = {"name": "alike"} | {
        f"{d}_{q}": value
        for d in ("weft", "warp")
        for q, value in (("density_per_mm", 0.22), ("width_mm", 3.2), ("crimp", 0.004))
    }
    row = alike | {"fabric_thickness_mm": 0.78} | {"weft_crimp_std": 1e-4, "warp_crimp_std": 1e-4}
    asked = {d: spread_of("plain", row | {"thicker": d})[1] for d in ("weft", "warp")}
    assert spread_of("plain", row)[1] == asked["weft"]
    for d, other in (("weft", "warp"), ("warp", "weft")):
        amplitude = asked[d][f"{d}_amplitude_mm"]
        assert asked[d][f"{d}_thickness_mm"] == pytest.approx(amplitude, rel=1e-6)  # w - A
        assert asked[d][f"{other}_thickness_mm"] == pytest.approx(
            np.sqrt(5) * amplitude, rel=1e-6
        )  # 2 A + A' - w


AT_BOUND = {
    "name": "bound",
    **{
        f"{d}_{q}": v
        for d in ("weft", "warp")
        for q, v in (("density_per_mm", 0.22), ("width_mm", 3.2))
    },
    "weft_thickness_mm": 0.36,
    "warp_thickness_mm": 0.36,
    "fabric_thickness_mm": 0.72,
}


def test_at_a_bound_the_difference_is_one_sided():
    """w = b1 + b2 is the least there is: a smaller w, or a thicker yarn, is no fabric."""
    mean, std = spread_of("plain", AT_BOUND | {"fabric_thickness_mm_std": 0.01})
    assert (
        std["weft_amplitude_mm"] == std["warp_amplitude_mm"] == pytest.approx(0.01, rel=1e-9)
    )  # w - b1, 2 b1 + b2 - w
    mean, std = spread_of("plain", AT_BOUND | {"weft_thickness_mm_std": 0.01})
    assert std["warp_amplitude_mm"] == pytest.approx(0.02, rel=1e-9)
    measured = table("plain", AT_BOUND | {"fabric_thickness_mm_std": 0.01})
    (doubt,) = doubts(measured, identify(measured))
    assert str(doubt).split(": ", 1)[1] == (
        "fabric_thickness_mm_std: one standard deviation below the mean is no fabric: "
        "fabric_thickness_mm: 0.71 is below b1 + b2 = 0.72 mm (row bound)"
    )


def test_between_two_bounds_the_row_and_column_are_named():
    """The least w from below, flat sides with a hair of room from above."""
    solved = identify(table("plain", AT_BOUND)).row("bound")
    rise = solved["weft_slope"] * 3.2 / 4
    row = AT_BOUND | {"section": "flat", "lateral_height_mm": (0.36 - rise) * (1 - 1e-8)}
    row |= {"fabric_thickness_mm_std": 0.01}
    with pytest.raises(InputError) as refused:
        propagate(table("plain", row))
    (problem,) = refused.value.problems
    assert (problem.row, problem.column, problem.line) == ("bound", "fabric_thickness_mm_std", 2)
    assert "neither a little more nor a little less than 0.72 is a fabric" in problem.message


def test_doubts():
    def words(row):
        measured = table("plain", row)
        return [problem.message for problem in doubts(measured, identify(measured))]

    assert words(with_scatter(BALANCED | {"weft_crimp": 0.004}, 0.05)) == []
    (message,) = words(BALANCED | {"weft_crimp": 0.004, "weft_crimp_std": 0.005})
    assert message.startswith(
        "one standard deviation below the mean is no fabric: -0.001 is not above 0"
    )
    (message,) = words(BALANCED | {"weft_crimp": 0.004, "weft_width_mm_std": 1.5})
    assert message.endswith("weft_width_mm: 4.7 is not below the weft spacing 4.545 mm")
    # the kink of (15): faces at one height
    half = identify(table("plain", UNBALANCED | {"weft_thickness_mm": 0.33})).row("unbalanced")
    level = half["warp_amplitude_mm"]  # b1 = A2, b2 = A1: both reach A1 + A2
    (message,) = words(UNBALANCED | {"weft_thickness_mm": level, "weft_thickness_mm_std": 0.01})
    assert "other direction reaches the fabric's faces" in message


def test_units_are_those_of_the_value():
    columns = {"weft_density_per_cm": 2.2, "weft_density_per_cm_std": 0.02, "weft_width_mm": 3.2}
    columns |= {"weft_crimp_percent": 0.4, "weft_crimp_percent_std": 0.03}
    measured = table("plain", {"name": "x"} | columns)
    assert measured.scatter["weft_density_per_mm"][0] == pytest.approx(0.002, rel=1e-15)
    assert measured.scatter["weft_crimp"][0] == pytest.approx(0.0003, rel=1e-15)
    assert measured.balanced.all() and measured.scattered.all()
    assert set(measured.scatter) == set(MEASURED)
    inch = {
        "weft_density_per_inch": 5.588,
        "weft_density_per_inch_std": 0.0508,
        "weft_width_mm": 3.2,
    }
    assert table("plain", {"name": "x"} | inch).scatter["weft_density_per_mm"][0] == pytest.approx(
        0.002, rel=1e-12
    )


def test_a_table_of_one_row_keeps_its_scatter():
    rows = [
        BALANCED | {"name": f"r{k}", "weft_crimp": 0.004, "weft_crimp_std": 1e-4 * k}
        for k in range(3)
    ]
    measured = table("plain", *rows)
    assert measured["r2"].scatter["weft_crimp"] == [2e-4]
    assert measured["r2"].names == ("r2",) and measured["r2"].family == "plain"
    assert measured.scattered.tolist() == [True, True, True]  # 0 is a standard deviation too


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        ({"weft_crimp_std": "-0.001"}, "weft_crimp_std: -0.001 is below 0 (row x)"),
        ({"weft_crimp_std": "few"}, "weft_crimp_std: 'few' is not a number (row x)"),
        (
            {"weft_crimp_std": "0.1%"},
            "weft_crimp_std: '0.1%' is not a number; use the column weft_crimp_percent_std (row x)",
        ),
        (
            {"weft_thickness_mm_std": "0.01"},
            "weft_thickness_mm_std: a standard deviation without its value; weft_thickness_mm is empty (row x)",
        ),
        (
            {"warp_density_per_cm_std": "0.01"},
            "warp_density_per_cm_std: a standard deviation without its value; warp_density_per_cm is empty (row x)",
        ),
        (
            {"weft_crimp_std": "0.001", "weft_crimp_percent_std": "0.1"},
            "weft_crimp_percent_std: this quantity is given twice, in two units (row x)",
        ),
    ],
)
def test_wrong_cells(cells, expected):
    with pytest.raises(InputError) as refused:
        table("plain", BALANCED | {"weft_crimp": 0.004} | cells)
    assert [str(problem).split(":2: ")[1] for problem in refused.value.problems] == [expected]


def test_unknown_std_columns_suggest_the_nearest():
    with pytest.raises(InputError, match="did you mean weft_crimp_std"):
        table("plain", BALANCED | {"weft_crimp": 0.004, "weft_crimp_sd": 0.001})


@pytest.mark.parametrize(
    ("mean", "std", "text"),
    [
        (0.354794, 0.00412, "0.3548 +- 0.0041"),
        (0.354794, 0.00996, "0.3548 +- 0.0100"),
        (12.3, 25.0, "12 +- 25"),
        (0.354794, float("nan"), "0.3548"),
        (2.4, 0.0, "2.4 +- 0"),
    ],
)
def test_plus_minus(mean, std, text):
    assert plus_minus(mean, std) == text


def write(folder, family, *rows):
    folder.mkdir(exist_ok=True)
    with open(folder / f"{family}.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(column for row in rows for column in row)))
        writer.writeheader()
        writer.writerows(rows)


def test_validate_prints_both_tables(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    over = TWILL32 | {"weft_thickness_mm": 0.36, "fabric_thickness_mm": 0.70}
    write(
        tmp_path / "families",
        "twill",
        over,
        over | {"name": "std", "weft_crimp_std": 0.0003, "fabric_thickness_mm_std": 0.02},
        TWILL32 | {"name": "plain_case"},
    )
    assert main(["validate"]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    first, second = printed.out.split("\n\n")
    assert [line.split() for line in first.splitlines()] == [
        ["row", "quantity", "measured", "model", "difference", "%"],
        ["twill32", "weft_thickness_mm", "0.36", "0.3548", "-1.45"],
        ["twill32", "fabric_thickness_mm", "0.7", "0.7096", "+1.37"],
        ["std", "weft_thickness_mm", "0.36", "0.355", "+-", "0.013", "-1.45"],
        ["std", "fabric_thickness_mm", "0.700", "+-", "0.020", "0.710", "+-", "0.027", "+1.37"],
        ["4", "comparisons,", "the", "largest", "difference", "1.45", "%"],
    ]
    lines = second.splitlines()
    assert lines[0].split() == ["row", "identified", "weft", "warp"]
    assert [" ".join(line.split()) for line in lines[1:]] == [
        "std crimp % 0.400 +- 0.030 0.400 +- 0.030",
        "std thickness mm 0.355 +- 0.013 0.355 +- 0.013",
        "std amplitude mm 0.355 +- 0.013 0.355 +- 0.013",
        "std slope 0.2141 +- 0.0081 0.2141 +- 0.0081",
        "std fabric thickness mm 0.710 +- 0.027",
    ]
    assert main(["validate", "-q"]) == 0
    assert capsys.readouterr() == printed


def test_validate_with_nothing_to_say(tmp_path, capsys):
    write(tmp_path / "f", "twill", TWILL32)
    assert main(["validate", "--families", str(tmp_path / "f")]) == 0
    assert capsys.readouterr().out == (
        "no row measures more than what identifies it: nothing to compare with the model\n\n"
        "no row gives a standard deviation (columns *_std): none to propagate\n"
    )


def test_validate_tells_of_wrong_tables_and_shows_the_others(tmp_path, capsys):
    folder = tmp_path / "f"
    write(folder, "twill", TWILL32 | {"fabric_thickness_mm": 0.7})
    write(folder, "plain", BALANCED | {"weft_crimp": 0.004, "weft_thickness_mm_std": 0.01})
    assert main(["validate", "--families", str(folder)]) == 2
    printed = capsys.readouterr()
    assert "twill32  fabric_thickness_mm" in printed.out
    assert printed.err.endswith("plain.csv:2: weft_thickness_mm_std: a standard deviation without its value; "
                                "weft_thickness_mm is empty (row x)\n")  # fmt: skip
    assert main(["validate", "--families", str(tmp_path / "nowhere")]) == 2


def test_shipped_rows_agree_with_the_model():
    """The paper reports differences below 5 % between measured and model thickness (section 6)."""
    tables = read_families(shipped_families()).values()
    solved = [identify(each) for each in tables]
    compared = [values for each in solved for row in each.comparisons for values in row]
    assert compared and all(abs(model / measured - 1) < 0.05 for _, measured, model in compared)
    assert any(each.scattered.any() for each in tables)
    # these yarns scatter by more than the gap between them
    doubted = [
        (problem.row, problem.column)
        for each, one in zip(tables, solved)
        for problem in doubts(each, one)
    ]
    assert doubted == [
        ("twintex_tpeet44", "weft_width_mm_std"),
        ("twintex_tpecu53", "warp_width_mm_std"),
    ]


def test_validation_loads_no_more_than_it_needs():
    code = "import sys; from fabric_cad.cli import main; main(['validate', '-q', '--families', sys.argv[1]])"
    code += "; print([name for name in ('cadquery', 'OCP', 'gmsh', 'scipy', 'pyvista') if name in sys.modules])"
    command = [sys.executable, "-c", code, str(shipped_families())]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(fabric_cad.__file__).parents[1],
    )
    assert done.stdout.splitlines()[-1] == "[]"


def test_the_report_holds_standard_deviations(tmp_path):
    from fabric_cad.cell.pipeline import make_cell

    row = TWILL32 | {"weft_crimp_std": 0.0003, "weft_width_mm_std": 0.02}
    found = make_cell(table("twill", row), tmp_path, {"size": 0.6})["identified"]
    _, std = spread_of("twill", row)
    for d in ("weft", "warp"):
        assert set(found[d]["std"]) == set(found[d]) - {"std"}
        for key in ("slope", "amplitude_mm", "thickness_mm", "crimp", "width_mm"):
            assert found[d]["std"][key] == std[f"{d}_{key}"] > 0
    assert found["weft"]["std"]["control_points"]["M13"] == [std["M13_x_mm"], std["M13_z_mm"]]
    assert found["warp"]["std"]["p_low"] == std["p22"]
    assert found["fabric_thickness_std_mm"] == std["fabric_thickness_mm"]
    assert (
        "std"
        not in make_cell(table("twill", TWILL32), tmp_path, {"size": 0.6})["identified"]["weft"]
    )
