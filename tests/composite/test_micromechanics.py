"""A yarn's properties from its constituents: limits, bounds, published values; the law in any direction."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fabric_cad.composite.micromechanics import (
    elastic,
    thermal_conductivity,
    thermal_expansion,
    yarn_properties,
)
from fabric_cad.composite.substances import Constituents, Fibre, GivenYarn, Matrix
from fabric_cad.composite.transverse import (
    TransverselyIsotropic,
    expansion_strain,
    isotropic,
    second_order,
)

EPOXY = Matrix(3500.0, 0.35, 1.2, 55e-6, 0.2)
CARBON = Fibre(230e3, 15e3, 15e3, 7e3, 0.2, 1.76, -0.41e-6, 12e-6, 10.5, 1.2)
FRACTIONS = np.linspace(0.01, 0.9, 12)

moduli = st.floats(1e3, 1e6)
laws = st.builds(
    TransverselyIsotropic, moduli, moduli, moduli, st.floats(-0.1, 0.1), st.floats(-0.5, 0.5)
).filter(lambda law: law.margin > 0.05)
directions = (
    st.tuples(*[st.floats(-1, 1)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 0.1)
)
unit_vectors = directions.map(lambda v: v / np.linalg.norm(v))


def of_the_matrix(matrix):
    """A fibre made of the matrix."""
    law = matrix.law
    known = (
        matrix.density_g_cm3,
        *[matrix.expansion_per_K] * 2,
        *[matrix.conductivity_W_per_mK] * 2,
    )
    return Fibre(law.E1_MPa, law.E2_MPa, law.G12_MPa, law.G23_MPa, law.nu12, *known)


def test_fibres_of_the_matrix_make_the_matrix():
    fibre = of_the_matrix(EPOXY)
    axes = np.repeat([[0.6, 0.0, 0.8]], len(FRACTIONS), axis=0)
    np.testing.assert_allclose(
        elastic(fibre, EPOXY, FRACTIONS).stiffness(axes),
        EPOXY.law.stiffness(axes),
        rtol=1e-13,
        atol=1e-9,
    )
    for pair, value in (
        (thermal_expansion(fibre, EPOXY, FRACTIONS), EPOXY.expansion_per_K),
        (thermal_conductivity(fibre, EPOXY, FRACTIONS), EPOXY.conductivity_W_per_mK),
    ):
        np.testing.assert_allclose(pair, np.full((2, len(FRACTIONS)), value), rtol=1e-13)


def test_a_yarn_lies_between_voigt_and_reuss():
    """Along by the mixture exactly; across between the bounds (of few fibres Chamis' root is above the upper one)."""
    fraction = np.linspace(0.3, 0.9, 13)
    law = elastic(CARBON, EPOXY, fraction)
    along, across = law.E1_MPa, law.E2_MPa
    np.testing.assert_allclose(along, fraction * 230e3 + (1 - fraction) * 3500.0)
    assert (across > 1 / (fraction / 15e3 + (1 - fraction) / 3500.0)).all()
    assert (across < fraction * 15e3 + (1 - fraction) * 3500.0).all()


def test_chamis_gives_the_worked_values():
    """V = 0.64: the square root is 0.8, so that all can be followed by hand."""
    law = elastic(CARBON, EPOXY, 0.64)
    assert law.E1_MPa == pytest.approx(0.64 * 230e3 + 0.36 * 3500)
    assert law.E2_MPa == pytest.approx(3500 / (1 - 0.8 * (1 - 3500 / 15e3)))
    assert law.G23_MPa == pytest.approx(
        1 / (0.2 * 2.7 / 3500 + 0.8 / 7e3)
    )  # 1/G = (1 - r)/Gm + r/Gf
    assert law.nu12 == pytest.approx(0.64 * 0.2 + 0.36 * 0.35)


def test_expansion_of_the_plane_strain_model():
    """With fibres of no stiffness across and no Poisson ratio, across follows from the constituents alone."""
    first, second = thermal_expansion(CARBON, EPOXY, 0.5)
    assert first == pytest.approx((230e3 * -0.41e-6 + 3500 * 55e-6) / (230e3 + 3500))
    assert 12e-6 < second < 55e-6 * 1.35


def test_the_yarns_own_constants_go_first():
    given_yarn = GivenYarn(None, 57.5e3, 18.8e3, 7.44e3, 0.25, 0.29)
    properties = yarn_properties(Constituents(EPOXY, CARBON, given_yarn), np.array([0.5, 0.6]))
    assert properties.law.E1_MPa == 57.5e3
    np.testing.assert_allclose(properties.density, [1.48, 1.536])
    assert properties.expansion is None  # of constituents that do not make this yarn


def test_without_a_fraction_nothing_follows_from_constituents():
    with pytest.raises(ValueError, match="no fibre fraction"):
        yarn_properties(Constituents(EPOXY, CARBON), None)


@given(laws)
@settings(max_examples=50)
def test_the_stiffness_is_the_inverse_of_the_compliance(law):
    e1, e2, n12, n23 = law.E1_MPa, law.E2_MPa, law.nu12, law.nu23
    compliance = np.diag(
        [1 / e1, 1 / e2, 1 / e2, 1 / law.G23_MPa, 1 / law.G12_MPa, 1 / law.G12_MPa]
    )
    compliance[[0, 0, 1, 2], [1, 2, 0, 0]] = -n12 / e1
    compliance[[1, 2], [2, 1]] = -n23 / e2
    np.testing.assert_allclose(law.stiffness(np.eye(3)[:1])[0] @ compliance, np.eye(6), atol=1e-10)


@given(laws, unit_vectors, unit_vectors)
@settings(max_examples=50)
def test_the_energy_of_a_strain_turns_with_the_axis(law, axis, other):
    """Mirror both the axis and the strain: the energy is the same."""
    mirror = np.eye(3) - 2 * np.outer(other, other)
    strain = np.array([[1.0, 0.3, -0.2], [0.3, -0.5, 0.7], [-0.2, 0.7, 0.4]])

    def energy(tensor, direction):
        voigt = np.array([*np.diag(tensor), 2 * tensor[1, 2], 2 * tensor[0, 2], 2 * tensor[0, 1]])
        return voigt @ law.stiffness(direction[None])[0] @ voigt

    assert energy(strain, axis) == pytest.approx(
        energy(mirror @ strain @ mirror.T, mirror @ axis), rel=1e-9
    )


@given(unit_vectors)
@settings(max_examples=20)
def test_an_isotropic_law_has_no_direction(axis):
    law = isotropic(3500.0, 0.35)
    np.testing.assert_allclose(
        law.stiffness(axis[None]), law.stiffness(np.eye(3)[:1]), rtol=1e-12, atol=1e-9
    )


@given(unit_vectors)
@settings(max_examples=20)
def test_a_direction_sees_its_own_expansion_and_conductivity(axis):
    xx, yy, zz, yz, xz, xy = expansion_strain(1e-6, 3e-5, axis[None])[0]
    tensor = np.array([[xx, xy / 2, xz / 2], [xy / 2, yy, yz / 2], [xz / 2, yz / 2, zz]])
    np.testing.assert_allclose(tensor @ axis, 1e-6 * axis, atol=1e-15)
    np.testing.assert_allclose(
        np.linalg.eigvalsh(second_order(10.0, 1.0, axis[None])[0]), [1, 1, 10], rtol=1e-12
    )
