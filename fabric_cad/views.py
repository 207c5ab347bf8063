"""Pictures and ParaView files of a mesh; the door to PyVista and VTK."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

import numpy as np

from .colours import COLOURS
from .errors import OutputError
from .interrupts import uninterrupted
from .meshing.mesh import Mesh
from .weaves import DIRECTIONS, direction_of

_SIZE = (1600, 1200)
_GLOSS = {"smooth_shading": True, "ambient": 0.32, "diffuse": 0.75, "specular": 0.15, "specular_power": 20}
_MATT = {"smooth_shading": True, "ambient": 0.6, "diffuse": 0.44, "specular": 0.0}  # colours that are to be read
_EDGE = "#202020"
_BELOW = 0.16  # of a picture's height: room for the bar
_TEXT = {"font": "arial", "font_size": 18, "color": _EDGE}
_BAR = {
    "vertical": False,
    "width": 0.5,
    "height": 0.07,
    "position_x": 0.25,
    "position_y": 0.03,
    "fmt": "%.4g",
    "title_font_size": 34,
    "label_font_size": 30,
    "font_family": "arial",
    "color": _EDGE,
}
_NICE = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
_NEAR_ZERO = 0.2  # of the greatest value
_TENSED, _UNKNOWN = (0.44, 0.46, 0.50), (0.78, 0.78, 0.78)


def _pyvista():
    """PyVista, which is loaded whole or not at all."""
    with uninterrupted():
        import pyvista

    return pyvista


def _grid(mesh: Mesh):
    pyvista = _pyvista()
    return pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: mesh.hexahedra}, mesh.points)


def scaled_jacobians(mesh: Mesh) -> np.ndarray:
    """Scaled Jacobian (elements,) of every hexahedron, as Verdict defines it."""
    return _grid(mesh).cell_quality("scaled_jacobian").cell_data["scaled_jacobian"]


def write_vtu(mesh: Mesh, quality: np.ndarray, path: str | Path) -> None:
    """Write the mesh for ParaView with yarn number (from 1), direction (0 weft, 1 warp), fibre axis and quality.

    Raises OSError where the file cannot be written whole.
    """
    grid = _described(mesh)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    grid.cell_data["scaled_jacobian"] = quality
    _write(grid, path)


def write_deformed_vtu(
    mesh: Mesh,
    displacement: np.ndarray,
    point_data: Mapping[str, np.ndarray],
    cell_data: Mapping[str, np.ndarray],
    path: str | Path,
) -> None:
    """Write a result for ParaView: the *initial* mesh with the vectors ``displacement`` to warp it by.

    The filter *Warp By Vector* takes them by itself and shows the deformed cell, magnified as
    asked for. ``displacement`` (nodes, 3) mm; ``point_data`` and ``cell_data`` map names to arrays
    (nodes, ...) and (elements, ...). Yarn number (from 1) and direction (0 weft, 1 warp) come
    along as cell data ``yarn`` and ``direction``. Raises ValueError where an array does not fit the
    mesh or takes one of these names, OSError where the file cannot be written whole.
    """
    grid = _described(mesh)
    grid.point_data["displacement"] = _checked("displacement", displacement, mesh.points.shape)
    for kind, given, there in (("point", point_data, grid.point_data), ("cell", cell_data, grid.cell_data)):
        count = len(mesh.points) if kind == "point" else len(mesh.hexahedra)
        for name, values in given.items():
            if name in there:
                raise ValueError(f"{kind} data {name} is written anyway")
            there[name] = _checked(f"{kind} data {name}", values, (count, *np.shape(values)[1:]))
    grid.point_data.active_vectors_name = "displacement"
    _write(grid, path)


def _described(mesh: Mesh):
    """The mesh with yarn number and direction of every element."""
    grid = _grid(mesh)
    direction = np.array([DIRECTIONS.index(direction_of(name)) for name in mesh.yarns])
    grid.cell_data["yarn"] = mesh.yarn.astype(np.int32) + 1
    grid.cell_data["direction"] = direction[mesh.yarn].astype(np.int8)
    return grid


def pyvista_grid(mesh: Mesh):
    """The hexahedra as :meth:`fabric_cad.meshing.Mesh.to_pyvista` describes them."""
    grid = _described(mesh)
    grid.cell_data["fibre_axis"] = mesh.fibre_axes()
    grid.field_data["yarn_names"] = list(mesh.yarns)
    return grid


def pyvista_blocks(mesh: Mesh):
    """The hexahedra as ``yarns`` and every surface under its name, in one MultiBlock."""
    pyvista = _pyvista()
    blocks = pyvista.MultiBlock({"yarns": pyvista_grid(mesh)})
    for name, quads in mesh.surfaces.items():
        nodes, corners = np.unique(quads, return_inverse=True)
        blocks[name] = pyvista.PolyData.from_regular_faces(mesh.points[nodes], corners.reshape(-1, 4))
        blocks[name].point_data["node"] = nodes
    return blocks


def _write(grid, path: str | Path) -> None:
    with uninterrupted():
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    Path(path).write_bytes(b"")  # raises where there is no writing at all, which VTK does not tell
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetCompressionLevel(1)
    writer.SetFileName(str(path))
    if not writer.Write() or writer.GetErrorCode():
        raise OSError(f"{path}: the file could not be written")


def _checked(name: str, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    if np.shape(values) != shape:
        raise ValueError(f"{name} has shape {np.shape(values)}, not {shape}")
    return np.asarray(values)


def _plotter(mesh: Mesh, **options):
    """A scene of the cell: yarns in two colours, their edges drawn, light from above and aside."""
    plotter = _scene(**options)
    _add_yarns(plotter, mesh, mesh.points, mesh.yarns)
    _light(plotter, mesh.points)
    _frame(plotter, mesh.points)
    return plotter


def _scene(**options):
    pyvista = _pyvista()
    plotter = pyvista.Plotter(window_size=_SIZE, lighting="none", **options)
    plotter.set_background("white")
    return plotter


def _skin(mesh: Mesh, points: np.ndarray, yarns: Iterable[str]):
    """The skin of some yarns with its normals, creased at true edges, and the number of every point as ``node``."""
    pyvista = _pyvista()
    wanted = set(yarns)
    quads = np.vstack([quads for name, quads in mesh.surfaces.items() if name.rsplit("_", 1)[0] in wanted])
    used, faces = np.unique(quads, return_inverse=True)
    skin = pyvista.PolyData.from_regular_faces(points[used], faces.reshape(-1, 4))
    skin.point_data["node"] = used
    return skin.compute_normals(split_vertices=True, feature_angle=60, cell_normals=False)


def _add_yarns(plotter, mesh: Mesh, points: np.ndarray, yarns: Iterable[str]) -> None:
    """Yarns in the colours of their directions."""
    for direction in DIRECTIONS:
        if named := [name for name in yarns if name.startswith(direction)]:
            skin = _skin(mesh, points, named)
            plotter.add_mesh(skin, color=COLOURS[direction], **_GLOSS)
            _add_edges(plotter, skin)


def _add_edges(plotter, skin, **options) -> None:
    edges = skin.extract_feature_edges(
        feature_angle=60, boundary_edges=True, feature_edges=True, manifold_edges=False, non_manifold_edges=False
    )
    plotter.add_mesh(edges, **{"color": _EDGE, "line_width": 1.5, "lighting": False} | options)


def _light(plotter, points: np.ndarray) -> None:
    """Light from above and aside."""
    pyvista = _pyvista()
    centre = points.mean(axis=0)
    extent = np.ptp(points, axis=0).max()
    for place, strength in (((-0.6, -1.0, 1.6), 0.85), ((1.5, 0.4, 0.8), 0.35), ((-0.3, 1.0, 0.5), 0.2)):
        plotter.add_light(
            pyvista.Light(position=centre + extent * np.array(place), focal_point=centre, intensity=strength)
        )


def _frame(plotter, points: np.ndarray, below: float = 0.0) -> None:
    """Look at a cell from the front left and above, just filling the picture over the share ``below`` of its height."""
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
    scale = 1.06 * max(height / (1 - below), width * _SIZE[1] / _SIZE[0]) / 2
    middle = middle - below * scale * up
    camera = plotter.camera
    camera.focal_point = middle
    camera.position = middle + 2 * np.ptp(points, axis=0).max() * towards
    camera.up = tuple(up)
    camera.parallel_projection = True
    camera.parallel_scale = scale
    plotter.renderer.ResetCameraClippingRange()


def draw_cell(mesh: Mesh, path: str | Path) -> None:
    """Draw a cell off-screen as PNG; no display is needed."""
    _offscreen()
    _save(_plotter(mesh, off_screen=True), path)


def draw_deformed(
    mesh: Mesh,
    displacement: np.ndarray,
    path: str | Path,
    field: np.ndarray | None = None,
    label: str = "",
    limits: tuple[float, float] | None = None,
    hide: Collection[str] = (),
    initial: bool = False,
    scale: float = 1.0,
) -> None:
    """Draw a deformed cell off-screen as PNG, as the paper's Fig. 22b-d.

    ``displacement`` (nodes, 3) mm, drawn ``scale`` times larger, which the picture then says.
    ``field`` (nodes,) colours the cell, grey where it is NaN, with a bar called ``label`` between
    ``limits``: by default round values that hold those of the yarns drawn. Colours run from blue
    over white to red where the limits are equally far from 0, else from violet to yellow. Without
    a field yarns have the colours of their directions. With ``initial`` the initial cell is drawn
    too: over a field by its edges, else as white glass over grey yarns. Yarns named in ``hide``
    are left out. Raises ValueError where an array does not fit the mesh, a name is none of its
    yarns, or none is left.
    """
    moved = mesh.points + scale * _checked("displacement", displacement, mesh.points.shape)
    field = None if field is None else _checked("field", field, mesh.points.shape[:1])
    shown = _shown(mesh, hide)
    _offscreen()
    plotter = _scene(off_screen=True)
    if field is not None:
        _add_field(plotter, _skin(mesh, moved, shown), field, label, limits)
    elif initial:
        skin = _skin(mesh, moved, shown)
        plotter.add_mesh(skin, color=_TENSED, **_GLOSS)
        _add_edges(plotter, skin)
    else:
        _add_yarns(plotter, mesh, moved, shown)
    if initial:
        _add_initial(plotter, _skin(mesh, mesh.points, shown), glass=field is None)
    if scale != 1:
        plotter.add_text(f"displacements \u00d7 {scale:g}", position=(0.03, 0.94), viewport=True, **_TEXT)
    drawn = np.unique(mesh.hexahedra[np.isin(mesh.yarn, [mesh.yarns.index(name) for name in shown])])
    seen = np.vstack([moved[drawn], mesh.points[drawn]]) if initial else moved[drawn]
    _light(plotter, seen)
    _frame(plotter, seen, below=0.0 if field is None else _BELOW)
    _save(plotter, path)


def _shown(mesh: Mesh, hide: Collection[str]) -> list[str]:
    """The yarns that are not hidden. Raises ValueError where a hidden one is none, or all are."""
    if unknown := set(hide) - set(mesh.yarns):
        raise ValueError(f"no yarn is called {', '.join(sorted(unknown))}")
    if not (shown := [name for name in mesh.yarns if name not in hide]):
        raise ValueError("no yarn is left to be drawn")
    return shown


def _add_initial(plotter, skin, glass: bool) -> None:
    """The thin edges of a skin, and the skin itself as white glass."""
    if glass:
        plotter.add_mesh(skin, color="white", opacity=0.35, smooth_shading=True, ambient=0.6, diffuse=0.4)
    _add_edges(plotter, skin, color="#707070", line_width=1.5)


def _add_field(plotter, skin, field: np.ndarray, label: str, limits: tuple[float, float] | None) -> None:
    """The skin coloured by a nodal field, grey where a corner of a face has no value, and the bar of its colours."""
    values = field[skin.point_data["node"]]
    known = np.isfinite(values)[skin.regular_faces].all(axis=1)
    low, high, steps = (*limits, 4) if limits else _limits(values[np.isfinite(values)])
    if not known.all():
        plotter.add_mesh(_part(skin, ~known), color=_UNKNOWN, **_MATT)
    if known.any():
        part = _part(skin, known)
        part.point_data["field"] = field[part.point_data["node"]]
        colours = "coolwarm" if np.isclose(low, -high) else "viridis"
        plotter.add_mesh(part, scalars="field", cmap=colours, clim=(low, high), show_scalar_bar=False, **_MATT)
        plotter.add_scalar_bar(title=f"{label}\n", n_labels=steps + 1, **_BAR)
    _add_edges(plotter, skin)


def _part(skin, faces: np.ndarray):
    """Some faces (faces,) bool of a skin, its normals kept."""
    return skin.extract_cells(np.flatnonzero(faces)).extract_surface(algorithm=None)


def _limits(values: np.ndarray) -> tuple[float, float, int]:
    """Round ends of a colour bar for any number of values, and the round steps between them.

    Symmetric where values lie far to both sides of 0; else from or to 0 where they come near it.
    """
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    if min(-low, high) > _NEAR_ZERO * max(-low, high):
        low, high = -max(-low, high), max(-low, high)
    elif abs(low) < _NEAR_ZERO * high:
        low = min(low, 0.0)
    elif abs(high) < -_NEAR_ZERO * low:
        high = max(high, 0.0)
    if not high > low:
        return low - 0.5, high + 0.5, 4
    step = (high - low) / 4
    power = 10.0 ** np.floor(np.log10(step))
    step = power * next(nice for nice in _NICE if nice * power >= step * (1 - 1e-9))
    low = step * np.floor(low / step + 1e-9)
    steps = int(np.ceil((high - low) / step - 1e-9))
    return low, low + steps * step, steps


def _offscreen() -> None:
    if not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")  # no noise about a missing X server


def _save(plotter, path: str | Path) -> None:
    from PIL import Image

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
