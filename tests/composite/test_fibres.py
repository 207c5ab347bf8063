"""Sections anywhere along a yarn, and how much of them is fibre."""

from pathlib import Path

import numpy as np
import pytest

from fabric_cad.composite.constituents import read_constituents
from fabric_cad.composite.fibres import fibre_fractions, fibre_sections
from fabric_cad.composite.substances import CLOSEST_PACKING, Constituents, Fibre, GivenYarn, Matrix
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families, read_family
from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError
from fabric_cad.yarn.profiles import section_areas, slopes
from fabric_cad.yarn.swept import swept_yarns
from fabric_cad.yarn.volumes import yarn_volumes

MATRIX = Matrix(3500.0, 0.35)
GLASS = Fibre(73e3, 73e3, 30e3, 30e3, 0.2, density_g_cm3=2.5)
TABLE = """name,weft_density_per_mm,weft_width_mm,weft_crimp,section,weft_contact_top_mm,weft_contact_bottom_mm,{extra}
woven,0.22,3.2,0.004,{section},{chord},{chord},{values}
"""


def table(folder, extra="notes", values="", section="lenticular", chord=""):
    path = Path(folder) / "plain.csv"
    path.write_text(TABLE.format(extra=extra, values=values, section=section, chord=chord))
    return read_family(path)


def quadrature(swept):
    """Places along a yarn and their weights, mm: Gauss between all knots."""
    points, weights = np.polynomial.legendre.leggauss(8)
    knots = np.unique(np.concatenate([piece.knots for piece in swept.trajectory.pieces]))
    spans = np.diff(knots)[:, None]
    return (knots[:-1, None] + spans * (points + 1) / 2).ravel(), (spans * weights / 2).ravel()


@pytest.mark.parametrize("family", ["plain", "twill", "satin", "pattern"])
def test_areas_add_up_to_volumes_and_slopes_to_lengths(family):
    rows = read_families(shipped_families())[family]
    solved = identify(rows)
    volumes = yarn_volumes(
        {name: np.asarray(column) for name, column in solved.columns.items()}, rows.weaves
    )
    for number, fabric in enumerate(solved):
        found, lengths, extents = (dict.fromkeys(volumes, 0.0) for _ in range(3))
        for swept in swept_yarns(fabric):
            places, weights = quadrature(swept)
            found[swept.yarn.direction] += section_areas(swept, places) @ weights
            lengths[swept.yarn.direction] += np.hypot(1.0, slopes(swept, places)) @ weights
            extents[swept.yarn.direction] += swept.planes[-1].place

        for direction, volume in found.items():
            crimp = fabric.directions[direction].crimp
            assert lengths[direction] == pytest.approx(extents[direction] * (1 + crimp), rel=1e-9)
            expected = volumes[direction][number]  # none for round sections: see the next test
            assert np.isnan(expected) or volume == pytest.approx(expected, rel=1e-12)


def test_a_round_section_has_the_area_of_its_outline(tmp_path):
    fabric = identify(table(tmp_path, section="round", chord="3.05"))["woven"]
    swept = swept_yarns(fabric)[0]
    places = np.array([plane.place for plane in swept.planes[:-1]])
    for section, area in zip(swept.sections, section_areas(swept, places)):
        area_of_outline = 0.0
        for side, strip in section.strips.items():
            v, z = strip.at(np.linspace(0, 1, 4001)).T
            part = np.sum((z[1:] + z[:-1]) / 2 * np.diff(v))
            area_of_outline += part if side == "top" or side.endswith("upper") else -part
        assert area == pytest.approx(area_of_outline, rel=1e-6)


def test_fibre_is_neither_lost_nor_found_along_a_yarn(tmp_path):
    """The integral of V over the volume is the section of fibre times the yarn's length."""
    row = table(tmp_path, "weft_linear_density_tex", "800")
    sections = fibre_sections(row, Constituents(MATRIX, GLASS))
    fabric = identify(row)["woven"]
    for swept in swept_yarns(fabric):
        places, weights = quadrature(swept)
        fraction = fibre_fractions(swept, sections, places)
        fibre = (fraction * section_areas(swept, places)) @ weights
        assert fibre == pytest.approx(800 / (1000 * 2.5) * swept.planes[-1].place * 1.004, rel=1e-8)
        assert fraction.min() < fraction.max()


def test_of_a_commingled_yarn_a_share_is_fibre(tmp_path):
    row = table(tmp_path, "weft_linear_density_tex", "800")
    sections = fibre_sections(
        row, Constituents(MATRIX, GLASS, GivenYarn(fibre_weight_fraction=0.6))
    )
    assert sections.areas["weft"] == pytest.approx(0.6 * 0.32)


@pytest.mark.parametrize("family", ["plain", "twill", "satin", "pattern"])
def test_every_shipped_row_has_constituents_and_room_for_its_fibres(family):
    rows = read_families(shipped_families())[family]
    solved = identify(rows)
    for name in rows.names:
        sections = fibre_sections(rows[name], read_constituents(shipped_families(), name))
        for swept in swept_yarns(solved[name])[
            :: solved[name].weave.wefts
        ]:  # the first of either direction
            fraction = fibre_fractions(swept, sections, np.array([0.1]))
            assert 0.1 < fraction[0] < 0.9


def test_the_rows_own_fibre_density_goes_before_the_constituents(tmp_path):
    row = table(tmp_path, "weft_linear_density_tex,fibre_density_g_cm3", "800,2.0")
    assert fibre_sections(row, Constituents(MATRIX, GLASS)).areas == {"weft": 0.4, "warp": 0.4}


def test_a_given_fraction_holds_all_along_and_before_a_linear_density_only_where_given_for_the_row(
    tmp_path,
):
    row = table(tmp_path, "weft_linear_density_tex", "800")
    swept = swept_yarns(identify(row)["woven"])[0]
    general, own = (
        Constituents(MATRIX, GLASS, GivenYarn(0.6, own_fraction=own)) for own in (False, True)
    )
    assert fibre_sections(row, general).areas["weft"] == pytest.approx(0.32)
    np.testing.assert_array_equal(
        fibre_fractions(swept, fibre_sections(row, own), np.array([1.0, 2.0])), 0.6
    )


def test_too_much_fibre_is_refused_with_yarn_place_and_number(tmp_path):
    row = table(tmp_path, "weft_linear_density_tex", "2200")
    sections = fibre_sections(row, Constituents(MATRIX, GLASS))
    swept = swept_yarns(identify(row)["woven"])[0]
    with pytest.raises(InputError) as error:
        fibre_fractions(swept, sections, np.array([1.0]))
    told = str(error.value)
    assert told.startswith(
        f"{tmp_path / 'plain.csv'}:2: weft_linear_density_tex: weft_1: its fibres would take "
    )
    assert f"above {CLOSEST_PACKING:.4f}" in told
    assert "mm along it" in told


@pytest.mark.parametrize(
    ("extra", "values", "said"),
    [
        ("notes", "", "fibre_fraction: is missing, and the row gives no linear density"),
        (
            "weft_linear_density_tex",
            "800",
            "density_g_cm3: is missing: the fibre fraction is to follow",
        ),
    ],
)
def test_what_is_missing_is_told(tmp_path, extra, values, said):
    light = Fibre(73e3, 73e3, 30e3, 30e3, 0.2)
    with pytest.raises(InputError, match=said):
        fibre_sections(
            table(tmp_path, extra, values), Constituents(MATRIX, light, path="composite.toml")
        )
