"""The matrix of a composite cell: hexahedra only, between the yarns' own.

In plan every yarn is a straight strip and patches of contact are rectangles, so that the whole cell
has one :mod:`grid <fabric_cad.composite.grid>` in plan. Over every node of it stands one vertical
line; between the lowest and the highest skin on it are yarns (and :mod:`strips of resin
<fabric_cad.composite.resin>`), above and below :mod:`layers <fabric_cad.composite.sheets>` of
matrix to the box.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from ..meshing.closed import closed_mesh
from ..meshing.mesh import Mesh
from ..meshing.options import MeshOptions
from ..meshing.plan import Plan, plan_yarns
from ..model.solved import SolvedFabric
from ..support.arrays import read_only
from ..weave.bodies import SurfaceKind
from ..weave.directions import DIRECTIONS
from ..weave.weaves import yarns_of
from .cell import MATRIX, CompositeCell
from .contact import close_crossings
from .faces import box_faces, yarn_faces
from .grid import Lines, lines_across
from .nodes import Nodes
from .options import USUAL, CompositeOptions
from .resin import lay_all_resin, reach_of
from .resin_check import MeshedResin, check_resins
from .resin_mesh import resin_hexahedra, resin_nodes
from .sheets import Sheets, fill_pockets, lay_yarns, layers_of
from .spacing import gap_shares
from .yarns import Strip, of_direction, strips_of


def mesh_composite(
    fabric: SolvedFabric, mesh: MeshOptions, options: CompositeOptions = USUAL
) -> CompositeCell:
    """The composite cell of a fabric, in closed form: neither CAD nor gmsh is needed.

    Raises :class:`InputError` where the options do not fit the fabric.
    """
    plans = plan_yarns(
        fabric, yarns_of(fabric.weave.interlacement()), mesh, gap_shares(fabric, mesh)
    )
    return composite_cell(closed_mesh(fabric, plans), fabric, plans, options)


def composite_cell(
    yarns: Mesh, fabric: SolvedFabric, plans: Sequence[Plan], options: CompositeOptions = USUAL
) -> CompositeCell:
    """The composite cell around the mesh of a fabric's yarns, which was made by ``plans``.

    The yarns' hexahedra stay as they are, but for nodes of wedges that are closed
    (``closed_wedge``). Raises :class:`InputError` where the options do not fit the fabric,
    :class:`BuildError` where mesh and plans do not.
    """
    margin = options.margin.length(fabric.fabric_thickness)
    strips = strips_of(yarns, fabric, plans)
    x, y = _lines(plans, strips)
    points, shift = _placed(yarns, fabric, plans)
    closed = close_crossings(points, strips, fabric, (x, y), options.contact == "bonded")

    half = fabric.fabric_thickness / 2 + margin
    nodes = Nodes(points)
    strips = [closed.renumber(strip) for strip in strips]
    layers, resins = _fill(nodes, strips, (x, y), half, options.shares())
    check_resins(resins, nodes.points, fabric)
    matrix = np.concatenate([*layers, *(resin.hexahedra for resin in resins)])
    hexahedra = np.concatenate([closed.stands_for[yarns.hexahedra], matrix])
    body = np.concatenate([yarns.body, np.full(len(matrix), len(yarns.bodies))])
    surfaces = {
        name: closed.stands_for[quads] for name, quads in yarn_faces(yarns, closed.crossing).items()
    }

    size = np.array([*fabric.period, 2 * half])
    mesh = _compressed(Mesh(nodes.points, hexahedra, body, (*yarns.bodies, MATRIX), surfaces))
    box = box_faces(mesh.points, mesh.hexahedra, size)
    return CompositeCell(
        mesh=replace(mesh, points=read_only(fabric.lattice.to_space(mesh.points))),
        box=MappingProxyType({name: read_only(quads) for name, quads in box.items()}),
        size=read_only(size),
        margin=margin,
        shift=shift,
        closed_wedge=closed.wedge,
    )


def _lines(plans: Sequence[Plan], strips: Sequence[Strip]) -> tuple[Lines, Lines]:
    """The plan grid's lines across x and across y."""
    gap = 2 * (len(plans[0].layers[0]) - 1)
    lines = []
    for direction in DIRECTIONS:
        others = of_direction(strips, direction.other)
        lines.append(
            lines_across(direction.axis, plans, others[0].bottom.shape[1] - 1, len(others), gap)
        )
    return lines[0], lines[1]


def _placed(yarns: Mesh, fabric: SolvedFabric, plans: Sequence[Plan]) -> tuple[np.ndarray, float]:
    """The yarns' nodes, woven and centred, ends exactly on the box; how far they were moved up."""
    points = fabric.lattice.to_woven(yarns.points).copy()
    for plan in plans:
        axis = plan.along_axis
        points[yarns.nodes_of(plan.yarn.body, SurfaceKind.START), axis] = 0.0
        points[yarns.nodes_of(plan.yarn.body, SurfaceKind.END), axis] = fabric.period[axis]

    points[:, 2] += (shift := centring(fabric))
    return points, shift


def centring(fabric: SolvedFabric) -> float:
    """How far up a fabric's yarns are to be moved for its faces to stand at equal heights over and under z = 0, mm."""
    highest = max(solved.z_high + solved.thickness / 2 for solved in fabric.directions.values())
    lowest = min(solved.z_low - solved.thickness / 2 for solved in fabric.directions.values())
    return -(highest + lowest) / 2


def _fill(
    nodes: Nodes,
    strips: Sequence[Strip],
    axes: tuple[Lines, Lines],
    half: float,
    shares: np.ndarray,
) -> tuple[list[np.ndarray], list[MeshedResin]]:
    """The matrix's hexahedra (elements, 8), whose nodes are added; the box reaches ``half`` (mm) up and down.

    Those of the layers below and above the yarns, and of the strips of resin.
    """
    x, y = axes
    sheets, reach = Sheets.empty(x, y), reach_of(strips, x)
    lay_yarns(sheets, strips, x, y)
    resins = lay_all_resin(sheets, strips, nodes, axes, reach) if reach else []
    fill_pockets(sheets, nodes, x, y, reach)
    for sheet in (sheets.low, sheets.high):  # blends leave rounding errors
        nodes.points[sheet[0], 0] = 0.0
        nodes.points[sheet[:, 0], 1] = 0.0

    sections = [resin_nodes(resin, nodes) for resin in resins]
    slabs = _slabs(sheets, nodes, axes, half, shares)
    images = _images(nodes, strips, (x.places[-1], y.places[-1]))
    layers = [_columns(_unrolled(slab, images)) for slab in slabs]
    meshed = []
    for resin, section in zip(resins, sections):
        after = images[resin.direction.axis][section[:1]]
        meshed.append(MeshedResin(resin, resin_hexahedra(resin, np.vstack([section, after]))))

    return layers, meshed


def _slabs(
    sheets: Sheets, nodes: Nodes, axes: tuple[Lines, Lines], half: float, shares: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Node numbers (lines of x, lines of y, layers + 1) of the matrix below and above the yarns, upwards."""
    x, y = axes
    grid = np.empty((x.count, y.count, 3))
    grid[..., 0], grid[..., 1], grid[..., 2] = x.places[:-1, None], y.places[:-1], -half
    below = layers_of(sheets.low, nodes, grid, shares)[..., ::-1]
    return below, layers_of(sheets.high, nodes, grid * [1.0, 1.0, -1.0], shares)


def _images(nodes: Nodes, strips: Sequence[Strip], period: tuple[float, float]) -> list[np.ndarray]:
    """The images of nodes on x = 0, and of those on y = 0, as :meth:`Nodes.images` gives them."""
    known = []
    for direction in DIRECTIONS:
        ends = [strip.everything[[0, -1]].T for strip in of_direction(strips, direction)]
        known.append(np.unique(np.vstack(ends), axis=0))
    across = nodes.images(1, period[1], known[1])
    return [nodes.images(0, period[0], known[0]), across]


def _unrolled(numbers: np.ndarray, images: Sequence[np.ndarray]) -> np.ndarray:
    """Node numbers (lines, lines, ...) of the torus on all of the cell: one line more along either axis."""
    across = np.concatenate([numbers, images[1][numbers[:, :1]]], axis=1)
    return np.concatenate([across, images[0][across[:1]]], axis=0)


def _columns(numbers: np.ndarray) -> np.ndarray:
    """Hexahedra (elements, 8) of a block of nodes (lines of x, lines of y, levels), upwards."""
    corners = (numbers[:-1, :-1], numbers[1:, :-1], numbers[1:, 1:], numbers[:-1, 1:])
    levels = [corner[..., :-1].ravel() for corner in corners] + [
        corner[..., 1:].ravel() for corner in corners
    ]
    return np.stack(levels, axis=1)


def _compressed(mesh: Mesh) -> Mesh:
    """The same without nodes that no hexahedron has."""
    used = np.zeros(len(mesh.points), dtype=bool)
    used[mesh.hexahedra] = True
    number = np.cumsum(used) - 1
    return Mesh(
        points=mesh.points[used],
        hexahedra=read_only(number[mesh.hexahedra]),
        body=read_only(mesh.body),
        bodies=mesh.bodies,
        surfaces=MappingProxyType(
            {name: read_only(number[quads]) for name, quads in mesh.surfaces.items()}
        ),
    )
