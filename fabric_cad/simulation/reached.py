"""What a cell is like at a load that it reached."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..meshing.mesh import Mesh
from ..weave.directions import DIRECTIONS, Direction
from ..weave.lattice import Lattice


@dataclass(frozen=True, eq=False)
class Reached:
    """A load that was reached, or rest.

    ``forces`` (2, 3) N: sum over the wefts' ends and over the warps' ends of what the neighbouring
    cells pull with; ``displacement`` (nodes, 3) mm; ``strain`` (nodes, 6) Green's, axes xx, yy, zz,
    xy, yz, zx; ``pressure`` (nodes,) MPa, NaN off the weft's contact surfaces; ``overclosure``
    mm, the largest by which contact surfaces overlap, and ``share`` of the patches' area under
    pressure, both NaN where yarns are tied.
    """

    forces: np.ndarray
    displacement: np.ndarray
    strain: np.ndarray
    pressure: np.ndarray
    overclosure: float
    share: float


def at_rest(mesh: Mesh) -> Reached:
    """The cell before any load: nothing moved, nothing pressed."""
    zero = np.zeros(len(mesh.points))
    return Reached(
        np.zeros((2, 3)), np.zeros((len(zero), 3)), np.zeros((len(zero), 6)), zero, 0.0, np.nan
    )


@dataclass(frozen=True, eq=False)
class Deformed:
    """The cell at a load, beside the cell at rest.

    ``lattice`` is the cell's at rest, ``vectors`` (2, 3) mm are its periods at the load.
    """

    mesh: Mesh
    lattice: Lattice
    vectors: np.ndarray
    reached: Reached

    @property
    def points(self) -> np.ndarray:
        """Places (nodes, 3) of the mesh's nodes, mm."""
        return self.mesh.points + self.reached.displacement


def thickness(points: np.ndarray) -> float:
    """Extent (mm) of a cell's ``points`` (nodes, 3) through the fabric."""
    return float(np.ptp(points[:, 2]))


def tension_per_yarn(mesh: Mesh, pulls: np.ndarray) -> dict[str, float]:
    """Columns ``T11_N_per_yarn`` and ``T22_N_per_yarn`` of what all wefts and all warps pull with, (2,) N."""
    counts = [sum(yarn.direction is direction for yarn in mesh.yarns) for direction in DIRECTIONS]
    return {
        f"{name}_N_per_yarn": pull / count
        for name, pull, count in zip(("T11", "T22"), pulls, counts)
    }


def widths(mesh: Mesh, points: np.ndarray) -> tuple[float, float]:
    """Mean width (mm) of the wefts and of the warps at deformed ``points`` (nodes, 3): their extent across."""
    extents: dict[Direction, list[float]] = {direction: [] for direction in DIRECTIONS}
    for direction in DIRECTIONS:
        for yarn in mesh.yarns:
            if yarn.direction is direction:
                nodes = np.unique(mesh.hexahedra[mesh.elements_of(yarn)])
                extents[direction].append(float(np.ptp(points[nodes, direction.other.axis])))

    weft, warp = (float(np.mean(extents[direction])) for direction in DIRECTIONS)
    return weft, warp


def transverse_strains(mesh: Mesh, strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Green's strain (nodes,) across and through the yarn, in the axes of the yarns before the load.

    ``strain`` (nodes, 6) as in :class:`Reached`.
    """
    axes = np.zeros((2, len(mesh.points), 3))
    fibre, across = mesh.fibre_axes(), mesh.across_axes()
    for axis, values in zip(axes, (across, np.cross(fibre, across))):
        np.add.at(axis, mesh.hexahedra, values[:, None, :])
        axis /= np.linalg.norm(axis, axis=1)[:, None]

    xx, yy, zz, xy, yz, zx = strain.T
    tensor = np.moveaxis(np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]), 2, 0)
    across_yarns, through = (np.einsum("ni,nij,nj->n", axis, tensor, axis) for axis in axes)
    return across_yarns, through
