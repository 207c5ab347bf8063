"""From a solved fabric to the permeability of its cell, with an error bar from a second mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..composite.cell import CompositeCell
from ..composite.matrix import mesh_composite
from ..model.solved import SolvedFabric
from ..support.memory import refuse_beyond_memory
from .connections import open_directions
from .equations import Equations, assemble
from .fineness import Fineness
from .pores import Pores
from .quadratic import QuadraticMesh
from .space import Top, held, space_between, whole_space
from .stokes import Flow, stokes_flow

_BYTES = 45000  # a hexahedron needs, measured


@dataclass(frozen=True, eq=False)
class CellFlow:
    """Flow in one cell: the space it fills, the equations and their solution."""

    fabric: SolvedFabric
    fineness: Fineness
    cell: CompositeCell
    top: Top
    mesh: QuadraticMesh
    equations: Equations
    flow: Flow
    pores: Pores | None = None

    @property
    def porosity(self) -> float:
        """Share of the cell that is not yarn."""
        space = (
            self.equations.volumes
            if self.pores is None
            else self.equations.volumes[self.cell.in_matrix]
        )
        return float(space.sum() / self.mesh.mesh.volume)


def cell_flow(
    fabric: SolvedFabric, fineness: Fineness, top: Top, pores: Pores | None = None
) -> CellFlow:
    """The flow between the yarns of a fabric's cell, and with ``pores`` through them, else they are rigid.

    Raises :class:`InputError` where the mesh cannot be so or would not fit in memory,
    :class:`SolverError` where the flow is not solved.
    """
    cell = mesh_composite(fabric, fineness.yarns, fineness.box)
    rigid = pores is None
    hexahedra = int(np.count_nonzero(cell.in_matrix)) if rigid else len(cell.mesh.hexahedra)
    refuse_beyond_memory(hexahedra, _BYTES * hexahedra)
    mesh = space_between(cell, fabric, top) if rigid else whole_space(cell, fabric, top)
    equations = assemble(
        mesh, held(mesh, top), None if pores is None else pores.resistance(cell, fabric)
    )
    flow = stokes_flow(equations, open_directions(mesh), mesh.mesh.volume)

    return CellFlow(fabric, fineness, cell, top, mesh, equations, flow, pores)
