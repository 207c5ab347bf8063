"""The map from woven coordinates to space, on the poles of yarns' faces."""

import numpy as np
import pytest
from fabrics import table

from fabric_cad.cad.solids import sweep
from fabric_cad.model.identification import identify
from fabric_cad.weave.lattice import Lattice
from fabric_cad.yarn.swept import swept_yarns


@pytest.mark.parametrize("section", ["lenticular", "round"])
def test_a_linear_map_of_a_yarn_is_a_valid_solid_of_its_determinant_times_the_volume(section):
    chords = (
        {f"weft_contact_{side}_mm": 2.4 for side in ("top", "bottom")} if section == "round" else {}
    )
    row = {
        "name": "t",
        "section": section,
        "weft_density_per_mm": 0.25,
        "weft_width_mm": 2.5,
        "weft_crimp": 0.004,
    }
    fabric = identify(table("plain", row | chords))["t"]
    half = np.radians(15)
    turned = np.array(
        [[np.cos(half), np.sin(half), 0], [np.sin(half), np.cos(half), 0], [0, 0, 1.2]]
    )
    lattice = Lattice(np.array(fabric.period), turned)

    for swept in swept_yarns(fabric)[::2]:
        woven, turned_solid = (
            sweep(swept.trajectory, swept.sections, each) for each in (fabric.lattice, lattice)
        )
        assert turned_solid.isValid()
        assert turned_solid.Volume(1e-9) == pytest.approx(
            np.linalg.det(turned) * woven.Volume(1e-9), rel=1e-7
        )

        centre = np.array(turned_solid.Center().toTuple())
        assert centre == pytest.approx(
            lattice.to_space(np.array(woven.Center().toTuple())), abs=1e-6
        )
