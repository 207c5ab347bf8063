"""Transversely isotropic elasticity: the law of a fibre and of a yarn, in any direction, whole arrays at once.

::

            3            6 x 6 matrices are in the order xx, yy, zz, yz, xz, xy, shear strains being
            |            engineering ones (twice the tensor's), so that C_IJ = C_ijkl and
            o---- 2      stress (6,) = C (6, 6) strain (6,).
           /
          1 fibres       The plane of 2 and 3 is isotropic: E3 = E2, nu13 = nu12, G13 = G12,
                         G23 = E2 / (2 (1 + nu23)).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Numbers = float | np.ndarray

FIRST, SECOND = (0, 1, 2, 1, 0, 0), (0, 1, 2, 2, 2, 1)
"""Axes of the two indices of every component: xx, yy, zz, yz, xz, xy."""

ENGINEERING = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
"""Engineering over tensor components of strain."""


@dataclass(frozen=True, eq=False)
class TransverselyIsotropic:
    """Five constants, MPa, axis 1 the fibres': numbers, or arrays (elements,) of one length."""

    E1_MPa: Numbers
    E2_MPa: Numbers
    G12_MPa: Numbers
    nu12: Numbers
    nu23: Numbers

    @property
    def G23_MPa(self) -> Numbers:  # noqa: N802 (called as in the file)
        """Shear modulus of the isotropic plane."""
        return self.E2_MPa / (2 * (1 + self.nu23))

    @property
    def margin(self) -> Numbers:
        """1 - nu23 - 2 nu12**2 E2 / E1, which is above 0 where the law is positive definite (with -1 < nu23 < 1)."""
        return 1 - self.nu23 - 2 * np.square(self.nu12) * self.E2_MPa / self.E1_MPa

    def stiffness(self, axes: np.ndarray) -> np.ndarray:
        """Stiffness (elements, 6, 6), MPa, with the fibres along the unit vectors ``axes`` (elements, 3).

        By the five invariants of A. J. M. Spencer, *Constitutive theory for strongly anisotropic
        solids* (1984), Eq. 31, which need no axis across the fibres.
        """
        c11 = self.E1_MPa * (1 - self.nu23) / self.margin
        c12 = self.nu12 * self.E2_MPa / self.margin
        shear = self.G23_MPa
        volume = self.E2_MPa / (2 * self.margin) - shear  # C23
        coupling = c12 - volume
        along = c11 - volume - 2 * coupling - 4 * self.G12_MPa + 2 * shear

        axis = np.asarray(axes, dtype=float)
        dyad = axis[:, FIRST] * axis[:, SECOND]
        one = (np.arange(6) < 3).astype(float)
        trace = one[:, None] * one

        def spread(values: Numbers) -> np.ndarray:
            return np.broadcast_to(np.asarray(values, dtype=float), len(axis))[:, None, None]

        stiffness = spread(volume) * trace + spread(shear) * np.diag(2 / ENGINEERING)
        stiffness += spread(coupling) * (one[:, None] * dyad[:, None] + dyad[..., None] * one)
        stiffness += spread(along) * (dyad[..., None] * dyad[:, None])
        stiffness += spread(self.G12_MPa - shear) * _along_the_axis(axis)
        return stiffness


def isotropic(E_MPa: float, nu: float) -> TransverselyIsotropic:  # noqa: N803 (called as in the file)
    """An isotropic law as a transversely isotropic one."""
    return TransverselyIsotropic(E_MPa, E_MPa, E_MPa / (2 * (1 + nu)), nu, nu)


def expansion_strain(along: Numbers, across: Numbers, axes: np.ndarray) -> np.ndarray:
    """Strain (elements, 6) per kelvin, of coefficients along and across the unit vectors ``axes`` (elements, 3)."""
    tensor = second_order(along, across, axes)
    return tensor[:, FIRST, SECOND] * ENGINEERING


def second_order(along: Numbers, across: Numbers, axes: np.ndarray) -> np.ndarray:
    """Tensors (elements, 3, 3): ``along`` in the direction of ``axes`` (elements, 3), ``across`` normal to it."""
    axis = np.asarray(axes, dtype=float)
    inner, outer = (
        np.broadcast_to(np.asarray(v, dtype=float), len(axis))[:, None, None]
        for v in (along, across)
    )
    return outer * np.eye(3) + (inner - outer) * axis[:, :, None] * axis[:, None, :]


def _along_the_axis(axis: np.ndarray) -> np.ndarray:
    """Matrices (elements, 6, 6) of n_i n_k d_jl + n_i n_l d_jk + d_ik n_j n_l + d_il n_j n_k."""
    i, j = np.array(FIRST)[:, None], np.array(SECOND)[:, None]
    k, l = np.array(FIRST), np.array(SECOND)  # noqa: E741 (the indices' usual names)
    dyad, same = axis[:, :, None] * axis[:, None, :], np.eye(3)
    return (
        dyad[:, i, k] * same[j, l]
        + dyad[:, i, l] * same[j, k]
        + same[i, k] * dyad[:, j, l]
        + same[i, l] * dyad[:, j, k]
    )
