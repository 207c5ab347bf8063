"""What a composite is made of: fibre, matrix, and what is said of the yarn itself."""

# ruff: noqa: N815 (fields are called as the keys of the file; K is kelvin)
from __future__ import annotations

from dataclasses import dataclass

from ..model.plausibility import DENSEST
from .transverse import TransverselyIsotropic, isotropic

CLOSEST_PACKING = DENSEST
"""Fibre volume fraction of round fibres that touch in a hexagonal array, 0.9069: the most there is."""


@dataclass(frozen=True)
class Fibre:
    """A fibre: moduli MPa, axis 1 its own.

    Density g/cm3, expansion 1/K, conductivity W/(m K), None: not known.
    """

    E1_MPa: float
    E2_MPa: float
    G12_MPa: float
    G23_MPa: float
    nu12: float
    density_g_cm3: float | None = None
    expansion_1_per_K: float | None = None
    expansion_2_per_K: float | None = None
    conductivity_1_W_per_mK: float | None = None
    conductivity_2_W_per_mK: float | None = None
    name: str = ""
    source: str = ""

    @property
    def law(self) -> TransverselyIsotropic:
        """Its elasticity."""
        nu23 = self.E2_MPa / (2 * self.G23_MPa) - 1
        return TransverselyIsotropic(self.E1_MPa, self.E2_MPa, self.G12_MPa, self.nu12, nu23)


@dataclass(frozen=True)
class Matrix:
    """What fills the space between yarns and fibres, isotropic; units as of :class:`Fibre`."""

    E_MPa: float
    nu: float
    density_g_cm3: float | None = None
    expansion_per_K: float | None = None
    conductivity_W_per_mK: float | None = None
    name: str = ""
    source: str = ""

    @property
    def law(self) -> TransverselyIsotropic:
        """Its elasticity."""
        return isotropic(self.E_MPa, self.nu)


@dataclass(frozen=True)
class GivenYarn:
    """What is said of the yarn itself: its fibre fraction, and its constants where no micromechanics shall give them.

    Units as of :class:`Fibre`; ``own_fraction`` is True where the fraction is given for one row
    alone; ``fibre_weight_fraction`` is the share of a linear density that is fibre, less than 1 in
    commingled yarns.
    """

    fibre_fraction: float | None = None
    E1_MPa: float | None = None
    E2_MPa: float | None = None
    G12_MPa: float | None = None
    nu12: float | None = None
    nu23: float | None = None
    density_g_cm3: float | None = None
    expansion_1_per_K: float | None = None
    expansion_2_per_K: float | None = None
    conductivity_1_W_per_mK: float | None = None
    conductivity_2_W_per_mK: float | None = None
    name: str = ""
    source: str = ""
    own_fraction: bool = False
    fibre_weight_fraction: float = 1.0

    @property
    def law(self) -> TransverselyIsotropic | None:
        """Its elasticity, None where it is to follow from fibre and matrix."""
        constants = [getattr(self, key) for key in ELASTIC]
        return None if None in constants else TransverselyIsotropic(*constants)


@dataclass(frozen=True)
class Constituents:
    """Fibre, matrix and yarn of one row; ``fibre`` may be None where the yarn's own constants are given.

    ``path`` is the file they were read from.
    """

    matrix: Matrix
    fibre: Fibre | None = None
    yarn: GivenYarn = GivenYarn()
    path: str = ""


ELASTIC = ("E1_MPa", "E2_MPa", "G12_MPa", "nu12", "nu23")
"""The yarn's own elastic constants: all of them or none."""
