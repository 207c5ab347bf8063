"""The six load cases of a composite cell as a deck for CalculiX or Abaqus.

The cell is periodic by equations: what a node on a far face moves more than its image is what the
cell's edge vectors change by, which three reference nodes hold. The mean stress of a step, the
stresses at the integration points weighted with their volumes over the volume of the cell, is a
column of the stiffness. (The reaction at a node of equations is printed as 0 by CalculiX.)
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...decks.keywords import (
    Boundary,
    Comment,
    ElementSet,
    EngineeringConstants,
    Equation,
    FibreOrientation,
    Hexahedra,
    IsotropicElasticity,
    Keyword,
    LinearStep,
    Material,
    Nodes,
    NodeSet,
    SolidSection,
    StressOutput,
    write_keywords,
)
from ...meshing.mesh import Mesh
from ..cell import CompositeCell
from ..homogenisation.homogenise import tensor_of
from ..homogenisation.periodicity import PeriodicMesh, periodic_pairs
from ..micromechanics import yarn_properties
from ..substances import Constituents
from ..transverse import TransverselyIsotropic
from .report import COMPONENTS

_CELL = "cell"
_ORIENTATION = "fibres"
_EDGES = ("along_x", "along_y", "along_z")


def write_stiffness_deck(
    cell: CompositeCell,
    periodic: PeriodicMesh,
    fractions: np.ndarray,
    constituents: Constituents,
    path: Path,
    *,
    title: str,
    dialect: str = "calculix",
) -> None:
    """Write six linear steps, a unit of mean strain xx, yy, zz, yz, xz, xy each (engineering shear).

    ``fractions`` (elements,) are the yarns' fibre volume fractions; every different one is a
    material.
    """
    write_keywords(
        stiffness_keywords(cell, periodic, fractions, constituents, title=title), path, dialect
    )


def stiffness_keywords(
    cell: CompositeCell,
    periodic: PeriodicMesh,
    fractions: np.ndarray,
    constituents: Constituents,
    *,
    title: str,
) -> Iterator[Keyword]:
    """The keywords of :func:`write_stiffness_deck`."""
    mesh = cell.mesh
    yield Comment(f"{title}\nmm, N, MPa; the mean stress of a step is a column of the stiffness")
    yield Nodes("all_nodes", mesh.points)
    yield from _materials(mesh, cell.in_matrix, fractions, constituents)

    reference = len(mesh.points) + 1 + np.arange(3)
    yield Nodes("cell_edges", periodic.vectors, first=int(reference[0]))
    yield from (NodeSet(name, np.array([node])) for name, node in zip(_EDGES, reference))
    yield from periodic_equations(periodic, reference)
    yield Boundary(tuple((_held(periodic), axis, 0.0) for axis in (1, 2, 3)))

    for load, name in enumerate(COMPONENTS):
        change = periodic.vectors @ tensor_of(np.eye(6)[load])
        driven = [
            (int(node), axis, float(row[axis - 1]))
            for node, row in zip(reference, change)
            for axis in (1, 2, 3)
        ]
        yield LinearStep(f"mean strain {name} = 1", (Boundary(tuple(driven)), StressOutput(_CELL)))


def periodic_equations(periodic: PeriodicMesh, reference: np.ndarray) -> Iterator[Equation]:
    """Three equations a node on a far face: its displacement = its image's + those of the edges between both."""
    slaves, masters = periodic_pairs(periodic)
    apart = np.rint(
        (periodic.points[slaves] - periodic.points[masters]) @ np.linalg.inv(periodic.vectors)
    ).astype(int)
    for slave, master, edges in zip((slaves + 1).tolist(), (masters + 1).tolist(), apart):
        nodes = reference[edges == 1].tolist()
        for axis in (1, 2, 3):
            yield Equation(
                ((slave, axis, 1.0), (master, axis, -1.0), *((node, axis, -1.0) for node in nodes))
            )


def _held(periodic: PeriodicMesh) -> int:
    """Number of the node that keeps its place: any that no equation gives."""
    slaves, _ = periodic_pairs(periodic)
    return int(np.setdiff1d(np.arange(len(periodic.points)), slaves)[0]) + 1


def _materials(
    mesh: Mesh, in_matrix: np.ndarray, fractions: np.ndarray, constituents: Constituents
) -> Iterator[Keyword]:
    """Elements by material (matrix, yarns by their fibre fraction), and those of every yarn."""
    numbers = np.arange(1, len(mesh.hexahedra) + 1)
    groups = {"matrix": np.flatnonzero(in_matrix)}
    yarn = np.flatnonzero(~in_matrix)
    # NaN: not known, one group
    distinct, group = np.unique(np.round(fractions[yarn], 12), return_inverse=True)
    groups |= {f"yarn_{n + 1}": yarn[group == n] for n in range(len(distinct))}
    for name, elements in groups.items():
        yield Hexahedra(f"{name}_elements", numbers[elements], mesh.hexahedra[elements] + 1)

    yield ElementSet(_CELL, tuple(f"{name}_elements" for name in groups))
    yield from (ElementSet(body.name, mesh.elements_of(body) + 1) for body in mesh.yarns)
    axes = np.hstack([mesh.fibre_axes(), mesh.across_axes()])
    axes[in_matrix] = [1.0, 0, 0, 0, 1.0, 0]
    yield FibreOrientation(_ORIENTATION, axes)

    yield Material("matrix", IsotropicElasticity(constituents.matrix.E_MPa, constituents.matrix.nu))
    yield SolidSection("matrix_elements", "matrix")
    laws = yarn_properties(constituents, None if np.isnan(distinct).any() else distinct).law
    for n in range(len(distinct)):
        yield Material(f"yarn_{n + 1}", _constants(laws, n))
        yield SolidSection(f"yarn_{n + 1}_elements", f"yarn_{n + 1}", _ORIENTATION)


def _constants(laws: TransverselyIsotropic, number: int) -> EngineeringConstants:
    """One of many laws for a deck."""
    e1, e2, g12, g23, nu12, nu23 = (
        float(np.broadcast_to(value, max(np.size(value), number + 1))[number])
        for value in (laws.E1_MPa, laws.E2_MPa, laws.G12_MPa, laws.G23_MPa, laws.nu12, laws.nu23)
    )
    return EngineeringConstants(e1, e2, e2, nu12, nu12, nu23, g12, g12, g23)
