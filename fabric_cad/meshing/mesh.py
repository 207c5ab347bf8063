"""A hexahedral mesh of a cell, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..weave.bodies import Body, Surface, SurfaceKind, YarnBody
from .hexahedron import LENGTHWISE


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes and hexahedra of a cell.

    ``points`` (nodes, 3) in mm, in the order of the file's node numbers 1, 2, ...;
    ``hexahedra`` (elements, 8) as node indices from 0, in the corner order of gmsh, VTK and
    C3D8; ``body`` (elements,) indexes ``bodies``; ``surfaces`` maps surfaces of bodies to
    quadrilaterals (quads, 4). The first face (corners 0 to 3) of a yarn's hexahedron looks to
    the yarn's start.
    """

    points: np.ndarray
    hexahedra: np.ndarray
    body: np.ndarray
    bodies: tuple[Body, ...]
    surfaces: Mapping[Surface, np.ndarray]
    other_elements: int = 0

    @property
    def yarns(self) -> tuple[YarnBody, ...]:
        """The bodies that are yarns, in the order of :attr:`bodies`."""
        return tuple(body for body in self.bodies if isinstance(body, YarnBody))

    def elements_of(self, body: Body) -> np.ndarray:
        """Indices (elements,) of a body's hexahedra."""
        return np.flatnonzero(self.body == self.bodies.index(body))

    def quads_of(self, body: Body, *kinds: SurfaceKind) -> np.ndarray:
        """The quadrilaterals (quads, 4) of a body's surfaces of some kinds.

        None where it has no such surface.
        """
        found = [
            self.surfaces[key] for kind in kinds if (key := Surface(body, kind)) in self.surfaces
        ]
        return np.vstack([np.empty((0, 4), dtype=np.int64), *found])

    def nodes_of(self, body: Body, *kinds: SurfaceKind) -> np.ndarray:
        """Sorted node indices of a body's surfaces of some kinds."""
        return np.unique(self.quads_of(body, *kinds))

    def fibre_axes(self) -> np.ndarray:
        """Unit vectors (elements, 3) along the yarn, the mean of the four edges that follow it.

        0 off the yarns.
        """
        p = self.points
        along = np.zeros((len(self.hexahedra), 3))
        for start, end in LENGTHWISE:
            along += p[self.hexahedra[:, end]] - p[self.hexahedra[:, start]]
        along /= np.linalg.norm(along, axis=1)[:, None]
        return self._on_yarns(along)

    def to_pyvista(self, surfaces: bool = False):
        """The mesh for PyVista: an UnstructuredGrid of the hexahedra.

        Cell data ``yarn`` (from 1, in the order of the field data ``yarn_names``; 0 off the yarns),
        ``direction`` (0 weft, 1 warp; -1 off the yarns) and ``fibre_axis``. With ``surfaces`` a
        MultiBlock: the grid as ``yarns``, then every surface as PolyData under its name, with its
        node numbers from 0 as point data ``node``.
        """
        from .grids import pyvista_blocks, pyvista_grid

        return pyvista_blocks(self) if surfaces else pyvista_grid(self)

    def to_meshio(self):
        """The mesh for meshio: one block of hexahedra, one of the quadrilaterals of all surfaces.

        ``cell_sets`` hold every yarn's hexahedra and every surface's quadrilaterals under their
        names; cell data ``yarn`` (from 1) and ``fibre_axis`` (0, 0, 0 on quadrilaterals). Raises
        :class:`~fabric_cad.support.errors.MissingPackageError` where meshio is not installed.
        """
        from .exchange import meshio_mesh

        return meshio_mesh(self)

    def across_axes(self) -> np.ndarray:
        """Unit vectors (elements, 3) across the yarn, in plane and normal to the fibre.

        0 off the yarns.
        """
        across = np.cross([0.0, 0.0, 1.0], self.fibre_axes())
        length = np.linalg.norm(across, axis=1)[:, None]
        return np.divide(across, length, out=np.zeros_like(across), where=length > 0)

    def _on_yarns(self, vectors: np.ndarray) -> np.ndarray:
        """Vectors (elements, 3), those of elements of other bodies set to 0."""
        is_yarn = np.array([isinstance(body, YarnBody) for body in self.bodies])
        return vectors if is_yarn.all() else np.where(is_yarn[self.body, None], vectors, 0.0)


def yarn_numbers(mesh: Mesh) -> np.ndarray:
    """For every body of a mesh its number among the yarns, from 1; 0 for what is no yarn."""
    yarns = mesh.yarns
    return np.array(
        [yarns.index(body) + 1 if body in yarns else 0 for body in mesh.bodies], dtype=np.int64
    )
