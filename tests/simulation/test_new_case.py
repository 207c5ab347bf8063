"""A load case that is one class and its registration: all that every case has follows from it."""

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np
import pytest
from jobs import needs_ccx

from fabric_cad.cell.pipeline import find_row
from fabric_cad.cli import main
from fabric_cad.decks.model import Load
from fabric_cad.measured.settings_files import Check
from fabric_cad.simulation.checks import is_from_to, whole
from fabric_cad.simulation.loads import CONDITION, Line, LoadCase, load_cases, register, unregister
from fabric_cad.simulation.settings import read_settings
from fabric_cad.study.names import figure_fault, figure_names
from fabric_cad.study.units import Work, depths, run_unit
from fabric_cad.support.errors import InputError


@dataclass(frozen=True)
class StripCase(LoadCase[float]):
    """Extension along the wefts, by E11, while the cell draws in across by a ratio of it."""

    strain: float
    contraction: float = 0.5
    points: int = 1

    name: ClassVar[str] = "strip"
    text: ClassVar[str] = "stretch a row's cell along its wefts"
    checks: ClassVar[Mapping[str, Check]] = MappingProxyType(
        {
            "strain": (float, is_from_to(0, 0.1), "is not from 0 to 0.1"),
            "contraction": (float, is_from_to(0, 2), "is not from 0 to 2"),
            "points": whole(1, 10),
        }
    )
    is_studied: ClassVar[bool] = True
    headline: ClassVar[tuple[str, ...]] = ("force_N",)

    def paths(self, contact):
        return (tuple(self.strain * step / self.points for step in range(1, self.points + 1)),)

    def load(self, state, lattice):
        change = np.array([[state], [-self.contraction * state]]) * lattice.vectors
        return Load.of(f"strip {state:g}", change)

    def at_rest(self):
        return 0.0

    def lines(self, states):
        return [Line(number, number, {"E11": state}) for number, state in enumerate(states)]

    def measures(self, state, deformed):
        return {
            "force_N": float(deformed.reached.forces[0, 0]),
            "width_mm": float(deformed.vectors[1, 1]),
        }

    def label(self, row):
        return f"strip at {100 * row['E11']:g} %"

    def findings(self, run, table):
        return {"last_force_N": table.rows[-1]["force_N"]}

    def summary(self, report):
        return [f"  strip pulls with {report.findings['last_force_N']:.3f} N"]

    def figure_names(self):
        return ("force_N",)

    def figures(self, findings):
        return {"force_N": findings["last_force_N"]}


@pytest.fixture
def families(here):
    """The families' folder, with the new case among all others and its one needed setting."""
    settings = here / "families" / "simulation.toml"
    settings.write_text("[mesh]\nacross = 4\ncrossing = 4\ngap = 2\n[strip]\nstrain = 0.002\n")
    register(StripCase)
    yield here / "families"
    unregister("strip")


def test_its_table_of_settings_is_read_and_checked(families):
    assert read_settings(families, "plain").case("strip") == StripCase(0.002)

    with open(families / "simulation.toml", "a") as file:
        file.write("[rows.plain.strip]\npoints = 3\n")
    assert read_settings(families, "plain").case("strip") == StripCase(0.002, points=3)

    (families / "simulation.toml").write_text("[strip]\nstrain = 1\nlength = 2\n")
    with pytest.raises(InputError, match=r"1 is not from 0 to 0.1\n.*no such key in \[strip\]"):
        read_settings(families, "plain")

    (families / "simulation.toml").write_text("[stripp]\n")
    with pytest.raises(InputError, match=r"did you mean strip\?"):
        read_settings(families, "plain")

    (families / "simulation.toml").write_text("")
    with pytest.raises(
        InputError, match=r"simulation.toml: strain: this key of \[strip\] is missing"
    ):
        read_settings(families, "plain")


def test_a_name_is_taken_once(families):
    for name in ("strip", "tension", "yarn", "rows"):
        with pytest.raises(ValueError, match=f"cannot be called {name}"):
            register(type("Other", (StripCase,), {"name": name}))
    assert list(load_cases()) == ["tension", "shear", "strip"]


def test_its_command_writes_its_deck(families, capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    assert StripCase.text in " ".join(capsys.readouterr().out.split())

    assert main(["strip", "plain_flat", "--deck", "abaqus"]) == 0
    deck = families.parent / "build" / "plain_flat" / "strip.inp"
    assert capsys.readouterr().out.split() == ["build/plain_flat/strip.inp"]
    text = deck.read_text()
    assert "strip of the elementary cell of plain_flat" in text
    assert text.count("*STEP") == 1 and "strip 0.002" in text and "*DISTRIBUTION TABLE" in text


@needs_ccx
def test_it_runs_through_table_report_series_and_summary(families, capsys):
    assert main(["strip", "plain_flat"]) == 0
    said = capsys.readouterr().out
    folder = families.parent / "build" / "plain_flat"
    with open(folder / "strip.csv", newline="") as file:
        rest, pulled = csv.DictReader(file)
    assert tuple(rest) == ("E11", "force_N", "width_mm", *CONDITION)
    assert float(rest["force_N"]) == 0 < float(pulled["force_N"])
    assert float(pulled["width_mm"]) == pytest.approx(
        (1 - 0.5 * 0.002) * float(rest["width_mm"]), rel=1e-8
    )

    report = json.loads((folder / "strip.json").read_text())
    assert report["settings"]["strip"] == {"strain": 0.002, "contraction": 0.5, "points": 1}
    assert report["solver"]["finished"] and report["contact"]["states_beyond"] == 0
    assert {"strip.inp", "strip.frd", "strip.csv", "strip.pvd", "strip_state_1.vtu"} <= set(
        report["files"]
    )
    assert f"strip pulls with {report['last_force_N']:.3f} N" in said and "strip.json" in said


@needs_ccx
def test_it_is_a_depth_of_studies(families, tmp_path):
    settings = read_settings(families, "plain_flat")
    assert "strip" in depths()
    assert {"strip.force_N", "strip.max_penetration_mm"} <= set(figure_names("strip", settings))
    assert "is a figure of depth strip, this study is of depth mesh" in figure_fault(
        "strip.force_N", "mesh"
    )

    row, _ = find_row(families, "plain_flat")
    outcome = run_unit(row, Work("strip", {}, 300.0, settings), None)
    assert (outcome.status, outcome.reason) == ("done", "")
    assert outcome.figures["strip.force_N"] > 0
