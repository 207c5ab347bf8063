"""Periodic homogenisation against what is known exactly: one material, laminates, bounds, symmetries."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fabric_cad.composite.homogenisation.elements import Elements
from fabric_cad.composite.homogenisation.homogenise import (
    PLATE_STRAINS,
    UNIT_STRAINS,
    Materials,
    constants,
    homogenise,
    homogenise_plate,
)
from fabric_cad.composite.homogenisation.periodicity import PeriodicMesh
from fabric_cad.composite.homogenisation.response import mean_strains
from fabric_cad.composite.transverse import (
    TransverselyIsotropic,
    expansion_strain,
    isotropic,
    second_order,
)
from fabric_cad.support.errors import BuildError, SolverError

YARN = TransverselyIsotropic(151e3, 10.1e3, 5.7e3, 0.24, 0.5)
RESIN = isotropic(3500.0, 0.35)
CORNERS = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
)


def box(counts, size, periodic=(True, True, True), wobble=0.0):
    """Hexahedra of a box, ``counts`` along its edges; inner nodes moved by up to ``wobble`` of an element."""
    grid = np.stack(np.meshgrid(*(np.arange(n + 1) for n in counts), indexing="ij"), axis=-1)
    number = np.arange(grid[..., 0].size).reshape(grid.shape[:3])
    inner = ((grid > 0) & (grid < counts)).all(axis=-1, keepdims=True)
    moved = grid + inner * np.random.default_rng(3).uniform(-wobble, wobble, grid.shape)
    corners = [
        number[tuple(slice(s, s + n) for s, n in zip(shift, counts))].ravel() for shift in CORNERS
    ]
    points = moved.reshape(-1, 3) * np.array(size) / counts
    return PeriodicMesh(
        points, np.stack(corners, axis=1), np.diag(np.array(size, float)), np.zeros(3), periodic
    )


def centres(mesh):
    return mesh.points[mesh.hexahedra].mean(axis=1)


def spots(mesh, shift=(0, 0, 0)):
    """A woven-like field: fibres along x, along y, and resin, in blocks that repeat with the cell."""
    share = (centres(mesh) / np.diag(mesh.vectors) + np.array(shift)) % 1.0
    x, y, z = (share * 4).astype(int).T
    along_x, along_y = (y % 2 == 0) & (z < 2), (x % 2 == 0) & (z >= 2)
    axes = np.where(along_x[:, None], [[1.0, 0, 0]], [[0, 1.0, 0]])
    yarn = along_x | along_y
    stiffness = np.where(yarn[:, None, None], YARN.stiffness(axes), RESIN.stiffness(axes))
    expansion = np.where(
        yarn[:, None], expansion_strain(-0.3e-6, 30e-6, axes), expansion_strain(55e-6, 55e-6, axes)
    )
    conductivity = np.where(
        yarn[:, None, None], second_order(7.0, 0.6, axes), second_order(0.2, 0.2, axes)
    )
    return Materials(stiffness, expansion, conductivity, np.where(yarn, 1.6, 1.2))


@pytest.fixture(scope="module")
def woven():
    mesh = box((8, 8, 8), (2.0, 2.0, 0.5))
    return mesh, spots(mesh), homogenise(mesh, spots(mesh))


def test_one_material_is_itself_on_any_mesh():
    mesh = box((4, 3, 3), (1.0, 2.0, 0.1), wobble=0.2)
    axes = np.repeat([[0.48, 0.64, 0.6]], len(mesh.hexahedra), axis=0)
    one = Materials(
        YARN.stiffness(axes),
        expansion_strain(1e-6, 3e-5, axes),
        second_order(7.0, 0.6, axes),
        np.full(len(axes), 1.5),
    )
    effective = homogenise(mesh, one)
    scale = one.stiffness[0].max()
    for found in (effective.stiffness, effective.voigt, effective.reuss):
        np.testing.assert_allclose(found, one.stiffness[0], atol=1e-12 * scale)
    np.testing.assert_allclose(effective.expansion, one.expansion[0], atol=1e-12 * 3e-5)
    np.testing.assert_allclose(effective.conductivity, one.conductivity[0], atol=1e-12 * 7)
    assert effective.density == pytest.approx(1.5, rel=1e-12)


def test_symmetry_and_bounds(woven):
    _, _, effective = woven
    assert effective.response.asymmetry < 1e-8
    np.testing.assert_allclose(
        effective.stiffness, effective.stiffness.T, atol=1e-8 * effective.stiffness.max()
    )
    for lower, upper in (
        (effective.reuss, effective.stiffness),
        (effective.stiffness, effective.voigt),
    ):
        assert np.linalg.eigvalsh(upper - lower).min() > 0
    np.testing.assert_allclose(
        effective.conductivity, effective.conductivity.T, rtol=1e-8, atol=1e-12
    )


def test_the_energy_of_the_total_field_is_that_of_the_effective_material(woven):
    mesh, materials, effective = woven
    load = np.array([1.0, -0.4, 0.3, 0.2, 0.5, -0.7])
    moved = effective.response.fluctuations @ load
    energy = 0.0
    for chunk in Elements(mesh).chunks():
        gradient = np.einsum("nqaj,nai->nqij", chunk.gradients, moved[chunk.corners])
        strain = load + np.stack(
            [
                gradient[..., i, j] + (gradient[..., j, i] if i != j else 0)
                for i, j in zip((0, 1, 2, 1, 0, 0), (0, 1, 2, 2, 2, 1))
            ],
            axis=-1,
        )
        energy += np.einsum(
            "nq,nqi,nij,nqj->", chunk.weights, strain, materials.stiffness[chunk.elements], strain
        )
    assert energy / mesh.volume == pytest.approx(load @ effective.stiffness @ load, rel=1e-10)


def test_the_mean_stress_is_the_effective_one(woven):
    mesh, materials, effective = woven
    weights = effective.response.integrals.volumes[0]
    for load in range(6):
        strain = mean_strains(effective.response, UNIT_STRAINS, load)
        np.testing.assert_allclose(weights @ strain / mesh.volume, np.eye(6)[load], atol=1e-12)
        stress = weights @ np.einsum("nij,nj->ni", materials.stiffness, strain) / mesh.volume
        np.testing.assert_allclose(
            stress, effective.stiffness[load], atol=1e-6 * effective.stiffness.max()
        )


def test_the_cell_may_be_cut_anywhere(woven):
    mesh, _, effective = woven
    for shift in ((0.5, 0, 0), (0.5, 0.5, 0), (0, 0, 0.5)):
        moved = homogenise(mesh, spots(mesh, shift))
        np.testing.assert_allclose(
            moved.stiffness, effective.stiffness, atol=1e-8 * effective.stiffness.max()
        )
        np.testing.assert_allclose(moved.expansion, effective.expansion, atol=1e-8 * 55e-6)
        np.testing.assert_allclose(moved.conductivity, effective.conductivity, atol=1e-8 * 7)


def test_the_cell_may_be_turned_by_90_degrees(woven):
    mesh, materials, effective = woven
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    turned = PeriodicMesh(
        mesh.points @ turn.T, mesh.hexahedra, np.diag([2.0, 2.0, 0.5]), np.array([-2.0, 0, 0])
    )
    # xx and yy change places; yz and xz too, one with its sign
    order, signs = [1, 0, 2, 4, 3, 5], np.array([1, 1, 1, 1, -1, -1.0])
    stiffness = materials.stiffness[:, order][:, :, order] * np.outer(signs, signs)
    found = homogenise(turned, Materials(stiffness)).stiffness
    expected = effective.stiffness[order][:, order] * np.outer(signs, signs)
    np.testing.assert_allclose(found, expected, atol=1e-9 * expected.max())


def test_oblique_periods_give_the_same_material():
    """A laminate along z may be cut into a sheared cell: it is the same laminate."""
    straight = box((3, 3, 6), (1.0, 1.0, 0.6))
    slant = np.array([[1.0, 0, 0], [0.5, 1.0, 0], [0, 0, 1.0]])
    sheared = PeriodicMesh(
        straight.points @ slant, straight.hexahedra, straight.vectors @ slant, straight.origin
    )
    materials = layers(straight, [0.0, 90.0])
    np.testing.assert_allclose(
        homogenise(sheared, materials).stiffness,
        homogenise(straight, materials).stiffness,
        atol=1e-9 * 151e3,
    )


def layers(mesh, angles):
    """Layers of equal thickness with fibres at angles (degrees) in the plane."""
    share = (centres(mesh)[:, 2] - mesh.origin[2]) / mesh.vectors[2, 2]
    angle = np.radians(np.array(angles))[(share * len(angles)).astype(int)]
    axes = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))])
    return Materials(
        YARN.stiffness(axes), expansion_strain(-0.3e-6, 30e-6, axes), second_order(7.0, 0.6, axes)
    )


def laminate(stiffnesses):
    """Stiffness (6, 6) of many thin layers: in-plane strains and out-of-plane stresses are those of every layer.

    G. Backus, Journal of Geophysical Research 67 (1962) 4427-4440, for any symmetry.
    """
    inner, outer = [0, 1, 5], [2, 3, 4]
    means = [np.zeros((3, 3)) for _ in range(3)]
    for c in stiffnesses:
        compliance = np.linalg.inv(c[np.ix_(outer, outer)])
        coupling = c[np.ix_(inner, outer)] @ compliance
        parts = (c[np.ix_(inner, inner)] - coupling @ c[np.ix_(outer, inner)], coupling, compliance)
        means = [mean + part / len(stiffnesses) for mean, part in zip(means, parts)]
    plane, coupling, compliance = means
    through = np.linalg.inv(compliance)
    found = np.empty((6, 6))
    found[np.ix_(inner, inner)] = plane + coupling @ through @ coupling.T
    found[np.ix_(inner, outer)] = coupling @ through
    found[np.ix_(outer, inner)] = through @ coupling.T
    found[np.ix_(outer, outer)] = through
    return found


@given(st.lists(st.floats(-90, 90), min_size=1, max_size=4))
@settings(max_examples=10, deadline=None)
def test_a_laminate_is_that_of_lamination_theory(angles):
    mesh = box((2, 2, 2 * len(angles)), (1.0, 1.0, 0.3))
    materials = layers(mesh, angles)
    effective = homogenise(mesh, materials)
    expected = laminate(
        materials.stiffness[: 2 * len(angles) : 2]
    )  # one column of elements, layer by layer
    np.testing.assert_allclose(effective.stiffness, expected, atol=1e-9 * expected.max())
    k = materials.conductivity[: 2 * len(angles) : 2]
    np.testing.assert_allclose(effective.conductivity[:2, :2], k.mean(axis=0)[:2, :2], atol=1e-10)
    assert effective.conductivity[2, 2] == pytest.approx(0.6, rel=1e-10)


def test_free_expansion_of_a_cross_ply_laminate():
    """Both layers strain alike and their stresses cancel: solved by hand in the plane."""
    mesh = box((2, 2, 4), (1.0, 1.0, 0.3))
    effective = homogenise(mesh, layers(mesh, [0.0, 90.0]))
    q11 = YARN.E1_MPa / (1 - YARN.nu12**2 * YARN.E2_MPa / YARN.E1_MPa)
    q22 = q11 * YARN.E2_MPa / YARN.E1_MPa
    q12 = YARN.nu12 * q22
    expected = ((q11 + q12) * -0.3e-6 + (q22 + q12) * 30e-6) / (q11 + q22 + 2 * q12)
    np.testing.assert_allclose(effective.expansion[:2], expected, rtol=1e-8)
    np.testing.assert_allclose(effective.expansion[3:], 0, atol=1e-14)


def plane_stiffness(angle):
    """Plane-stress stiffness (3, 3) in xx, yy, xy of a layer at an angle (degrees)."""
    axis = np.array([[np.cos(np.radians(angle)), np.sin(np.radians(angle)), 0.0]])
    compliance = np.linalg.inv(YARN.stiffness(axis)[0])
    return np.linalg.inv(compliance[np.ix_([0, 1, 5], [0, 1, 5])])


@pytest.mark.parametrize("angles", [[0.0], [0.0, 90.0], [30.0, -30.0], [0.0, 45.0, 90.0]])
def test_a_plate_is_that_of_lamination_theory(angles):
    """A and B need one element a layer; bending is quadratic through a layer, and D comes nearer with its square."""
    edges = np.linspace(-0.3, 0.3, len(angles) + 1)
    layered = [plane_stiffness(angle) for angle in angles]
    a, b, d = (
        sum(
            q * (top**power - floor**power) / power
            for q, floor, top in zip(layered, edges, edges[1:])
        )
        for power in (1, 2, 3)
    )
    errors = []
    for through in (2, 4):
        mesh = box((2, 2, through * len(angles)), (1.0, 1.0, 0.6), periodic=(True, True, False))
        plate = homogenise_plate(mesh, layers(mesh, angles))
        np.testing.assert_allclose(plate.A, a, atol=1e-9 * a.max())
        np.testing.assert_allclose(plate.B, b, atol=1e-9 * a.max() * 0.3)
        errors.append(np.abs(plate.D - d).max() / d.max())

    assert errors[1] < 0.02
    assert errors[0] / errors[1] == pytest.approx(4, abs=0.2)
    assert plate.thickness == pytest.approx(0.6)


def test_plate_strains_are_membranes_and_curvatures():
    membrane, bent = PLATE_STRAINS
    assert membrane[:, 0].tolist() == [1, 0, 0, 0, 0, 0]
    assert bent[:, 5].tolist() == [0, 0, 0, 0, 0, 1]


def test_engineering_constants_are_read_off_the_compliance():
    found = constants(YARN.stiffness(np.eye(3)[:1])[0])
    assert found["Ex"] == pytest.approx(151e3)
    assert found["Ey"] == found["Ez"] == pytest.approx(10.1e3)
    assert found["Gxy"] == found["Gxz"] == pytest.approx(5.7e3)
    assert found["nu_xy"] == pytest.approx(0.24)
    assert found["nu_yz"] == pytest.approx(0.5)
    assert found["nu_yx"] == pytest.approx(0.24 * 10.1 / 151)


def test_faces_that_do_not_match_are_told():
    mesh = box((3, 3, 3), (1.0, 1.0, 1.0))
    points = mesh.points.copy()
    points[0, 1] += 0.01
    broken = PeriodicMesh(points, mesh.hexahedra, mesh.vectors, mesh.origin)
    with pytest.raises(BuildError, match="do not match"):
        homogenise(broken, spots(mesh))


def test_a_solver_that_does_not_converge_gives_nothing(monkeypatch):
    from fabric_cad.composite.homogenisation import response

    patient = response.solve
    monkeypatch.setattr(response, "solve", lambda *given: patient(*given, most=3))
    mesh = box((4, 4, 4), (1.0, 1.0, 1.0))
    with pytest.raises(
        SolverError, match=r"after 3 iterations the residual is \S+ of the load, above 1e-07"
    ):
        homogenise(mesh, spots(mesh))
