"""The stages from a measured row to the effective properties of its composite cell.

row -> solved fabric -> hexahedra of yarns and matrix -> materials of all elements -> homogenisation
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...cell.pipeline import Stages
from ...measured.tables import Family
from ...meshing.options import MeshOptions
from ...meshing.quality import mesh_quality
from ...model.identification import identify
from ...model.solved import SolvedFabric, SolvedTable
from ...support.memory import refuse_beyond_memory
from ..cell import CompositeCell
from ..fibres import fibre_sections
from ..homogenisation.homogenise import Effective, Materials, Plate, homogenise, homogenise_plate
from ..homogenisation.periodicity import PeriodicMesh
from ..materials import element_fractions, element_materials
from ..matrix import mesh_composite
from ..options import CompositeOptions
from ..spacing import composite_mesh_options
from ..substances import Constituents

COARSE = {"across": 8}
"""The mesh where nothing is said of it: moduli change by 1 % on finer ones, which follow the yarns' faces closer."""

_BYTES = 9000  # a hexahedron needs, measured


@dataclass(frozen=True, eq=False)
class CompositeModel:
    """A row's composite cell and what it is made of.

    ``fractions`` (elements,) are the yarns' fibre volume fractions, 0 in the matrix, NaN where not
    known; ``quality`` (elements,) the scaled Jacobian.
    """

    row: Family
    solved: SolvedTable
    options: MeshOptions
    cell: CompositeCell
    quality: np.ndarray
    constituents: Constituents
    fractions: np.ndarray

    @property
    def fabric(self) -> SolvedFabric:
        """The row, solved."""
        return self.solved[self.row.names[0]]


@dataclass(frozen=True, eq=False)
class CompositeStiffness:
    """A composite, the materials of its elements, and what it is like from far away, as a plate too or not."""

    model: CompositeModel
    materials: Materials
    effective: Effective
    plate: Plate | None


def composite_model(
    row: Family,
    constituents: Constituents,
    *,
    mesh: Mapping[str, Any],
    options: CompositeOptions,
    stages: Stages,
) -> CompositeModel:
    """The composite of a table of one row.

    ``mesh`` are keywords of :func:`~fabric_cad.composite.spacing.composite_mesh_options`. Raises
    :class:`InputError` for what is wrong in the input.
    """
    (name,) = row.names
    sections = fibre_sections(row, constituents)

    with stages("identify"):
        solved = identify(row)
        fabric = solved[name]
        used = composite_mesh_options(fabric, **(mesh if "size" in mesh else COARSE | dict(mesh)))

    with stages("mesh"):
        cell = mesh_composite(fabric, used, options)
        quality = mesh_quality(cell.mesh).scaled_jacobian

    with stages("fibres"):
        fractions = element_fractions(cell.mesh, fabric, sections)

    return CompositeModel(row, solved, used, cell, quality, constituents, fractions)


def compute_stiffness(model: CompositeModel, *, plate: bool, stages: Stages) -> CompositeStiffness:
    """Homogenise a composite, with ``plate`` as a plate too.

    Raises :class:`InputError` where it would not fit in memory, :class:`SolverError` where the
    equations are not solved.
    """
    cell, fabric = model.cell, model.fabric
    hexahedra = len(cell.mesh.hexahedra)
    refuse_beyond_memory(hexahedra, _BYTES * hexahedra)
    with stages("materials"):
        materials = element_materials(cell.mesh, model.fractions, model.constituents)
    with stages("homogenise"):
        effective = homogenise(periodic_mesh(cell, fabric), materials)
    bent = None
    if plate:
        with stages("plate"):
            bent = homogenise_plate(periodic_mesh(cell, fabric, through=False), materials)

    return CompositeStiffness(model, materials, effective, bent)


def periodic_mesh(cell: CompositeCell, fabric: SolvedFabric, through: bool = True) -> PeriodicMesh:
    """A composite cell that repeats in its plane, and ``through`` its thickness as well or not."""
    return PeriodicMesh(
        cell.mesh.points,
        cell.mesh.hexahedra,
        *cell.repeats(fabric.lattice),
        periodic=(True, True, through),
    )
