"""How many hexahedra a mesh will have, and what it will take, told from its options alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..model.solved import SolvedFabric
from ..weave.weaves import yarns_of
from .section_mesh import section_mesh

if TYPE_CHECKING:
    from .options import MeshOptions

BYTES_A_HEXAHEDRON = 540
"""Memory a hexahedron takes until all files are written, measured: 382 of one million, 536 of 2.55 million."""


def hexahedra(fabric: SolvedFabric, options: MeshOptions) -> int:
    """The number of hexahedra of a fabric's cell, exactly."""
    across = {"weft": options.across, "warp": options.crossing}
    frames = {direction: fabric.frame(direction) for direction in across}
    mesh = section_mesh(fabric.form)

    quads = {d: mesh.quadrilaterals(frames[d], across[d], options.through) for d in across}
    layers = {
        (d, high): options.gap
        + mesh.column_count(frames[crossed], "top" if high else "bottom", across[crossed])
        for d, crossed in (("weft", "warp"), ("warp", "weft"))
        for high in (True, False)
    }

    return sum(
        quads[yarn.direction] * sum(layers[yarn.direction, high] for high in yarn.high)
        for yarn in yarns_of(fabric.weave.interlacement())
    )


_COPIES = 6
"""Arrays of a section's weights that are there at once while its template is made."""


def needed_memory(fabric: SolvedFabric, options: MeshOptions) -> int:
    """Bytes that meshing a fabric's cell and writing its files takes beyond the program itself.

    Besides the hexahedra these are a section's nodes, each a weighted mean of all nodes of its
    outline.
    """
    sections = [
        2 * (across + options.through) * (across + 1) * (options.through + 1)
        for across in (options.across, options.crossing)
    ]
    return BYTES_A_HEXAHEDRON * hexahedra(fabric, options) + _COPIES * 8 * max(sections)
