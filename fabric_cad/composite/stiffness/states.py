"""The six load cases as a series for ParaView: how the cell moves, and its strains and stresses."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...pictures import State, write_series
from ..homogenisation.homogenise import UNIT_STRAINS, tensor_of
from ..homogenisation.response import mean_strains
from .computation import CompositeStiffness
from .report import COMPONENTS

STRAIN = 0.01
"""The mean strain of every load case that is written, engineering strain where it is shear."""

_PARAVIEW = [0, 1, 2, 5, 3, 4]  # xx, yy, zz, xy, yz, xz: as ParaView names six components

_UNITS = {
    "points": "mm, deformed",
    "displacement": "mm",
    "strain": f"1; mean {STRAIN:g}; xx, yy, zz, xy, yz, xz, engineering shear",
    "stress": "MPa; xx, yy, zz, xy, yz, xz",
    "fibre_stress": "MPa, along the fibres; 0 in the matrix",
    "fibre_fraction": "1",
}


def write_states(computed: CompositeStiffness, path: Path) -> list[Path]:
    """Write every load case and ``path`` (``.pvd``), which names them; all files written."""
    return write_series(computed.model.cell.mesh, _states(computed), path, _UNITS)


def _states(computed: CompositeStiffness) -> Iterator[State]:
    response, mesh = computed.effective.response, computed.model.cell.mesh
    axes = mesh.fibre_axes()
    fluctuations = np.empty((len(mesh.points), 3, 6))
    fluctuations[mesh.hexahedra] = response.fluctuations[response.integrals.corners]

    for load, name in enumerate(COMPONENTS):
        strain = mean_strains(response, UNIT_STRAINS, load) * STRAIN
        stress = np.einsum("nij,nj->ni", computed.materials.stiffness, strain)
        moved = mesh.points @ tensor_of(UNIT_STRAINS[0, :, load]) + fluctuations[..., load]
        yield State(
            load,
            f"{name} {100 * STRAIN:g} %",
            STRAIN * moved,
            cell_data={
                "strain": strain[:, _PARAVIEW],
                "stress": stress[:, _PARAVIEW],
                "fibre_stress": np.einsum("ni,nij,nj->n", axes, _tensors(stress), axes),
                "fibre_fraction": computed.model.fractions,
            },
            facts={"row": computed.model.fabric.name, "load": name, "mean_strain": STRAIN},
        )


def _tensors(stress: np.ndarray) -> np.ndarray:
    """Stresses (elements, 6) as tensors (elements, 3, 3)."""
    return stress[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
