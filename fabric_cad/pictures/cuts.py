"""Cuts through a deformed mesh, along a yarn's middle."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..meshing.grids import grid_of
from ..meshing.mesh import Mesh
from ..support.arrays import checked
from ..weave.bodies import Body

_BESIDE = 1e-6  # of the cell: how far the cut keeps from nodes that lie in its plane


@dataclass(frozen=True, eq=False)
class Outline:
    """Where a cut meets one ``yarn``: closed lines (points, 2), along the cut and z, mm.

    The same material points at ``rest`` and ``deformed``.
    """

    yarn: Body
    rest: np.ndarray
    deformed: np.ndarray


def cut_along(mesh: Mesh, displacement: np.ndarray, yarn: str) -> list[Outline]:
    """Cut the cell at rest by the upright plane along a yarn's middle, and carry the cut along.

    ``displacement`` (nodes, 3) mm. The plane's material points stay the same, so that a shape at
    rest and its deformed one can be compared point by point. Raises ValueError where no yarn is
    called so.
    """
    checked("displacement", displacement, mesh.points.shape)
    named = {body.name: body for body in mesh.yarns}
    if yarn not in named or (direction := named[yarn].direction) is None:
        raise ValueError(f"no yarn is called {yarn}")

    along, across = direction.axis, direction.other.axis
    nodes = np.unique(mesh.hexahedra[mesh.elements_of(named[yarn])])
    middle = (mesh.points[nodes, across].min() + mesh.points[nodes, across].max()) / 2
    middle += _BESIDE * np.ptp(mesh.points[:, across])

    grid = grid_of(mesh)
    grid.point_data["displacement"] = displacement
    grid.cell_data["body_index"] = mesh.body
    origin, normal = np.zeros(3), np.zeros(3)
    origin[across], normal[across] = middle, 1.0
    section = grid.slice(normal=normal, origin=origin)

    in_plane = [along, 2]
    return [
        Outline(mesh.bodies[index], rest[:, in_plane], (rest + moved)[:, in_plane])
        for index, rest, moved in _loops(section)
    ]


def _loops(section) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """The closed boundary lines of every body's part of a section.

    The body's index, then points and their displacements, each (points, 3) mm.
    """
    body = section.cell_data["body_index"]
    for index in np.unique(body):
        part = section.extract_cells(np.flatnonzero(body == index))
        rim = part.extract_surface(algorithm=None).clean()
        rim = rim.extract_feature_edges(
            boundary_edges=True,
            feature_edges=False,
            manifold_edges=False,
            non_manifold_edges=False,
        )

        lines = rim.strip(join=True, max_length=len(rim.points) + 1)
        displacement = lines.point_data["displacement"]
        for line in lines.cell:
            yield int(index), lines.points[line.point_ids], displacement[line.point_ids]
