"""Properties of a yarn from those of fibre and matrix, for any number of fibre volume fractions V at once.

Elastic constants and conductivity across: C. C. Chamis, *Simplified composite micromechanics
equations for hygral, thermal and mechanical properties*, SAMPE Quarterly 15 (1984) 14-23;
expansion: R. A. Schapery,
*Thermal expansion coefficients of composite materials based on energy principles*, Journal of
Composite Materials 2 (1968) 380-404, with the fibre's own two coefficients.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .substances import Constituents, Fibre, Matrix
from .transverse import Numbers, TransverselyIsotropic

METHOD = "Chamis 1984 (elastic constants, conductivity), Schapery 1968 (expansion)"

Pair = tuple[Numbers, Numbers]
"""A property along and across the fibres."""


@dataclass(frozen=True, eq=False)
class YarnProperties:
    """A yarn at fibre fractions (n,): its law, density g/cm3, expansion (along, across) 1/K, conductivity W/(m K).

    None where a constituent's is not known.
    """

    law: TransverselyIsotropic
    density: Numbers | None
    expansion: Pair | None
    conductivity: Pair | None


def yarn_properties(constituents: Constituents, fraction: np.ndarray | None) -> YarnProperties:
    """Properties of the yarn at fibre fractions ``fraction`` (n,), None where there is none to be known.

    The yarn's own constants, where they are given, go before those of micromechanics.
    """
    fibre, matrix, given = constituents.fibre, constituents.matrix, constituents.yarn
    law = given.law
    expansion: Pair | None = _pair(given.expansion_1_per_K, given.expansion_2_per_K)
    conductivity: Pair | None = _pair(given.conductivity_1_W_per_mK, given.conductivity_2_W_per_mK)
    density: Numbers | None = given.density_g_cm3
    if fibre is None or fraction is None:
        if law is None:
            raise ValueError("no fibre fraction is given, nor are the yarn's own constants")
        return YarnProperties(law, density, expansion, conductivity)

    if law is None:
        law = elastic(fibre, matrix, fraction)
        expansion = expansion or thermal_expansion(fibre, matrix, fraction)

    return YarnProperties(
        law,
        mixed(fibre.density_g_cm3, matrix.density_g_cm3, fraction) if density is None else density,
        expansion,
        conductivity or thermal_conductivity(fibre, matrix, fraction),
    )


def elastic(fibre: Fibre, matrix: Matrix, fraction: Numbers) -> TransverselyIsotropic:
    """Elastic constants of a yarn, MPa (Chamis 1984)."""
    shear = matrix.law.G12_MPa
    e2 = _across(fibre.E2_MPa, matrix.E_MPa, fraction)
    g23 = _across(fibre.G23_MPa, shear, fraction)
    return TransverselyIsotropic(
        E1_MPa=fraction * fibre.E1_MPa + (1 - fraction) * matrix.E_MPa,
        E2_MPa=e2,
        G12_MPa=_across(fibre.G12_MPa, shear, fraction),
        nu12=fraction * fibre.nu12 + (1 - fraction) * matrix.nu,
        nu23=e2 / (2 * g23) - 1,
    )


def thermal_expansion(fibre: Fibre, matrix: Matrix, fraction: Numbers) -> Pair | None:
    """Expansion along and across a yarn, 1/K (Schapery 1968).

    None where a constituent's is not known.
    """
    first, second, matrix_own = (
        fibre.expansion_1_per_K,
        fibre.expansion_2_per_K,
        matrix.expansion_per_K,
    )
    if first is None or second is None or matrix_own is None:
        return None

    law = elastic(fibre, matrix, fraction)
    along = (
        fraction * fibre.E1_MPa * first + (1 - fraction) * matrix.E_MPa * matrix_own
    ) / law.E1_MPa
    drawn = fraction * (second + fibre.nu12 * first) + (1 - fraction) * (1 + matrix.nu) * matrix_own

    return along, drawn - law.nu12 * along


def thermal_conductivity(fibre: Fibre, matrix: Matrix, fraction: Numbers) -> Pair | None:
    """Conductivity along (mixture) and across (Chamis 1984) a yarn, W/(m K).

    None where one is not known.
    """
    first, second, own = (
        fibre.conductivity_1_W_per_mK,
        fibre.conductivity_2_W_per_mK,
        matrix.conductivity_W_per_mK,
    )
    if first is None or second is None or own is None:
        return None

    root = np.sqrt(fraction)
    return fraction * first + (1 - fraction) * own, (1 - root) * own + root * _across(
        second, own, fraction
    )


def mixed(fibre: float | None, matrix: float | None, fraction: Numbers) -> Numbers | None:
    """The mean by volume; None where one of both is not known."""
    return None if fibre is None or matrix is None else fraction * fibre + (1 - fraction) * matrix


def _across(fibre: float, matrix: Numbers, fraction: Numbers) -> Numbers:
    """Chamis' modulus across the fibres: P_m / (1 - sqrt(V) (1 - P_m / P_f))."""
    return matrix / (1 - np.sqrt(fraction) * (1 - matrix / fibre))


def _pair(first: float | None, second: float | None) -> tuple[float, float] | None:
    return None if first is None or second is None else (first, second)
