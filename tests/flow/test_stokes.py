"""Stokes flow against what is known of slots, pipes, arrays of cylinders, and of any permeability."""

import numpy as np
import pytest
from flow_blocks import around_a_cylinder, box, flow_between_walls, pipe
from hypothesis import given, settings
from hypothesis import strategies as st

from fabric_cad.flow.connections import open_directions
from fabric_cad.flow.minres import solve
from fabric_cad.flow.quadratic import CORNER_NODES, PLACES, QuadraticMesh
from fabric_cad.support.errors import BuildError, SolverError

SLOT = (True, True, False)


@settings(max_examples=5, deadline=None)
@given(
    height=st.floats(0.05, 5.0),
    lean=st.floats(-0.8, 0.8),
    counts=st.tuples(st.integers(2, 3), st.integers(2, 3), st.integers(1, 4)),
)
def test_a_slot_has_a_twelfth_of_its_height_squared(height, lean, counts):
    """Q2 elements hold the parabola exactly, on cells that lean as well."""
    mesh = QuadraticMesh.straight(box(counts, [[1.0, 0, 0], [lean, 0.8, 0], [0, 0, height]], SLOT))
    _, flow = flow_between_walls(mesh, np.eye(3)[:2], 1e-11)
    np.testing.assert_allclose(
        flow.permeability, np.diag([1, 1, 0]) * height**2 / 12, rtol=0, atol=1e-10 * height**2
    )
    assert flow.work < 1e-9 and flow.divergence < 1e-9


def test_a_pipe_has_an_eighth_of_its_radius_squared():
    radius = 0.4
    _, flow = flow_between_walls(pipe(radius, 4), [[0, 0, 1]])
    assert flow.permeability[2, 2] == pytest.approx(np.pi * radius**4 / 8, rel=1e-3)


@pytest.mark.parametrize(
    ("solid", "drag"), [(0.05, 15.56), (0.2, 51.53), (0.4, 217.89), (0.6, 1763.0)]
)
def test_a_square_array_of_cylinders_has_the_published_drag(solid, drag):
    """A. S. Sangani and A. Acrivos, Int. J. Multiphase Flow 8 (1982) 193-206: drag over viscosity and mean velocity."""
    mesh = around_a_cylinder(np.sqrt(solid / np.pi), sides=4, rings=6)
    _, flow = flow_between_walls(mesh, np.eye(3)[:2])
    assert 1 / flow.permeability[0, 0] == pytest.approx(drag, rel=5e-3)
    assert flow.permeability[1, 1] == pytest.approx(flow.permeability[0, 0], rel=1e-5)
    assert abs(flow.permeability[0, 1]) < 1e-6 * flow.permeability[0, 0]


def test_a_permeability_is_that_of_its_mean_velocities():
    mesh = around_a_cylinder(0.3, sides=1, rings=3)
    equations, flow = flow_between_walls(mesh, np.eye(3))
    means = np.einsum("n,ncd->cd", equations.weights, flow.velocity) / mesh.mesh.volume
    np.testing.assert_allclose(means, flow.permeability, atol=1e-6 * flow.permeability.max())
    assert np.linalg.eigvalsh(flow.permeability).min() > 0
    assert flow.work < 1e-6 and flow.divergence < 1e-6


def test_directions_turn_with_the_frame():
    mesh = around_a_cylinder(0.3, sides=1, rings=3)
    turned = np.array([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]])
    _, straight = flow_between_walls(mesh, np.eye(3))
    _, oblique = flow_between_walls(mesh, turned)
    np.testing.assert_allclose(straight.permeability, oblique.permeability, atol=1e-9)


def test_nodes_are_where_their_places_are():
    mesh = QuadraticMesh.straight(box((2, 1, 3), (1.0, 2.0, 3.0)))
    corners = mesh.points[mesh.nodes[:, CORNER_NODES]]
    np.testing.assert_array_equal(corners, mesh.mesh.points[mesh.mesh.hexahedra])
    middle, edges = corners.mean(axis=1, keepdims=True), np.array([0.5, 2.0, 1.0])
    np.testing.assert_allclose(mesh.points[mesh.nodes], middle + PLACES * edges / 2)


def test_a_folded_hexahedron_is_refused():
    mesh = QuadraticMesh.straight(box((2, 2, 2), (1.0, 1.0, 1.0), SLOT))
    away = np.zeros_like(mesh.points)
    away[mesh.nodes[0, 13], 2] = 0.6
    with pytest.raises(BuildError, match="folded"):
        flow_between_walls(mesh.moved(away), np.eye(3)[:2])


@pytest.mark.parametrize(
    ("periodic", "closed"),
    [
        ((True, True, True), []),
        ((True, True, False), [2]),
        ((False, True, False), [0, 2]),
        ((False,) * 3, [0, 1, 2]),
    ],
)
def test_walls_close_the_directions_across_them(periodic, closed):
    mesh = QuadraticMesh.straight(box((2, 3, 1), (1.0, 1.0, 1.0), periodic))
    np.testing.assert_array_equal(open_directions(mesh), np.delete(np.eye(3), closed, axis=0))


def test_a_channel_that_winds_is_open_along_itself_alone():
    """Of 6 x 6 squares a channel that leaves the cell upwards and to the right before it comes back to its start."""
    whole = box((6, 6, 1), (1.0, 1.0, 1.0), (True, True, False))
    drawn = ".x.... .x.... xx.xxx ...x.. .xxx.. .x....".split()[::-1]  # rows upwards
    column, row = np.divmod(np.arange(36), 6)
    channel = np.array([drawn[r][c] == "x" for c, r in zip(column, row)])
    used, corners = np.unique(whole.hexahedra[channel], return_inverse=True)
    mesh = type(whole)(
        whole.points[used], corners.reshape(-1, 8), whole.vectors, whole.origin, whole.periodic
    )
    (way,) = open_directions(QuadraticMesh.straight(mesh))
    np.testing.assert_allclose(np.abs(way), np.array([1, 1, 0]) / np.sqrt(2), atol=1e-12)
    assert way[0] * way[1] > 0


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.integers(4, 12), st.integers(1, 3))
def test_minres_solves_indefinite_systems(seed, size, loads):
    random = np.random.default_rng(seed)
    matrix = random.normal(size=(size, size))
    matrix = matrix + matrix.T + np.diag(np.where(np.arange(size) % 2, 3.0, -3.0)) * size
    weights = random.uniform(0.5, 2.0, (size, 1))
    wanted = random.normal(size=(size, loads))
    solution = solve(lambda v: matrix @ v, matrix @ wanted, lambda v: weights * v, 1e-12, 10 * size)
    np.testing.assert_allclose(solution.values, wanted, atol=1e-8)


def test_minres_tells_what_it_did_not_reach():
    matrix = np.diag([1.0, -2.0, 3.0, 5.0])
    with pytest.raises(SolverError, match="after 2 iterations the residual is"):
        solve(lambda v: matrix @ v, np.ones((4, 1)), lambda v: v, 1e-12, most=2)


def test_a_closed_space_has_no_permeability():
    mesh = QuadraticMesh.straight(box((2, 2, 2), (1.0, 1.0, 1.0), (False, False, False)))
    _, flow = flow_between_walls(mesh, open_directions(mesh))
    np.testing.assert_array_equal(flow.permeability, np.zeros((3, 3)))
