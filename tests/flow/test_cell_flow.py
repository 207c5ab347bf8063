"""Flow in cells of fabrics: exact faces, published figures of a balanced weave, what closes a direction."""

import numpy as np
import pytest

from fabric_cad.composite.matrix import mesh_composite
from fabric_cad.composite.options import Margin
from fabric_cad.flow.computation import cell_flow
from fabric_cad.flow.fineness import fineness
from fabric_cad.flow.quadratic import QuadraticMesh
from fabric_cad.flow.space import Top, space_between
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.model.identification import identify
from fabric_cad.yarn.heights import heights
from fabric_cad.yarn.swept import swept_yarns


@pytest.fixture(scope="module")
def fabrics():
    return {
        fabric.name: fabric
        for table in read_families(shipped_families()).values()
        for fabric in identify(table)
    }


def coarse(fabric, top=Top.PERIODIC, **asked):
    return fineness(fabric, {"across": 4, "crossing": 4, "gap": 2}, top=top, layers=3, **asked)


@pytest.fixture(scope="module")
def flows(fabrics):
    """A balanced plain weave under every top."""
    return {top: cell_flow(fabrics["plain"], coarse(fabrics["plain"], top), top) for top in Top}


def test_a_balanced_plain_weave_is_as_computed_before(flows):
    """18 432 hexahedra of an independent code: Kx = Ky = .0085 mm2; Kz .0089 on layers graded less than here."""
    solved = flows[Top.PERIODIC]
    tensor = solved.flow.permeability
    assert tensor[0, 0] == pytest.approx(0.0085, rel=0.01)
    assert tensor[2, 2] == pytest.approx(0.0089, rel=0.05)
    assert tensor[1, 1] == pytest.approx(tensor[0, 0], rel=1e-6)
    np.testing.assert_allclose(tensor - np.diag(np.diag(tensor)), 0, atol=1e-6 * tensor.max())
    assert solved.flow.work < 1e-4 and solved.flow.divergence < 1e-4


@pytest.mark.parametrize(("margin", "published"), [(0.01, 0.0062), (0.025, 0.0071), (0.1, 0.0127)])
def test_the_clearance_decides(fabrics, margin, published):
    fine = coarse(fabrics["plain"], margin=Margin(margin))
    tensor = cell_flow(fabrics["plain"], fine, Top.PERIODIC).flow.permeability
    assert tensor[0, 0] == pytest.approx(published, rel=0.04)


def test_plates_close_the_normal_and_hold_back(flows):
    for top in (Top.PLATES, Top.OPEN):
        np.testing.assert_array_equal(flows[top].flow.permeability[2], 0)
    periodic, plates, free = (flows[top].flow.permeability[0, 0] for top in Top)
    assert 0 < plates < free < periodic


@pytest.mark.parametrize("name", ["plain", "twill22_offsets", "plain_flat", "plain_round"])
def test_nodes_between_corners_lie_on_the_yarns(fabrics, name):
    fabric = fabrics[name]
    fine = fineness(fabric, {"across": 4, "crossing": 4}, layers=2)
    cell = mesh_composite(fabric, fine.yarns, fine.box)
    mesh = space_between(cell, fabric, Top.PERIODIC)
    straight = QuadraticMesh.straight(mesh.mesh)
    assert len(mesh.folded()) == 0
    off = [_off_faces(some, fabric, cell.shift) for some in (mesh, straight)]
    assert np.median(off[0]) < 1e-9 * fabric.fabric_thickness
    assert np.mean(off[0]) < 0.7 * np.mean(off[1])  # sides of flat and round sections stay straight


def _off_faces(mesh, fabric, shift):
    """Distances of walls' middles from the nearest face of a yarn over or under them."""
    middles = mesh.points[mesh.boundary[:, 4]]
    off = np.full(len(middles), np.inf)
    for swept in swept_yarns(fabric):
        axis = swept.yarn.direction.axis
        away = middles[:, 1 - axis] - swept.trajectory.axis
        near = np.flatnonzero(np.abs(away) <= fabric.directions[swept.yarn.direction].width / 2)
        along, row = np.unique(middles[near, axis], return_inverse=True)
        across, column = np.unique(away[near], return_inverse=True)
        for face in heights(swept, along, across):
            off[near] = np.fmin(off[near], np.abs(face[row, column] + shift - middles[near, 2]))
    return off[np.isfinite(off)]
