"""Rows measured on fabrics say where they come from, and their notes what the source and the model say."""

import pytest

from fabric_cad import identify, read_family
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.weave.directions import DIRECTIONS

# printed in Cao et al. 2008, Table 1: areal mass g/m2, fabric thickness mm, standard deviations of the widths mm
TWINTEX = [
    ("plain", "twintex_tpeet22", 743, 1.2, {"weft": 0.150, "warp": 0.140}),
    ("twill", "twintex_tpeet44", 1485, 2.0, {"weft": 0.401, "warp": 0.107}),
    ("twill", "twintex_tpecu53", 1816, 3.3, {"weft": 0.21, "warp": 0.38}),
]


@pytest.mark.parametrize(("family", "name", "areal", "thickness", "std"), TWINTEX)
def test_twintex_rows_are_those_of_the_source(family, name, areal, thickness, std):
    row = read_family(shipped_families() / f"{family}.csv")[name]
    fabric = identify(row)[name]
    notes, source = row.notes[0], row.sources[0]
    assert "Cao et al. 2008" in source and "recalled" not in source + notes
    assert (
        "4.14 kPa" in notes
        and "Assumption" in notes
        and "Conflict" in notes
        and str(areal) in notes
    )
    assert fabric.fabric_thickness == pytest.approx(thickness, rel=1e-12)
    for direction in DIRECTIONS:
        assert row.scatter[f"{direction}_width_mm"][0] == std[direction]


@pytest.mark.parametrize(("family", "name", "areal"), [row[:3] for row in TWINTEX])
def test_what_the_notes_compute_is_so(family, name, areal):
    row = read_family(shipped_families() / f"{family}.csv")[name]
    solved = identify(row).row(name)
    mass = {
        d: row.measured[f"{d}_density_per_mm"][0] * row.measured[f"{d}_linear_density_tex"][0]
        for d in DIRECTIONS
    }
    if name == "twintex_tpeet22":
        crimps = [100 * (areal / (1870 * count) - 1) for count in (0.191 + 0.190, 0.195 + 0.195)]
        assert f"{min(crimps):.1f} to {max(crimps):.1f} %" in row.notes[0]
        assert f"about {100 * solved['weft_crimp']:.1f} %" in row.notes[0]
    else:
        assert f"gives {sum(mass.values()):.0f} g/m2 before any crimp" in row.notes[0]
        weft, warp = (f"{d} {100 * solved[f'{d}_crimp']:.1f} %" for d in DIRECTIONS)
        assert f"{weft} and {warp}" in row.notes[0]
