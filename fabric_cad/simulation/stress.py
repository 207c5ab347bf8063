"""Strain and stress of a deformed cell in the axes of its yarns, element by element.

Both are those of the yarns' law at the eight Gauss points of C3D8, averaged over an element's
volume; nothing is extrapolated to nodes, where yarns' axes and the solver's averages would mix.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..meshing.mesh import Mesh
from .energy import gauss_points
from .laws import YarnLaw

COMPONENTS = {
    "fibre": (0, 0),
    "across": (1, 1),
    "through": (2, 2),
    "fibre_across": (0, 1),
    "fibre_through": (0, 2),
    "across_through": (1, 2),
}
"""Names of a tensor's components in a yarn's axes."""

UNITS = {
    **{
        f"strain_{name}": "1 (Green's, tensor component, in the yarn's axes at rest)"
        for name in COMPONENTS
    },
    **{f"stress_{name}_MPa": "MPa (Cauchy's, in the deformed yarn's axes)" for name in COMPONENTS},
}


@dataclass(frozen=True, eq=False)
class YarnStress:
    """Means of every element, (elements, 3, 3), components in a yarn's axes: along the fibres, across, through.

    ``strain`` is Green's, in the axes at rest. ``stress`` (MPa) is Cauchy's, in the axes of the
    deformed yarn: along the deformed fibres, across in the plane that fibres and across have
    become, and normal to that plane.
    """

    strain: np.ndarray
    stress: np.ndarray

    def columns(self) -> dict[str, np.ndarray]:
        """``strain_fibre`` ... ``stress_across_through_MPa``, each (elements,).

        Strains are tensor components.
        """
        strains = {f"strain_{name}": self.strain[:, i, j] for name, (i, j) in COMPONENTS.items()}
        return strains | {
            f"stress_{name}_MPa": self.stress[:, i, j] for name, (i, j) in COMPONENTS.items()
        }


def yarn_stress(mesh: Mesh, displacement: np.ndarray, law: YarnLaw) -> YarnStress:
    """Strain and stress of every element; ``displacement`` (nodes, 3) mm.

    The second Piola-Kirchhoff stress S = C E of the law becomes Cauchy's R S R^T / J, R being the
    triangular factor of F = Q R, whose rotation Q turns the yarn's axes with its fibres; compaction
    adds the pressure H (J - 1)^3.
    """
    stiffness = np.linalg.inv(law.compliance)
    shear = {(0, 1): law.G12_MPa, (0, 2): law.G13_MPa, (1, 2): law.G23_MPa}
    count = len(mesh.hexahedra)
    volume, strain, stress = (
        np.zeros((count, 1, 1)),
        np.zeros((count, 3, 3)),
        np.zeros((count, 3, 3)),
    )

    for point in gauss_points(mesh, displacement):
        second = np.zeros_like(point.strain)
        second[:, [0, 1, 2], [0, 1, 2]] = np.einsum("eii->ei", point.strain) @ stiffness
        for (i, j), modulus in shear.items():
            second[:, i, j] = second[:, j, i] = 2 * modulus * point.strain[:, i, j]

        stretch = np.linalg.qr(point.gradient, mode="r")
        stretch *= np.sign(np.einsum("eii->ei", stretch))[:, :, None]  # Q turns, it does not mirror
        cauchy = stretch @ second @ stretch.transpose(0, 2, 1) / point.ratio[:, None, None]
        cauchy += law.hardening * ((point.ratio - 1) ** 3)[:, None, None] * np.eye(3)

        weight = point.volume[:, None, None]
        volume, strain, stress = (
            volume + weight,
            strain + weight * point.strain,
            stress + weight * cauchy,
        )

    return YarnStress(strain / volume, stress / volume)
