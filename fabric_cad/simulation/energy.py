"""Energy of a deformed cell, integrated over its elements.

The solver's own sum grows with every increment it takes and so depends on them; this one is of the
state alone, by the 2 x 2 x 2 Gauss points of C3D8.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..meshing.hexahedron import GAUSS_POINTS, shape_slopes
from ..meshing.mesh import Mesh
from .laws import YarnLaw


@dataclass(frozen=True)
class Energy:
    """``strain`` N mm of all yarns, and the least volume ratio det F at any point: 0 or less is inside out."""

    strain: float
    least_volume_ratio: float


@dataclass(frozen=True, eq=False)
class Point:
    """One Gauss point of every element, in the axes of the yarns at rest: along the fibres, across, through.

    ``volume`` (elements,) mm3 that it stands for, at rest; ``gradient`` (elements, 3, 3) F of the
    deformation; ``strain`` (elements, 3, 3) Green's; ``ratio`` (elements,) det F.
    """

    volume: np.ndarray
    gradient: np.ndarray
    strain: np.ndarray
    ratio: np.ndarray


def gauss_points(mesh: Mesh, displacement: np.ndarray) -> Iterator[Point]:
    """The eight Gauss points of C3D8; ``displacement`` (nodes, 3) mm."""
    fibre, across = mesh.fibre_axes(), mesh.across_axes()
    axes = np.stack([fibre, across, np.cross(fibre, across)], axis=1)
    places, moved = mesh.points[mesh.hexahedra], displacement[mesh.hexahedra]
    for point in GAUSS_POINTS:
        slopes = shape_slopes(point)
        jacobian = np.einsum("eni,nj->eij", places, slopes)
        change = np.einsum("eni,nj,ejk->eik", moved, slopes, np.linalg.inv(jacobian), optimize=True)
        gradient = np.eye(3) + np.einsum("eai,eij,ebj->eab", axes, change, axes, optimize=True)
        green = (np.einsum("eki,ekj->eij", gradient, gradient) - np.eye(3)) / 2
        yield Point(np.linalg.det(jacobian), gradient, green, np.linalg.det(gradient))


def cell_energy(mesh: Mesh, displacement: np.ndarray, law: YarnLaw) -> Energy:
    """Energy of the yarns' law, S = C E of Green's strain plus its compaction.

    ``displacement`` (nodes, 3) mm.
    """
    stiffness = np.linalg.inv(law.compliance)
    total, least = 0.0, np.inf

    for point in gauss_points(mesh, displacement):
        normal = np.einsum("eii->ei", point.strain)
        density = np.einsum("ei,ij,ej->e", normal, stiffness, normal, optimize=True) / 2
        for (i, j), modulus in (
            ((0, 1), law.G12_MPa),
            ((0, 2), law.G13_MPa),
            ((1, 2), law.G23_MPa),
        ):
            density += 2 * modulus * point.strain[:, i, j] ** 2

        density += law.hardening / 4 * (point.ratio - 1) ** 4
        total += float((density * point.volume).sum())
        least = min(least, float(point.ratio.min()))

    return Energy(total, least)
