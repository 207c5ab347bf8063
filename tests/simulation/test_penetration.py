"""How deep yarns lie inside one another: boxes of known overlap, and cells whose yarns only touch."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from meshes import HEIGHT, LENGTH, WIDTH, box, together
from scipy.spatial.transform import Rotation

from fabric_cad.cell.pipeline import find_row, make_cell
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.simulation.isoparametric import distance_to_quads, inside_hexahedra
from fabric_cad.simulation.penetration import kind_of, penetration
from fabric_cad.support.series import valid_until
from fabric_cad.weave.bodies import Body
from fabric_cad.weave.directions import Direction

WEFT, SECOND, WARP = map(Body.named, ("weft_1", "weft_2", "warp_1"))

SEEDS = st.integers(0, 2**32 - 1)


def warp(x=0.0, y=0.0, depth=0.0, turn=0.0):
    """A warp on top of a weft in the middle, ``depth`` into it."""
    return box("warp_1", (x, y, HEIGHT - depth), np.pi / 2 + turn)


@settings(max_examples=50, deadline=None)
@given(SEEDS)
def test_boxes_overlap_by_what_they_were_pushed(seed):
    rng = np.random.default_rng(seed)
    depth = float(np.exp(rng.uniform(np.log(1e-6), np.log(HEIGHT / 2))))
    mesh = together(box("weft_1"), warp(*rng.uniform(-0.2, 0.2, 2), depth, rng.uniform(-0.5, 0.5)))
    points = Rotation.random(random_state=rng).apply(mesh.points) + rng.uniform(-5, 5, 3)
    found = penetration(mesh, points)
    assert found.depth == pytest.approx(depth, rel=1e-6)
    assert {found.first, found.second} == {WEFT, WARP}
    assert found.by_pair == {(WEFT, WARP): found.depth}
    assert (found.deepest("crossing"), found.deepest("parallel")) == (found.depth, 0.0)
    assert np.linalg.norm(points - found.place, axis=1).min() < 0.5


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_boxes_that_touch_or_part_do_not_overlap(seed):
    rng = np.random.default_rng(seed)
    turned = Rotation.random(random_state=rng)
    for gap in (0.0, 1e-6, 0.1):
        mesh = together(
            box("weft_1"), warp(*rng.uniform(-0.2, 0.2, 2), -gap, rng.uniform(-0.5, 0.5))
        )
        found = penetration(mesh, turned.apply(mesh.points))
        assert found.depth < 1e-14
        if gap:
            assert (found.depth, found.first, found.second) == (0.0, None, None) and np.isnan(
                found.place
            ).all()


@pytest.mark.parametrize("shear", [0.0, 0.2])
def test_neighbours_meet_across_the_border_of_the_cell(shear):
    period = np.array([[LENGTH, 0.0, 0.0], [shear, 2 * WIDTH + 0.9, 0.0]])
    mesh = together(box("weft_1"), box("weft_2", (shear, WIDTH + 1.0, 0.0)))
    assert penetration(mesh, mesh.points).depth == 0
    found = penetration(mesh, mesh.points, period)
    assert found.depth == pytest.approx(0.1)
    assert found.by_pair == {(WEFT, WEFT): 0, (WEFT, SECOND): found.depth, (SECOND, SECOND): 0}
    assert found.deepest("parallel") == found.depth and found.deepest("crossing") == 0


def test_a_lone_yarn_meets_its_own_image_beside_it_but_not_its_continuation():
    mesh = box("weft_1")
    period = np.array([[LENGTH, 0.0, 0.0], [0.0, WIDTH - 0.05, 0.0]])
    found = penetration(mesh, mesh.points, period)
    assert found.depth == pytest.approx(0.05)
    assert (found.first, found.second) == (WEFT, WEFT)
    assert penetration(mesh, mesh.points, period * [[1], [2]]).depth == 0


def test_a_yarn_goes_on_beyond_the_cell():
    """A warp over the border: as deep in the weft's continuation as in the weft, whose end does not bound it."""
    period = np.array([[LENGTH, 0.0, 0.0], [0.0, 2 * LENGTH, 0.0]])
    for x in (LENGTH / 2, LENGTH / 2 + WIDTH / 2 + 0.1, -LENGTH / 2 - WIDTH / 2 - 0.1):
        mesh = together(box("weft_1"), warp(x, 0.0, 0.2))
        assert penetration(mesh, mesh.points, period).depth == pytest.approx(0.2)
    assert penetration(mesh, mesh.points).depth == 0


@pytest.mark.parametrize(
    ("points", "period", "message"),
    [
        (np.zeros((3, 3)), None, r"points has shape \(3, 3\), not \(189, 3\)"),
        (np.full((189, 3), np.nan), None, "points holds a value that is not finite"),
        (np.zeros((189, 3)), np.zeros((3, 3)), r"period has shape \(3, 3\), not \(2, 3\)"),
    ],
)
def test_arrays_are_checked(points, period, message):
    with pytest.raises(ValueError, match=message):
        penetration(box("weft_1"), points, period)


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_places_inside_distorted_hexahedra_are_found(seed):
    rng = np.random.default_rng(seed)
    mesh = box("weft_1", parts=(1, 1, 1))
    corners = (mesh.points * rng.uniform(0.2, 5.0, 3))[mesh.hexahedra] + np.zeros((200, 1, 1))
    corners = corners + rng.uniform(-0.15, 0.15, corners.shape) * np.ptp(corners, axis=1)[:, None]
    at = rng.uniform(-1, 1, (200, 3))
    at[::2, 0] = rng.choice([-1, 1], 100)  # on a face
    signs = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]])
    signs = np.vstack([signs, signs * [1, 1, -1]])

    def place(natural):
        return np.einsum("nc,ncd->nd", np.prod((1 + signs * natural[:, None]) / 2, axis=2), corners)

    assert inside_hexahedra(place(at), corners).all()
    at[:, 1] = rng.choice([-1, 1], 200) * 1.0001
    assert not inside_hexahedra(place(at), corners).any()
    assert not inside_hexahedra(place(at) + 100.0, corners).any()


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_distance_to_warped_quadrilaterals(seed):
    rng = np.random.default_rng(seed)
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    corners = square + rng.uniform(-0.15, 0.15, (20, 4, 3))
    points = rng.uniform(-1, 2, (20, 3)) * [1, 1, 0.5]
    s, t = (each.reshape(-1, 1) for each in np.meshgrid(*2 * [np.linspace(0, 1, 201)]))
    weights = np.hstack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
    sampled = np.linalg.norm(
        np.einsum("sc,ncd->nsd", weights, corners) - points[:, None], axis=2
    ).min(axis=1)
    found = distance_to_quads(points, corners)
    assert (found <= sampled + 1e-12).all()
    # half a step of the grid is at most 0.005 of such a quadrilateral away from the nearest place
    assert (sampled**2 <= found**2 + 1e-4).all()
    assert (distance_to_quads(corners[:, 2], corners) == 0).all()
    assert distance_to_quads(corners.mean(axis=1), corners).max() < 1e-15


def test_state_up_to_which_contact_is_valid():
    angles, depths = [0.0, 5.0, 10.0], [0.0, 0.01, 0.03]
    assert valid_until(angles, depths, 0.02) == pytest.approx(7.5)
    assert valid_until(angles, depths, 0.01) == pytest.approx(5.0)
    assert valid_until(angles, depths, 0.05) == 10.0
    assert valid_until(angles, [0.1, 0.2, 0.3], 0.05) == 0.0


def test_kinds_of_pairs():
    assert kind_of((WEFT, WARP)) == "crossing"
    assert kind_of((WEFT, SECOND)) == kind_of((WARP, WARP)) == "parallel"


@pytest.fixture(scope="module", params=["plain", "plain_flat", "plain_round", "twill22_chords"])
def cell(request, tmp_path_factory):
    from fabric_cad.meshing import read_mesh

    out = tmp_path_factory.mktemp("cells")
    make_cell(find_row(shipped_families(), request.param)[0], out)
    mesh = read_mesh(out / request.param / f"{request.param}.msh")
    return mesh, np.diag(np.ptp(mesh.points, axis=0))[:2]


def test_yarns_of_a_cell_touch_and_do_not_penetrate(cell):
    mesh, period = cell
    assert penetration(mesh, mesh.points, period).depth < 1e-12
    # an affine shear keeps faces that coincide together: there is nothing to find
    sheared = np.array([[1.0, 0.1, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 1.0]])
    assert penetration(mesh, mesh.points @ sheared, period @ sheared).depth < 1e-12


def test_wefts_moved_down_lie_in_the_warps_below_them(cell):
    mesh, period = cell
    wefts = [n for n, yarn in enumerate(mesh.bodies) if yarn.direction is Direction.WEFT]
    points = mesh.points.copy()
    points[np.unique(mesh.hexahedra[np.isin(mesh.body, wefts)]), 2] -= 0.01
    found = penetration(mesh, points, period)
    assert found.depth == pytest.approx(0.01, rel=0.01)
    assert found.deepest("crossing") == found.depth and found.deepest("parallel") < 1e-12


def test_numbering_of_yarns_does_not_matter(cell):
    mesh, period = cell
    points = mesh.points + np.random.default_rng(1).normal(scale=0.003, size=mesh.points.shape)
    back = replace(mesh, body=len(mesh.bodies) - 1 - mesh.body, bodies=mesh.bodies[::-1])
    one, other = penetration(mesh, points, period), penetration(back, points, period)
    assert one.depth == other.depth > 0 and {one.first, one.second} == {other.first, other.second}
    assert {frozenset(pair): depth for pair, depth in one.by_pair.items()} == {
        frozenset(pair): depth for pair, depth in other.by_pair.items()
    }
