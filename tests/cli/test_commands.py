"""Commands as they are declared: one value each, frozen options, and what a study lists."""

import dataclasses
from types import SimpleNamespace

import pytest

from fabric_cad.cli import main
from fabric_cad.cli.commands import commands
from fabric_cad.cli.parser import read_request

ARGUMENTS = {"study": ["s.toml"], "wif": ["d.wif", "--name", "d"]}


@pytest.mark.parametrize("command", commands(), ids=lambda command: command.name)
def test_what_a_command_reads_is_its_own_frozen_options(command):
    request = read_request(["--out", "there", command.name, *ARGUMENTS.get(command.name, []), "-q"])

    assert request.command.name == command.name and type(request.options) is command.options
    assert (request.options.out, request.options.families, request.quiet) == (
        "there",
        "families",
        True,
    )
    with pytest.raises(dataclasses.FrozenInstanceError):
        request.options.out = "elsewhere"


@pytest.mark.parametrize("name", ["cell", "tension", "shear"])
def test_what_is_said_of_a_mesh_is_kept_and_nothing_else(name):
    assert read_request([name, "plain"]).options.mesh == {}

    options = read_request([name, "plain", "twill22", "--size", "0.2", "--gap", "6"]).options
    assert options.mesh == {"size": 0.2, "gap": 6} and options.rows == ("plain", "twill22")


def test_a_study_lists_its_files_that_are_there(tmp_path, monkeypatch, capsys):
    for name in ("table.csv", "sensitivity.csv", "sensitivity.pdf"):
        (tmp_path / name).write_text("")
    counts = SimpleNamespace(
        done=1, refused=0, failed=0, before=0, notes=(), reasons={}, folder=tmp_path
    )
    study = SimpleNamespace(name="widths", design="grid")
    monkeypatch.setattr("fabric_cad.study.read_study", lambda *_: study)
    monkeypatch.setattr("fabric_cad.study.run_study", lambda *_: counts)
    monkeypatch.setattr("fabric_cad.study.sensitivity.read_sensitivities", lambda _: [])
    monkeypatch.setattr("fabric_cad.study.answer.reasons_lines", lambda _: [])
    monkeypatch.setattr("fabric_cad.study.answer.answer_lines", lambda *_: [])

    assert main(["study", "widths.toml"]) == 0
    listed = [line.strip() for line in capsys.readouterr().out.splitlines()[1:]]
    assert listed == [
        str(tmp_path / name) for name in ("table.csv", "sensitivity.csv", "sensitivity.pdf")
    ]
