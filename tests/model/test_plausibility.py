"""What is seldom true of a fabric gets a warning, what no yarn can do is refused, whole tables at once."""

import json
from dataclasses import fields
from math import atan, cos, pi, sqrt
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fabrics import TWILL32, UNBALANCED, table

from fabric_cad.cell.checks import check_report, doubts
from fabric_cad.cell.figures import MeshFigures, Volumes
from fabric_cad.cell.report import CellReport
from fabric_cad.cli import main
from fabric_cad.model.identification import identify, identify_rows
from fabric_cad.model.plausibility import (
    DENSEST,
    LARGEST_SLOPE,
    LEAST_JACOBIAN,
    LOW_JACOBIAN,
    SLACKEST,
    implausible,
)
from fabric_cad.support.errors import BuildError, InputError

HEADER = "name,over,under,weft_density_per_mm,weft_width_mm,weft_crimp,weft_thickness_mm"


UNCRIMPED = {column: value for column, value in TWILL32.items() if column != "weft_crimp"}
SATIN8 = {
    "name": "satin8",
    "harness": 8,
    "step": 3,
    "weft_density_per_mm": 0.8,
    "weft_width_mm": 1.0,
}


def warnings_of(family, *rows):
    measured = table(family, *rows)
    return implausible(measured, identify(measured).columns)


def test_the_bound_is_where_the_slackest_yarn_is_packed_solid():
    assert DENSEST == pytest.approx(pi / (2 * sqrt(3)))
    assert SLACKEST / cos(atan(LARGEST_SLOPE)) == pytest.approx(DENSEST)
    assert LARGEST_SLOPE == pytest.approx(2.853, abs=1e-3)


def test_a_slope_just_above_the_bound_is_refused_and_just_below_is_warned_of():
    crimps = np.linspace(0.3, 0.6, 61)
    measured = table(
        "twill", *(TWILL32 | {"name": f"r{k}", "weft_crimp": c} for k, c in enumerate(crimps))
    )
    found = identify_rows(measured)
    slopes = np.asarray(found.columns["weft_slope"])
    assert 0 < len(found.refused) < len(crimps) and slopes.max() <= LARGEST_SLOPE
    assert min(found.refused) == max(found.rows) + 1  # steeper with every crimp
    assert {problem.column for problem in found.refused.values()} == {"weft_crimp"}
    told = implausible(measured.take(found.rows.tolist()), found.columns)
    assert [problem.row for problem in told] == [f"r{k}" for k in found.rows]


@pytest.mark.parametrize(
    ("family", "row", "columns"),
    [
        ("twill", TWILL32, []),
        (
            "twill",
            TWILL32 | {"weft_crimp": 0.2},
            ["weft_crimp"],
        ),  # a balanced row is warned of once
        ("plain", UNBALANCED | {"warp_crimp": 0.15, "fabric_thickness_mm": 4.0}, ["warp_crimp"]),
        ("twill", UNCRIMPED | {"weft_thickness_mm": 2.0}, ["weft_thickness_mm"]),
        (
            "satin",
            SATIN8 | {"weft_crimp": 0.06},
            ["weft_crimp"],
        ),  # in eight spacings that is a slope above 1
    ],
)
def test_a_warning_names_the_column_that_caused_it(family, row, columns):
    told = warnings_of(family, row)
    assert [problem.column for problem in told] == columns
    for problem in told:
        assert problem.line == 2 and problem.row == row["name"] and "slope of" in problem.message
        assert problem.message.endswith(
            f"({'crimp is a ratio'}; {problem.column}_percent takes per cent)"
        ) == ("crimp" in problem.column)


def test_the_column_of_a_refusal_is_the_one_that_gave_the_slope():
    with pytest.raises(InputError) as refused:
        identify(table("plain", UNBALANCED | {"warp_crimp": 30, "weft_thickness_mm": 0.4}))
    (problem,) = refused.value.problems
    assert problem.column == "warp_crimp" and "gives the warp a slope of" in problem.message
    assert "above 2.85, which no yarn has" in problem.message


def test_the_commands_warn_on_standard_error(here, capsys):
    Path("families/twill.csv").write_text(
        f"{HEADER}\nc04,3,2,0.35,2.4,0.4,\nfine,3,2,0.35,2.4,0.004,\n"
    )
    for command in ("list", "solve", "validate"):
        assert main([command, "-q"]) == 0
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) == 1 and lines[0].startswith(
            "warning: families/twill.csv:2: weft_crimp: the weft has a crimp of 40 %"
        )
    Path("families/twill.csv").write_text(f"{HEADER}\nc400,3,2,0.35,2.4,400,\n")
    assert main(["cell", "c400", "-q"]) == 2
    assert capsys.readouterr().err.startswith(
        "families/twill.csv:2: weft_crimp: gives the weft a slope of 1.7"
    )


def test_a_report_and_the_command_say_the_same(here, capsys):
    Path("families/twill.csv").write_text(f"{HEADER}\nsteep,1,1,0.35,2.4,0.12,\n")
    assert main(["cell", "steep", "--size", "1.5", "-q"]) == 0
    printed = capsys.readouterr()
    warnings = json.loads(Path("build/steep/report.json").read_text())["warnings"]
    assert printed.err == "".join(f"warning: {sentence}\n" for sentence in warnings)
    assert any(sentence.startswith("families/twill.csv:2: weft_crimp: ") for sentence in warnings)


def report_of(jacobian, volumes=None):
    """A report of nothing but what is looked at."""
    figures = {field.name: 4 for field in fields(MeshFigures)}
    figures |= {
        "min_scaled_jacobian": jacobian,
        "scaled_jacobian_edges_allow": 0.5,
        "other_elements": 0,
    }
    return CellReport(
        fabric=SimpleNamespace(name="r"),
        identification=None,
        consistency=SimpleNamespace(max_penetration=0.0, max_contact_gap=0.0),
        volumes=volumes or Volumes(1.0, 2.0),
        mesh=MeshFigures(**figures),
        seconds={},
    )


@pytest.mark.parametrize("jacobian", [-0.2, 0.0, LEAST_JACOBIAN, float("nan")])
def test_elements_no_solver_takes_are_not_delivered(jacobian):
    with pytest.raises(
        BuildError,
        match="min_scaled_jacobian is .*, not above 0.0001: the mesh has elements no solver takes",
    ):
        check_report(report_of(jacobian))


def test_low_elements_are_delivered_with_a_warning():
    report = report_of(LOW_JACOBIAN / 2)
    check_report(report)
    (sentence,) = doubts(report)
    assert (
        "smallest scaled Jacobian of the mesh is 0.01, below 0.02" in sentence
        and "(row r)" in sentence
    )
    assert doubts(report_of(LOW_JACOBIAN)) == []


def test_fibres_that_do_not_fit_are_told():
    report = report_of(0.5, Volumes(1.0, 2.0, weft_fibre_fraction=0.95, warp_fibre_fraction=0.6))
    (sentence,) = doubts(report)
    assert sentence.startswith(
        "weft_linear_density_tex: fibres fill 95 % of the yarn's volume, above 91 %"
    )


def test_a_study_has_the_warnings_of_its_units():
    from fabric_cad.study.figures import flat
    from fabric_cad.study.table_figures import identified_figures

    measured = table("twill", TWILL32, TWILL32 | {"name": "steep", "weft_crimp": 0.2})
    found = identify_rows(measured)
    fine, steep = identified_figures(measured, found)["warnings"]
    (problem,) = implausible(measured, identify(measured).columns)
    assert (fine, steep) == (None, str(problem))
    assert "warnings" not in identified_figures(
        measured.take([0]), identify_rows(measured.take([0]))
    )
    assert flat({"warnings": ["a", "b"]}) == {"warnings": "a; b"} and flat({"warnings": []}) == {}
