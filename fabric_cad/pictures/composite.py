"""A composite cell: the yarns, and the matrix around them, translucent and cut open."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..meshing.grids import grid_of
from ..meshing.mesh import Mesh
from ..weave.bodies import BodyKind
from .scene import add_yarns, finish, new_scene, offscreen, save

_OPEN = 0.5
"""Share of the cell, from its front corner along both sides, in which the matrix is taken away."""

_MATRIX = {"color": "#b8c4a0", "opacity": 0.45, "ambient": 0.35, "diffuse": 0.65, "specular": 0.1}


def draw_composite(mesh: Mesh, path: str | Path, title: str = "") -> None:
    """Draw a composite cell off-screen as PNG: of the matrix what is not at the front, where the yarns stand free."""
    offscreen()
    plotter = new_scene(off_screen=True)
    add_yarns(plotter, mesh, mesh.points, mesh.yarns)
    _add_matrix(plotter, mesh)
    finish(plotter, mesh.points, title)
    save(plotter, path)


def _add_matrix(plotter, mesh: Mesh) -> None:
    """The matrix's skin, without its front corner, and the edges of the body that is left."""
    in_matrix = np.array([body.kind is BodyKind.MATRIX for body in mesh.bodies])[mesh.body]
    middles = mesh.points[mesh.hexahedra].mean(axis=1)
    low, extent = mesh.points.min(axis=0), np.ptp(mesh.points, axis=0)
    in_front = ((middles - low)[:, :2] < _OPEN * extent[:2]).all(axis=1)

    grid = grid_of(mesh)
    grid.point_data["on_yarn"] = np.zeros(len(mesh.points), dtype=bool)
    grid.point_data["on_yarn"][mesh.hexahedra[~in_matrix]] = True
    left = grid.extract_cells(np.flatnonzero(in_matrix & ~in_front))
    skin = left.extract_surface(algorithm=None)
    is_outside = ~skin.point_data["on_yarn"][skin.regular_faces].astype(bool).all(axis=1)
    skin = skin.extract_cells(np.flatnonzero(is_outside)).extract_surface(algorithm=None)
    plotter.add_mesh(skin, **_MATRIX)
    plotter.add_mesh(
        skin.extract_feature_edges(
            feature_angle=70, boundary_edges=False, non_manifold_edges=False
        ),
        color="#606850",
        line_width=1.0,
    )
