"""The door to meshio, which is optional: a mesh for the formats it writes."""

from __future__ import annotations

import numpy as np

from ..support.errors import MissingPackageError
from .mesh import Mesh


def meshio_mesh(mesh: Mesh):
    """The mesh as :meth:`fabric_cad.meshing.Mesh.to_meshio` describes it."""
    try:
        import meshio
    except ImportError as error:
        raise MissingPackageError("to_meshio needs the package meshio: pip install meshio") from error

    sizes = [len(quads) for quads in mesh.surfaces.values()]
    starts = np.cumsum([0, *sizes])
    owners = [mesh.yarns.index(surface.rsplit("_", 1)[0]) for surface in mesh.surfaces]
    quads = np.vstack([np.empty((0, 4), dtype=np.int64), *mesh.surfaces.values()])

    none = np.empty(0, dtype=np.int64)
    sets = {name: [np.flatnonzero(mesh.yarn == number), none] for number, name in enumerate(mesh.yarns)}
    sets |= {name: [none, np.arange(start, start + n)] for name, start, n in zip(mesh.surfaces, starts, sizes)}
    return meshio.Mesh(
        mesh.points,
        [("hexahedron", mesh.hexahedra), ("quad", quads)],
        cell_data={
            "yarn": [mesh.yarn + 1, np.repeat(owners, sizes).astype(mesh.yarn.dtype) + 1],
            "fibre_axis": [mesh.fibre_axes(), np.zeros((len(quads), 3))],
        },
        cell_sets=sets,
    )
