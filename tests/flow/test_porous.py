"""Flow through porous yarns: Gebart's fibres, layers in closed form, and the limits of Brinkman's equations."""

import numpy as np
import pytest
from flow_blocks import box
from hypothesis import given, settings
from hypothesis import strategies as st

from fabric_cad.flow import gebart
from fabric_cad.flow.equations import assemble
from fabric_cad.flow.quadratic import QuadraticMesh
from fabric_cad.flow.stokes import stokes_flow


def porous_flow(mesh, resistance, directions, tolerance=1e-10):
    equations = assemble(mesh, np.zeros((len(mesh.points), 3), dtype=bool), resistance)
    return stokes_flow(equations, np.array(directions, dtype=float), mesh.mesh.volume, tolerance)


@given(st.floats(1e-3, 1e-2), st.floats(0.3, 0.85))
def test_fibres_conduct_along_themselves(radius, fraction):
    assert gebart.along(radius, fraction) > gebart.across(radius, fraction) > 0
    assert gebart.across(radius, np.pi / (2 * np.sqrt(3))) == 0
    assert gebart.along(2 * radius, fraction) == pytest.approx(4 * gebart.along(radius, fraction))


@settings(max_examples=5, deadline=None)
@given(st.floats(0.0, np.pi), st.floats(0.4, 0.7), st.floats(1e-3, 1.0))
def test_fibres_everywhere_have_their_own_permeability(angle, fraction, radius):
    """The mixture to which porous yarns tend as the space between them closes."""
    axis = np.array([np.cos(angle), np.sin(angle), 0.0])
    mesh = QuadraticMesh.straight(box((2, 2, 2), (1.0, 1.2, 0.7)))
    resistance = np.broadcast_to(
        gebart.resistance(radius, np.array([fraction]), axis[None]), (8, 3, 3)
    )
    flow = porous_flow(mesh, resistance, np.eye(3))
    one = np.outer(axis, axis)
    wanted = gebart.along(radius, fraction) * one + gebart.across(radius, fraction) * (
        np.eye(3) - one
    )
    np.testing.assert_allclose(flow.permeability, wanted, rtol=0, atol=1e-8 * wanted.max())


@pytest.mark.parametrize("inner", [1e-1, 1e-2, 1e-3])
def test_layers_of_fluid_and_pores_are_as_in_closed_form(inner):
    """u = c - z^2 / 2 in the fluid, k + d cosh((z - b) / sqrt k) in the pores; along z all is in series."""
    a, b = 0.3, 0.5
    mesh = QuadraticMesh.straight(box((2, 2, 40), (1.0, 1.0, 2 * b)))
    height = np.abs(mesh.mesh.points[mesh.mesh.hexahedra].mean(axis=1)[:, 2] - b)
    resistance = np.where((height > a)[:, None, None], np.eye(3) / inner, 0.0)
    flow = porous_flow(mesh, resistance, np.eye(3))

    s = np.sqrt(inner)
    d = -a * s / np.sinh((a - b) / s)
    c = a**2 / 2 + inner + d * np.cosh((a - b) / s)
    total = c * a - a**3 / 6 + inner * (b - a) - d * s * np.sinh((a - b) / s)
    assert flow.permeability[0, 0] == pytest.approx(total / b, rel=1e-4)
    assert flow.permeability[2, 2] == pytest.approx(inner * b / (b - a), rel=1e-6)


def test_pores_that_close_are_walls():
    a, b, inner = 0.3, 0.5, 1e-9
    mesh = QuadraticMesh.straight(box((2, 2, 10), (1.0, 1.0, 2 * b)))
    height = np.abs(mesh.mesh.points[mesh.mesh.hexahedra].mean(axis=1)[:, 2] - b)
    resistance = np.where((height > a)[:, None, None], np.eye(3) / inner, 0.0)
    flow = porous_flow(mesh, resistance, np.eye(3)[:2])
    assert flow.permeability[0, 0] == pytest.approx((2 * a) ** 2 / 12 * a / b, rel=2e-3)
