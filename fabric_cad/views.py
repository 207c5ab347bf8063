"""Pictures and ParaView files of a mesh; the door to PyVista and VTK."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from .colours import COLOURS
from .errors import OutputError
from .meshing.mesh import Mesh
from .weaves import DIRECTIONS

_SIZE = (1600, 1200)


def _grid(mesh: Mesh):
    import pyvista

    return pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: mesh.hexahedra}, mesh.points)


def scaled_jacobians(mesh: Mesh) -> np.ndarray:
    """Scaled Jacobian (elements,) of every hexahedron, as Verdict defines it."""
    return _grid(mesh).cell_quality("scaled_jacobian").cell_data["scaled_jacobian"]


def write_vtu(mesh: Mesh, quality: np.ndarray, path: str | Path) -> None:
    """Write the mesh for ParaView with yarn number (from 1), direction (0 weft, 1 warp), fibre axis and quality.

    Raises OSError where the file cannot be written whole.
    """
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    grid = _grid(mesh)
    direction = np.array([DIRECTIONS.index(name.split("_")[0]) for name in mesh.yarns])
    grid.cell_data["yarn"] = mesh.yarn.astype(np.int32) + 1
    grid.cell_data["direction"] = direction[mesh.yarn].astype(np.int8)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    grid.cell_data["scaled_jacobian"] = quality
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetCompressionLevel(1)
    writer.SetFileName(str(path))
    if not writer.Write() or writer.GetErrorCode():
        raise OSError(f"{path}: the file could not be written")


def _plotter(mesh: Mesh, **options):
    """A scene of the cell: yarns in two colours, their edges drawn, light from above and aside."""
    import pyvista

    plotter = pyvista.Plotter(window_size=_SIZE, lighting="none", **options)
    plotter.set_background("white")
    for direction in DIRECTIONS:
        quads = np.vstack([q for name, q in mesh.surfaces.items() if name.startswith(direction)])
        used, faces = np.unique(quads, return_inverse=True)
        skin = pyvista.PolyData.from_regular_faces(mesh.points[used], faces.reshape(-1, 4))
        skin = skin.compute_normals(split_vertices=True, feature_angle=60, cell_normals=False)
        plotter.add_mesh(
            skin,
            color=COLOURS[direction],
            smooth_shading=True,
            ambient=0.32,
            diffuse=0.75,
            specular=0.15,
            specular_power=20,
        )
        edges = skin.extract_feature_edges(
            feature_angle=60, boundary_edges=True, feature_edges=True, manifold_edges=False, non_manifold_edges=False
        )
        plotter.add_mesh(edges, color="#202020", line_width=1.5, lighting=False)
    centre = mesh.points.mean(axis=0)
    extent = np.ptp(mesh.points, axis=0).max()
    for place, strength in (((-0.6, -1.0, 1.6), 0.85), ((1.5, 0.4, 0.8), 0.35), ((-0.3, 1.0, 0.5), 0.2)):
        plotter.add_light(
            pyvista.Light(position=centre + extent * np.array(place), focal_point=centre, intensity=strength)
        )
    _frame(plotter, mesh.points)
    return plotter


def _frame(plotter, points: np.ndarray) -> None:
    """Look at a cell from the front left and above, just filling the picture."""
    towards = np.array([-0.75, -1.5, 1.35]) / np.linalg.norm([-0.75, -1.5, 1.35])
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    seen = points @ np.column_stack([right, up])
    middle = points.mean(axis=0)
    middle = middle + np.column_stack([right, up]) @ (
        (seen.min(axis=0) + seen.max(axis=0)) / 2 - [middle @ right, middle @ up]
    )
    width, height = np.ptp(seen, axis=0)
    camera = plotter.camera
    camera.focal_point = middle
    camera.position = middle + 2 * np.ptp(points, axis=0).max() * towards
    camera.up = tuple(up)
    camera.parallel_projection = True
    camera.parallel_scale = 1.06 * max(height, width * _SIZE[1] / _SIZE[0]) / 2
    plotter.renderer.ResetCameraClippingRange()


def draw_cell(mesh: Mesh, path: str | Path) -> None:
    """Draw a cell off-screen as PNG; no display is needed."""
    from PIL import Image

    if not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # no noise about a missing X server
    plotter = _plotter(mesh, off_screen=True)
    try:
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
        image = plotter.screenshot(None, return_img=True)
    finally:
        plotter.close()
    Image.fromarray(image).save(path, format="PNG")


def show_cell(mesh: Mesh, title: str) -> None:
    """Show a cell in a window until it is closed. Raises :class:`OutputError` without a display."""
    if (
        os.name == "posix"
        and os.uname().sysname == "Linux"
        and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    ):
        raise OutputError("no display to open a window on (DISPLAY is not set); the picture is in the cell's folder")
    plotter = _plotter(mesh, title=title)
    plotter.add_axes()
    plotter.show()
