"""The door to meshio, which is optional: a mesh for the formats it writes."""

from __future__ import annotations

import numpy as np

from ..support.errors import MissingPackageError
from .mesh import Mesh, yarn_numbers


def meshio_mesh(mesh: Mesh):
    """The mesh as :meth:`fabric_cad.meshing.Mesh.to_meshio` describes it."""
    try:
        import meshio
    except ImportError as error:
        raise MissingPackageError(
            "to_meshio needs the package meshio: pip install meshio"
        ) from error

    sizes = [len(quads) for quads in mesh.surfaces.values()]
    starts = np.cumsum([0, *sizes])
    owners = [mesh.bodies.index(surface.body) for surface in mesh.surfaces]
    quads = np.vstack([np.empty((0, 4), dtype=np.int64), *mesh.surfaces.values()])

    none = np.empty(0, dtype=np.int64)
    sets = {body.name: [mesh.elements_of(body), none] for body in mesh.bodies}
    sets |= {
        surface.name: [none, np.arange(start, start + n)]
        for surface, start, n in zip(mesh.surfaces, starts, sizes)
    }
    number = yarn_numbers(mesh)

    return meshio.Mesh(
        mesh.points,
        [("hexahedron", mesh.hexahedra), ("quad", quads)],
        cell_data={
            "yarn": [number[mesh.body], np.repeat(number[owners], sizes)],
            "fibre_axis": [mesh.fibre_axes(), np.zeros((len(quads), 3))],
        },
        cell_sets=sets,
    )
