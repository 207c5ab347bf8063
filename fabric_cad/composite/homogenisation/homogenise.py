"""What a periodic cell is like from far away: stiffness, expansion, conductivity and density."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..transverse import ENGINEERING
from .elements import Elements
from .periodicity import PeriodicMesh
from .response import Response, conduction_response, elastic_response, work_of_stress

UNIT_STRAINS = np.stack([np.eye(6), np.zeros((6, 6))])
"""The six load cases (2, 6, 6): one unit of xx, yy, zz, yz, xz, xy each, shear as engineering strain."""

PLATE_STRAINS = np.zeros((2, 6, 6))
"""The six load cases of a plate (2, 6, 6): membrane strains xx, yy, xy of its middle, then their curvatures."""
PLATE_STRAINS[0, [0, 1, 5], [0, 1, 2]] = PLATE_STRAINS[1, [0, 1, 5], [3, 4, 5]] = 1.0


@dataclass(frozen=True, eq=False)
class Materials:
    """What every element is made of.

    ``stiffness`` (elements, 6, 6) MPa; ``expansion`` (elements, 6), strain per kelvin,
    ``conductivity`` (elements, 3, 3) W/(m K) and ``density`` (elements,) g/cm3, None where not
    known.
    """

    stiffness: np.ndarray
    expansion: np.ndarray | None = None
    conductivity: np.ndarray | None = None
    density: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Effective:
    """A cell as one material, xx yy zz yz xz xy with engineering shear.

    ``stiffness``, ``voigt`` and ``reuss`` (6, 6) MPa; ``expansion`` (6,), strain per kelvin;
    ``conductivity`` (3, 3) W/(m K); ``density`` g/cm3; each None where not known. ``response`` is
    that to :data:`UNIT_STRAINS`.
    """

    stiffness: np.ndarray
    voigt: np.ndarray
    reuss: np.ndarray
    expansion: np.ndarray | None
    conductivity: np.ndarray | None
    density: float | None
    response: Response


@dataclass(frozen=True, eq=False)
class Plate:
    """A cell as a plate with free floor and ceiling: ``A`` N/mm, ``B`` N, ``D`` N mm, each (3, 3) in xx, yy, xy.

    ``thickness`` mm is that of the cell, from whose middle bending is measured; ``response`` is
    that to :data:`PLATE_STRAINS`.
    """

    A: np.ndarray
    B: np.ndarray
    D: np.ndarray
    thickness: float
    response: Response


def homogenise(mesh: PeriodicMesh, materials: Materials) -> Effective:
    """The effective properties of a periodic cell.

    Raises :class:`~fabric_cad.support.errors.BuildError` where its faces do not match,
    :class:`~fabric_cad.support.errors.SolverError` where its equations are not solved.
    """
    elements = Elements(mesh)
    response = elastic_response(elements, materials.stiffness, UNIT_STRAINS)
    weights = response.integrals.volumes[0]
    volume = weights.sum()
    stiffness = response.work / volume

    expansion = None
    if (
        materials.expansion is not None
    ):  # V. M. Levin, Mechanics of Solids 2 (1967) 58-61: no load of its own
        stress = np.einsum("nij,nj->ni", materials.stiffness, materials.expansion)
        expansion = np.linalg.solve(
            stiffness, work_of_stress(response, stress, UNIT_STRAINS) / volume
        )

    conductivity = None
    if materials.conductivity is not None:
        conductivity = conduction_response(elements, materials.conductivity).work / volume

    return Effective(
        stiffness,
        *bounds(materials.stiffness, weights),
        expansion,
        conductivity,
        None if materials.density is None else float(weights @ materials.density / volume),
        response,
    )


def homogenise_plate(mesh: PeriodicMesh, materials: Materials) -> Plate:
    """The stiffness of a cell as a plate, along its first two edges; raises as :func:`homogenise`."""
    if mesh.periodic != (True, True, False):
        raise ValueError("a plate repeats along its first two edges and not through its thickness")

    response = elastic_response(Elements(mesh), materials.stiffness, PLATE_STRAINS)
    area = float(np.linalg.norm(np.cross(*mesh.vectors[:2])))
    work = response.work / area
    return Plate(work[:3, :3], work[:3, 3:], work[3:, 3:], mesh.volume / area, response)


def bounds(stiffness: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Voigt's and Reuss' means (6, 6) of stiffnesses (elements, 6, 6) by volumes (elements,)."""
    shares = weights / weights.sum()
    voigt = np.tensordot(shares, stiffness, 1)
    reuss = np.linalg.inv(np.tensordot(shares, np.linalg.inv(stiffness), 1))
    return voigt, (reuss + reuss.T) / 2


def constants(stiffness: np.ndarray) -> dict[str, float]:
    """Moduli, shear moduli (MPa) and Poisson ratios of a stiffness (6, 6) in the axes x, y and z."""
    compliance = np.linalg.inv(stiffness)
    found = {f"E{axis}": 1 / compliance[n, n] for n, axis in enumerate("xyz")}
    found |= {f"G{axes}": 1 / compliance[n, n] for n, axes in ((5, "xy"), (4, "xz"), (3, "yz"))}
    for first, second in (("x", "y"), ("x", "z"), ("y", "z"), ("y", "x"), ("z", "x"), ("z", "y")):
        row, column = "xyz".index(first), "xyz".index(second)
        found[f"nu_{first}{second}"] = -compliance[column, row] / compliance[row, row]
    return {name: float(value) for name, value in found.items()}


def tensor_of(strain: np.ndarray) -> np.ndarray:
    """The tensor (3, 3) of a strain (6,) with engineering shear."""
    xx, yy, zz, yz, xz, xy = strain / ENGINEERING
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
