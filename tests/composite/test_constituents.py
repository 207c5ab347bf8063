"""composite.toml: what it gives, and what is told of a wrong or an unfinished one."""

import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabric_cad.composite.constituents import read_constituents
from fabric_cad.composite.substances import CLOSEST_PACKING
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.support.errors import InputError

FIBRE = "[fibre]\nE1_MPa = 73e3\nE2_MPa = 73e3\nG12_MPa = 30e3\nG23_MPa = 30e3\nnu12 = 0.2\n"
MATRIX = "[matrix]\nE_MPa = 3400\nnu = 0.35\n"
YARN = "[yarn]\nE1_MPa = 57.5e3\nE2_MPa = 18.8e3\nG12_MPa = 7.44e3\nnu12 = 0.25\nnu23 = 0.29\n"


def read(folder, text, row="plain"):
    (folder / "composite.toml").write_text(text, encoding="utf-8")
    return read_constituents(folder, row)


def test_without_a_file_the_shipped_one_holds(tmp_path):
    shipped = read_constituents(shipped_families(), "plain")
    assert read_constituents(tmp_path, "plain") == shipped
    assert "assumption" in shipped.matrix.source
    assert "assumption" in shipped.fibre.source


def test_every_shipped_value_says_where_it_comes_from():
    for line in (shipped_families() / "composite.toml").read_text(encoding="utf-8").splitlines():
        if "=" in line and not line.startswith(("#", "name", "source")):
            assert "assumption" in line or "data sheet" in line, line


def test_a_row_has_its_own_values(tmp_path):
    text = (
        FIBRE
        + MATRIX
        + "[yarn]\nfibre_fraction = 0.6\n[rows.thick.fibre]\nE1_MPa = 80e3\n[rows.thick.yarn]\nfibre_fraction = 0.7\n"
    )
    plain, thick = read(tmp_path, text), read(tmp_path, text, "thick")
    assert (plain.fibre.E1_MPa, thick.fibre.E1_MPa) == (73e3, 80e3)
    assert (plain.fibre.E2_MPa, thick.fibre.E2_MPa) == (73e3, 73e3)
    assert (plain.yarn.fibre_fraction, thick.yarn.fibre_fraction) == (0.6, 0.7)
    assert (plain.yarn.own_fraction, thick.yarn.own_fraction) == (False, True)


def test_a_yarns_own_constants_need_no_fibre(tmp_path):
    constituents = read(tmp_path, MATRIX + YARN)
    assert constituents.fibre is None
    assert constituents.yarn.law.G23_MPa == pytest.approx(7286.8, abs=0.1)  # 18.8 / (2 * 1.29) GPa


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            MATRIX,
            r"toml: fibre: there is no table \[fibre\], nor are the yarn's own constants given",
        ),
        (FIBRE, r"toml: matrix: there is no table \[matrix\]"),
        (FIBRE.replace("G23_MPa = 30e3\n", "") + MATRIX, r"G23_MPa: is missing in \[fibre\]"),
        (FIBRE + "[matrix]\nE_MPa = 3400\n", r"nu: is missing in \[matrix\]"),
        (FIBRE + MATRIX.replace("0.35", "0.5"), r":9: nu: 0.5 is not between -1 and 0.5"),
        (FIBRE.replace("73e3", "-1", 1) + MATRIX, r":2: E1_MPa: -1 is not a number above 0"),
        (
            FIBRE.replace("E1_MPa", "E11_MPa") + MATRIX,
            r":2: E11_MPa: no such key in \[fibre\]; did you mean E1_MPa\?",
        ),
        (
            FIBRE + MATRIX + "density_g_cm3 = 'light'\n",
            r":10: density_g_cm3: 'light' is not a number above 0",
        ),
        (
            FIBRE + MATRIX + "[yarn]\nfibre_fraction = 0.92\n",
            r":11: fibre_fraction: 0.92 is not above 0 and up to 0.9069",
        ),
        (
            FIBRE + MATRIX + "[yarn]\nfibre_weight_fraction = 60\n",
            r":11: fibre_weight_fraction: 60 is not above 0 and up to 1",
        ),
        (
            MATRIX + YARN.replace("nu23 = 0.29\n", ""),
            r"nu23: is missing: the yarn's own constants are",
        ),
        (
            FIBRE.replace("G23_MPa = 30e3", "G23_MPa = 18e3") + MATRIX,
            r":5: G23_MPa: 18000 is not above E2_MPa / 4 = 18250",
        ),
        (
            FIBRE.replace("nu12 = 0.2", "nu12 = 0.7") + MATRIX,
            r":6: nu12: 0.7 is not between -\+sqrt.*not positive definite",
        ),
        (
            MATRIX + YARN.replace("nu12 = 0.25", "nu12 = -0.99").replace("57.5e3", "18.8e3"),
            r"nu12: -0.99 is not between",
        ),
        (FIBRE + MATRIX + "[rows.plain.matrix]\nnu = 2\n", r":11: nu: 2 is not .* \(row plain\)"),
        (FIBRE + MATRIX + "[resin]\nE_MPa = 1\n", r":10: resin: no such table"),
        ("fibre = 3\n" + MATRIX, r"fibre: is not a table"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(tmp_path, text, said):
    with pytest.raises(InputError) as error:
        read(tmp_path, text)
    assert re.search(said, str(error.value)), error.value
    assert str(error.value).startswith(str(tmp_path / "composite.toml"))


@given(st.floats(0.1, 10), st.floats(-0.99, 0.99), st.floats(0.05, 5))
def test_a_fibre_is_read_where_its_compliance_is_positive_definite(tmp_path_factory, e2, nu12, g23):
    text = (
        f"[fibre]\nE1_MPa = 1.0\nE2_MPa = {e2!r}\nG12_MPa = 1.0\nG23_MPa = {g23!r}\nnu12 = {nu12!r}\n"
        + MATRIX
    )
    nu23 = e2 / (2 * g23) - 1
    compliance = np.array(
        [[1, -nu12, -nu12], [-nu12, 1 / e2, -nu23 / e2], [-nu12, -nu23 / e2, 1 / e2]]
    )
    least = np.linalg.eigvalsh(compliance).min()
    try:
        read(tmp_path_factory.getbasetemp(), text)
    except InputError:
        assert least < 1e-12
    else:
        assert least > -1e-12


def test_closest_packing_is_that_of_a_hexagon_of_touching_circles():
    hexagon, circles = (
        6 * math.sqrt(3) / 4,
        3 * math.pi * 0.5**2,
    )  # side 1: one whole circle, six thirds
    assert pytest.approx(circles / hexagon) == CLOSEST_PACKING
