"""simulation.toml: defaults, a row's own values, and what is told of a wrong one."""

import math
import re

import numpy as np
import pytest

from fabric_cad.measured.shipped import shipped_families
from fabric_cad.simulation.settings import read_settings
from fabric_cad.support.errors import InputError


def read(tmp_path, text, row="plain"):
    (tmp_path / "simulation.toml").write_text(text, encoding="utf-8")
    return read_settings(tmp_path, row)


def test_without_a_file_the_shipped_one_holds(tmp_path):
    assert read_settings(tmp_path, "plain") == read_settings(shipped_families(), "any_row")


def test_every_shipped_value_says_where_it_comes_from():
    for line in (shipped_families() / "simulation.toml").read_text(encoding="utf-8").splitlines():
        if "=" in line and not line.startswith("#"):
            assert "#" in line, line


def test_a_row_has_its_own_values(tmp_path):
    text = "[yarn]\nE1_MPa = 1000\n[rows.thick.yarn]\nE2_MPa = 5.0\n[rows.thick.tension]\nratios = [inf, 3]\n"
    plain, thick = read(tmp_path, text), read(tmp_path, text, "thick")
    assert (plain.yarn.E1_MPa, thick.yarn.E1_MPa) == (1000, 1000)
    assert (plain.yarn.E2_MPa, thick.yarn.E2_MPa) == (70, 5)
    assert thick.case("tension").ratios == (math.inf, 3.0)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[yarn]\nE1_MPa = -1\n", r":2: E1_MPa: -1 is not a number above 0"),
        ("[yarn]\nE1_MPa = true\n", r":2: E1_MPa: True is not"),
        ("[yarn]\n\nE1_Mpa = 3\n", r":3: E1_Mpa: no such key in \[yarn\]; did you mean E1_MPa\?"),
        ("[tensoin]\nstrain = 1\n", r":1: tensoin: no such table; did you mean tension\?"),
        ("[contact]\nkind = 'glue'\n", r":2: kind: 'glue' is neither"),
        ("[tension]\nratios = [1, -2]\n", r":2: ratios: \[1, -2\] is not a list"),
        ("[tension]\npoints = 2.5\n", r":2: points: 2.5 is not a whole number from 1 to 100"),
        (
            "[rows.plain.shear]\n# so far\nangle_deg = 90\n",
            r":3: angle_deg: 90 is not .* \(row plain\)",
        ),
        ("[yarn]\nE1_MPa = \n", r":2: "),
        ("yarn = 3\n", r"yarn: is not a table"),
        (
            "[yarn]\nnu23 = 0.9\nnu12 = 0.9\nnu13 = 0.1\nE2_MPa = 35000\nE3_MPa = 35000\n",
            "no stable material",
        ),
    ],
)
def test_what_is_wrong_is_named_with_its_place(tmp_path, text, said):
    with pytest.raises(InputError) as error:
        read(tmp_path, text)
    assert re.search(said, str(error.value)), error.value
    assert str(error.value).startswith(str(tmp_path / "simulation.toml"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "[rows.plane.yarn]\nE1_MPa = 1.0\n",
            r"simulation.toml:?\d*: rows.plane: no row is called so; did you mean plain\?",
        ),
        ("[rows]\nplain = 3\n", r"simulation.toml:2: rows.plain: is not a table"),
    ],
)
def test_a_row_that_is_none_is_told(tmp_path, text, said):
    (tmp_path / "plain.csv").write_text(
        "name,weft_density_per_mm,weft_width_mm,weft_crimp\nplain,0.22,3.2,0.004\n"
    )
    with pytest.raises(InputError, match=said):
        read(tmp_path, text)


def test_all_that_is_wrong_is_told_at_once(tmp_path):
    with pytest.raises(InputError) as error:
        read(tmp_path, "[yarn]\nE1_MPa = 0\nE2_MPa = 'soft'\n[contact]\nrings = -1\n")
    assert len(error.value.problems) == 3


def test_the_compliance_is_that_of_the_constants(tmp_path):
    law = read(
        tmp_path, "[yarn]\nE1_MPa = 100.0\nE2_MPa = 20.0\nE3_MPa = 10.0\nnu12 = 0.3\nnu13 = 0.2\n"
    ).yarn
    strain = law.compliance @ [1.0, 0.0, 0.0]
    assert strain == pytest.approx([0.01, -0.003, -0.002])
    assert law.compliance == pytest.approx(law.compliance.T)


def test_compaction_doubles_the_modulus_at_its_strain(tmp_path):
    law = read(tmp_path, "[yarn]\ncompaction_strain = 0.15\n").yarn
    crush = np.array([0.15])
    assert 3 * law.hardening * crush**2 == pytest.approx(law.E3_MPa)
    assert read(tmp_path, "").yarn.hardening == 0


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a = " + 3000 * "[", "nested too deeply"),
        ("a = " + 5000 * "1", "not TOML that can be read"),
    ],
)
def test_toml_that_its_reader_chokes_on(tmp_path, text, expected):
    with pytest.raises(InputError, match=f"simulation.toml: .*{expected}"):
        read(tmp_path, text)


def test_a_long_value_is_cut_where_it_is_told(tmp_path):
    with pytest.raises(InputError) as refused:
        read(tmp_path, f'[tension]\nstrain = "{"a" * 100_000}"\nratios = [{"-1, " * 9999}-1]\n')
    assert len(str(refused.value)) < 1000
    assert "strain: 'aaa" in str(refused.value) and "'... is not above 0" in str(refused.value)
