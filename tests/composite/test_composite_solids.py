"""The solid between the yarns: valid, its faces the yarns' own, and with them it fills the box."""

import numpy as np
import pytest
from fabrics import TWILL32, table

from fabric_cad.cad import read_step
from fabric_cad.cad.matrix import checked_volumes
from fabric_cad.composite.matrix import centring
from fabric_cad.composite.solids import build_composite
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.model.identification import identify

FABRICS = {
    fabric.name: fabric
    for family in read_families(shipped_families()).values()
    for fabric in identify(family)
}


def box(fabric, margin=0.05):
    return np.array([*fabric.period, fabric.fabric_thickness * (1 + 2 * margin)])


@pytest.mark.parametrize(
    "name", ["plain", "plain_unbalanced", "plain_flat", "plain_round", "twill21"]
)
def test_matrix_and_yarns_fill_the_box(name, tmp_path):
    fabric = FABRICS[name]
    build_composite(fabric, box(fabric)).write_step(tmp_path / "composite.step")
    solids = read_step(tmp_path / "composite.step")
    assert list(solids)[-1] == "matrix"
    volumes = checked_volumes(solids, box(fabric))
    assert sum(volumes.values()) == pytest.approx(box(fabric).prod(), rel=1e-9)
    bounds = solids["matrix"].BoundingBox(1e-9)
    assert bounds.zmax == pytest.approx(-bounds.zmin) == pytest.approx(box(fabric)[2] / 2, abs=1e-6)


def test_faces_of_the_matrix_are_those_of_the_yarns(tmp_path):
    """All faces of the yarns but their ends and contacts are its own; six more are the box's."""
    fabric = FABRICS["plain"]
    solids = build_composite(fabric, box(fabric)).solids
    ours = {_about(face) for face in solids["matrix"].Faces()}
    theirs = [
        _about(face) for name, yarn in solids.items() if name != "matrix" for face in yarn.Faces()
    ]
    crossings = fabric.weave.interlacement().size
    yarns, ends = len(solids) - 1, 2 * (len(solids) - 1)
    assert len(ours) == len(theirs) - ends - 2 * crossings + 6
    assert sum(face in ours for face in theirs) == len(ours) - 6
    assert yarns == 4


def _about(face):
    return (*np.round(face.Center().toTuple(), 6), round(face.Area(), 6))


def test_what_yarns_leave_with_chords_below_the_width():
    """Flat pieces on which both yarns float touch beyond their chords too: they bound no matrix."""
    row = TWILL32 | {
        "over": 2,
        "under": 2,
        "weft_contact_top_mm": 2.3,
        "weft_contact_bottom_mm": 2.2,
    }
    fabric = identify(table("twill", row))["twill32"]
    solids = build_composite(fabric, box(fabric)).solids
    assert sum(checked_volumes(solids, box(fabric)).values()) == pytest.approx(
        box(fabric).prod(), rel=1e-9
    )


def test_yarns_stand_at_mid_height():
    fabric = FABRICS["plain_unbalanced"]
    solids = build_composite(fabric, box(fabric)).solids
    bounds = [solid.BoundingBox(1e-9) for name, solid in solids.items() if name != "matrix"]
    top, bottom = max(each.zmax for each in bounds), min(each.zmin for each in bounds)
    assert (
        top
        == pytest.approx(fabric.fabric_thickness / 2, abs=1e-5)
        == pytest.approx(-bottom, abs=1e-5)
    )
    assert centring(fabric) != 0.0
