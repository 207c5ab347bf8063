"""A hexahedral mesh of a cell, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and hexahedra of a cell.

    ``points`` (nodes, 3) in mm, in the order of the file's node numbers 1, 2, ...;
    ``hexahedra`` (elements, 8) as node indices from 0, in the corner order of gmsh, VTK and
    C3D8; ``yarn`` (elements,) indexes ``yarns``; ``surfaces`` maps ``weft_1_contact``,
    ``weft_1_free``, ``weft_1_start``, ``weft_1_end`` ... to quadrilaterals (quads, 4).
    The first face (corners 0 to 3) of every hexahedron looks to the start of its yarn.
    """

    points: np.ndarray
    hexahedra: np.ndarray
    yarn: np.ndarray
    yarns: tuple[str, ...]
    surfaces: dict[str, np.ndarray]
    other_elements: int = 0

    def nodes_of(self, surface: str) -> np.ndarray:
        """Sorted node indices of a surface."""
        return np.unique(self.surfaces[surface])

    def surfaces_named(self, kind: str) -> dict[str, np.ndarray]:
        """Surfaces of one kind: ``contact``, ``free``, ``start``, ``end``."""
        return {name: quads for name, quads in self.surfaces.items() if name.endswith(f"_{kind}")}

    def fibre_axes(self) -> np.ndarray:
        """Unit vectors (elements, 3) along the yarn: the mean of the four edges that follow it."""
        p = self.points
        along = np.zeros((len(self.hexahedra), 3))
        for corner in range(4):
            along += p[self.hexahedra[:, corner + 4]] - p[self.hexahedra[:, corner]]
        return along / np.linalg.norm(along, axis=1)[:, None]

    def to_pyvista(self, surfaces: bool = False):
        """The mesh for PyVista: an UnstructuredGrid of the hexahedra.

        Cell data ``yarn`` (from 1, in the order of the field data ``yarn_names``), ``direction`` (0 weft,
        1 warp) and ``fibre_axis``. With ``surfaces`` a MultiBlock: the grid as ``yarns``, then every
        surface as PolyData under its name, with its node numbers from 0 as point data ``node``.
        """
        from .grids import pyvista_blocks, pyvista_grid

        return pyvista_blocks(self) if surfaces else pyvista_grid(self)

    def to_meshio(self):
        """The mesh for meshio: one block of hexahedra, one of the quadrilaterals of all surfaces.

        ``cell_sets`` hold every yarn's hexahedra and every surface's quadrilaterals under their names; cell
        data ``yarn`` (from 1) and ``fibre_axis`` (0, 0, 0 on quadrilaterals). Raises
        :class:`~fabric_cad.support.errors.MissingPackageError` where meshio is not installed.
        """
        from .exchange import meshio_mesh

        return meshio_mesh(self)

    def across_axes(self) -> np.ndarray:
        """Unit vectors (elements, 3) across the yarn, in the fabric's plane and normal to the fibre."""
        fibre = self.fibre_axes()
        across = np.cross([0.0, 0.0, 1.0], fibre)
        return across / np.linalg.norm(across, axis=1)[:, None]
