"""Velocity and pressure of a cell for ParaView, and as a picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..pictures.plots import Section, plot_flow, save_figure
from ..pictures.vtu import write_grid
from ..support.vtk import pyvista
from .computation import CellFlow
from .lines import lines_of, vertical_links
from .quadratic import CORNER_NODES, FACE_NODES, PLACES, QuadraticMesh

_VTK_TRIQUADRATIC_HEXAHEDRON = 29
_EDGES = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 4),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
]
_FACES = [(0, 3, 7, 4), (1, 2, 6, 5), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7)]
# of nine nodes
_TRIANGLES = [
    (0, 1, 4),
    (0, 4, 3),
    (1, 2, 5),
    (1, 5, 4),
    (3, 4, 7),
    (3, 7, 6),
    (4, 5, 8),
    (4, 8, 7),
]
_ON_SECTION = 1e-7  # of a period


def write_flow(solved: CellFlow, path: Path) -> None:
    """Write a ``.vtu`` of quadratic hexahedra with velocity (mm2) and pressure (mm) for every direction that is open.

    Both are for a unit pressure gradient over viscosity; the pressure is that beside the mean
    gradient. Raises OSError.
    """
    mesh = solved.mesh
    order = _vtk_order()
    cells = np.column_stack([np.full(len(mesh.nodes), 27), mesh.nodes[:, order]])
    kinds = np.full(len(cells), _VTK_TRIQUADRATIC_HEXAHEDRON, dtype=np.uint8)
    grid = pyvista().UnstructuredGrid(cells.ravel(), kinds, mesh.points)
    velocity, pressure = nodal_velocity(solved), _nodal_pressure(solved)

    for number, direction in enumerate(solved.flow.directions):
        name = name_of(direction)
        grid.point_data[f"velocity_{name}_mm2"] = velocity[..., number]
        grid.point_data[f"pressure_{name}_mm"] = pressure[:, number]

    write_grid(grid, path)


def draw_flow(solved: CellFlow, path: Path, title: str) -> None:
    """Draw the flow along the first open direction in plan, and speeds in the section y = 0, as PNG and PDF.

    Nothing flows where no direction is open: then the picture shows that.
    """
    velocity = nodal_velocity(solved)
    names = [name_of(direction) for direction in solved.flow.directions]
    if not names:
        velocity, names = np.zeros((*velocity.shape[:2], 1)), ["x"]

    plan, flux = _flux(solved.mesh, velocity[..., 0])
    shown = [0, *([len(names) - 1] if len(names) > 1 else [])]
    sections = [
        _section(solved, velocity[..., n], f"speed at y = 0, gradient along {names[n]}")
        for n in shown
    ]
    text = f"flux through the thickness, gradient along {names[0]}"
    save_figure(plot_flow(plan, flux, text, sections), path, title)


def nodal_velocity(solved: CellFlow) -> np.ndarray:
    """Velocity (nodes, 3, directions) at the nodes of the mesh, mm2, 0 on walls."""
    node, velocity = solved.equations.node, solved.flow.velocity
    return np.where((node >= 0)[:, None, None], velocity[np.maximum(node, 0)], 0.0)


def name_of(direction: np.ndarray) -> str:
    """``x``, ``y``, ``z``, or an oblique direction's components."""
    axis = int(np.argmax(np.abs(direction)))
    return (
        "xyz"[axis]
        if abs(direction[axis]) > 1 - 1e-9
        else "_".join(f"{part:.3f}" for part in direction)
    )


def _nodal_pressure(solved: CellFlow) -> np.ndarray:
    """Pressure (nodes, directions), trilinear between corners."""
    nodes, corner = solved.mesh.nodes, solved.equations.corner
    own = solved.flow.pressure[corner[nodes[:, CORNER_NODES]]]  # (elements, 8, directions)
    shares = np.prod(1 + PLACES[:, None] * PLACES[CORNER_NODES], axis=2) / 8
    values = np.empty((len(solved.mesh.points), own.shape[2]))
    values[nodes] = np.einsum("nc,ecd->end", shares, own)
    return values


def _vtk_order() -> list[int]:
    """Our number of every node of VTK's triquadratic hexahedron."""
    corners = PLACES[CORNER_NODES]
    groups = [*((n,) for n in range(8)), *_EDGES, *_FACES, tuple(range(8))]
    places = [corners[list(group)].mean(axis=0) for group in groups]
    return [int(np.flatnonzero((PLACES == place).all(axis=1))[0]) for place in places]


def _flux(mesh: QuadraticMesh, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places in plan (lines, 2) of all vertical lines, and the velocity (nodes, 3) integrated along them (lines, 2)."""
    line = lines_of(vertical_links(mesh), len(mesh.points))
    order = np.lexsort((mesh.points[:, 2], line))
    same = line[order][1:] == line[order][:-1]
    lower, upper = order[:-1][same], order[1:][same]
    rise = (mesh.points[upper, 2] - mesh.points[lower, 2])[:, None]
    parts = (velocity[lower, :2] + velocity[upper, :2]) / 2 * rise

    count = line.max() + 1
    flux = np.stack([np.bincount(line[lower], part, minlength=count) for part in parts.T], axis=1)
    total = np.bincount(line)
    places = np.stack(
        [np.bincount(line, mesh.points[:, axis]) / total for axis in range(2)], axis=1
    )
    distinct, number = np.unique(np.round(places, 6), axis=0, return_inverse=True)
    # below and above a yarn
    sums = [np.bincount(number.ravel(), part, minlength=len(distinct)) for part in flux.T]

    return distinct, np.stack(sums, axis=1)


def _section(solved: CellFlow, velocity: np.ndarray, title: str) -> Section:
    """Speed on the faces of hexahedra that lie in the cell's side along the wefts."""
    mesh = solved.mesh
    faces = mesh.nodes[:, FACE_NODES].reshape(-1, 9)
    share = solved.fabric.lattice.to_woven(mesh.points)[:, 1] / solved.fabric.period[1]
    own = faces[(np.abs(share[faces]) < _ON_SECTION).all(axis=1)]
    used, number = np.unique(own, return_inverse=True)
    triangles = number.reshape(-1, 9)[:, _TRIANGLES].reshape(-1, 3)
    speed = np.linalg.norm(velocity[used], axis=1)
    return Section(mesh.points[used][:, [0, 2]], triangles, speed, title)
