"""A study's file: what it may say, and how everything wrong in it is told at once."""

import shutil
from pathlib import Path

import pytest

from fabric_cad.cli import main
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.study.definition import read_study
from fabric_cad.study.factors import Normal, Uniform, Values
from fabric_cad.support.errors import InputError


@pytest.fixture
def here(tmp_path, monkeypatch):
    shutil.copytree(shipped_families(), tmp_path / "families")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def study(text, name="study.toml"):
    Path(name).write_text(text, encoding="utf-8")
    return read_study(name)


def problems(text):
    with pytest.raises(InputError) as error:
        study(text)
    return [str(each) for each in error.value.problems]


def test_lists_ranges_and_distributions(here):
    found = study(
        """
base = "plain_measured"
design = "latin-hypercube"
samples = 10
[factors]
weft_width_mm = "normal"
weft_crimp_percent = "uniform"
weft_density_per_mm = { from = 0.20, to = 0.22, steps = 3 }
weft_thickness_mm = { distribution = "normal", std = 0.1 }
fabric_thickness_mm = [0.7, 0.8]
section = ["lenticular", "round"]
float_gap = ["symmetric", "flat"]
"""
    )
    assert found.factors["weft_width_mm"] == Normal(3.2, 0.05)
    assert found.factors["weft_density_per_mm"] == Uniform(0.20, 0.22, 3)
    assert found.factors["weft_thickness_mm"] == Normal(0.37, 0.1)
    assert found.factors["fabric_thickness_mm"] == Values((0.7, 0.8))
    assert found.factors["section"] == Values(("lenticular", "round"))
    assert found.factors["float_gap"] == Values(("symmetric", "flat"))
    percent = found.factors[
        "weft_crimp_percent"
    ]  # as wide as has the row's standard deviation 0.04 %
    assert (percent.low + percent.high) / 2 == pytest.approx(0.4)
    assert (percent.high - percent.low) / 12**0.5 == pytest.approx(0.04)
    assert (found.name, found.work.depth, found.keep) == ("study", "identify", False)


def test_everything_wrong_is_told_with_its_line(here):
    told = problems(
        """base = "plain_mesured"
desing = "grid"
depth = "meshes"
design = "sobol"
samples = 100
seed = -1
limit_seconds = 0
figures = "all"
[mesh]
acros = 3
through = "two"
[factors]
"""
    )
    assert told == [
        "study.toml:2: desing: unknown key; did you mean design?",
        "study.toml:8: figures: 'all' is not a list",
        "study.toml:3: depth: 'meshes' is none of identify, cell, mesh, tension, stiffness; did you mean mesh?",
        "study.toml:6: seed: -1 is not at least 0",
        "study.toml:5: samples: 100 is not a power of two, as a Sobol sequence needs; 128 is the nearest",
        "study.toml:7: limit_seconds: 0 is not above 0",
        "study.toml:10: acros: unknown key; did you mean across?",
        "study.toml:11: mesh.through: 'two' is not a whole number",
        "study.toml:1: base: families: no row is called 'plain_mesured'; did you mean plain_measured? "
        "('fabric-cad list' shows them all)",
    ]


def test_every_wrong_factor_is_told(here):
    told = problems(
        """base = "plain_measured"
design = "grid"
samples = 4
depth = "mesh"
mesh.through = 3
[factors]
weft_wdth_mm = "normal"
weft_width_mm = [3.0, -1]
weft_crimp = "normal"
weft_crimp_percent = { from = 1, to = 0.5, steps = 3 }
fabric_thickness_mm = { from = 0.6, two = 0.5, steps = 3 }
warp_crimp = [1]
section = ["rond"]
lateral_height_mm = "normal"
over = [2]
weft_density_per_mm = 3
"""
    )
    assert told == [
        "study.toml:3: samples: has no meaning in a grid design",
        "study.toml:5: mesh.through: 3 is odd; a lenticular section has an even number of layers",
        "study.toml:7: factor weft_wdth_mm: no column of plain.csv that can vary; did you mean weft_width_mm?",
        "study.toml:8: factor weft_width_mm: -1 is not above 0",
        "study.toml:9: factor weft_crimp: a grid takes a list, or a range with steps",
        "study.toml:10: factor weft_crimp_percent: the same quantity as factor weft_crimp, in another unit",
        "study.toml:10: factor weft_crimp_percent: from 1 is not below to 0.5",
        "study.toml:11: factor fabric_thickness_mm: two: unknown key; did you mean to?",
        "study.toml:12: factor warp_crimp: the base row plain_measured is balanced (every warp cell is empty); "
        "its weft cells vary both",
        "study.toml:13: factor section: 'rond' is none of lenticular, flat, round",
        "study.toml:14: factor lateral_height_mm: the base row plain_measured has no lateral_height_mm; "
        "give it here or there",
        "study.toml:15: factor over: no column of plain.csv that can vary",
        "study.toml:16: factor weft_density_per_mm: 3 is not a list, a range like { from = 1, to = 2 } "
        "or a distribution",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("base = ,", "study.toml:1: not TOML: Invalid value"),
        ("", "study.toml: base: this key is missing"),
        ("base = 'plain'\ndesign = 'grid'\nfactors = {}", "study.toml:3: factors: is empty"),
        (
            "base = 'plain'\ndesign = 'grid'\n[factors]\nweft_crimp = 'normal'",
            "study.toml:4: factor weft_crimp: the base row plain has no weft_crimp_std; give it here or there",
        ),
        (
            "base = 'plain'\ndesign = 'sobol'\nsamples = 8388608\n[factors]\nweft_crimp = {from = 0.001, to = 0.002}",
            "study.toml:3: samples: 25165824 units are more than 10000000",
        ),
    ],
)
def test_one_wrong_thing(here, text, words):
    assert problems(text)[0].startswith(words)


def test_the_command_reports_and_exits_with_2(here, capsys):
    Path("families/plain.csv").write_text(
        "name,weft_density_per_mm,weft_width_mm,weft_crimp\nplain,0.22,9,0.004\n"
    )
    Path("a.toml").write_text("base = 'plain'\ndesign = 'grid'\n[factors]\nweft_crimp = [0.004]\n")
    assert main(["study", "a.toml"]) == 2
    told = capsys.readouterr().err
    assert (
        told
        == "families/plain.csv:2: weft_width_mm: 9 is not below the weft spacing 4.545 mm (row plain)\n"
    )
    assert main(["study", "none.toml"]) == 2
    assert capsys.readouterr().err == "none.toml: cannot be read: No such file or directory\n"
    assert not Path("build").exists()
