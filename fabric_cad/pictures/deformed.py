"""A deformed cell: a picture, coloured by a field."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np

from ..meshing.mesh import Mesh
from ..support.arrays import checked
from ..weave.bodies import YarnBody
from .limits import limits_of
from .scene import EDGE, SIZE, add_lines, add_yarns, finish, new_scene, offscreen, save, surface
from .skin import skin_of

_MATT = {
    "smooth_shading": True,
    "ambient": 0.6,
    "diffuse": 0.44,
    "specular": 0.0,
}  # colours that are to be read
_UNKNOWN = (0.78, 0.78, 0.78)
_BELOW = 0.16  # of a picture's height: room for the bar
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
    "color": EDGE,
}
_SHOWN = 0.99  # of a picture that lies between the ends of its colours
_NOTHING = 0xFFFFFF  # the colour of the ground, the number of no face


def draw_deformed(
    mesh: Mesh,
    displacement: np.ndarray,
    path: str | Path,
    field: np.ndarray | None = None,
    label: str = "",
    limits: tuple[float, float] | None = None,
    hide: Collection[str] = (),
    title: str = "",
) -> None:
    """Draw a deformed cell off-screen as PNG, as the paper's Fig. 22b and d.

    ``displacement`` (nodes, 3) mm, drawn as large as it is. ``field`` (nodes,) colours the cell,
    grey where it is NaN, with a bar called ``label`` between ``limits``: by default round values
    that hold 99 % of what is seen; the bar's title has the least and greatest value of the yarns
    drawn. Colours run from blue over white to red where the limits are equally far from 0, else
    from violet to yellow. Without a field yarns have the colours of their directions. Yarns named
    in ``hide`` are left out; ``title`` stands above. Raises ValueError where an array does not fit
    the mesh, a name is none of its yarns, or none is left.
    """
    moved = mesh.points + checked("displacement", displacement, mesh.points.shape)
    if field is not None:
        field = checked("field", field, mesh.points.shape[:1])
    shown = _shown(mesh, hide)
    skin = skin_of(mesh, shown)
    drawn = moved[np.unique(skin.quads)]

    offscreen()
    plotter = new_scene(off_screen=True)
    if field is None:
        add_yarns(plotter, mesh, moved, shown)
        finish(plotter, drawn, title)
    else:
        add_lines(plotter, skin.lines, moved)
        finish(plotter, drawn, title, below=_BELOW)
        _add_field(plotter, surface(skin, moved), field, label, limits)

    save(plotter, path)


def _shown(mesh: Mesh, hide: Collection[str]) -> list[YarnBody]:
    """The yarns that are not hidden. Raises ValueError where a hidden one is none, or all are."""
    if unknown := set(hide) - {yarn.name for yarn in mesh.yarns}:
        raise ValueError(f"no yarn is called {', '.join(sorted(unknown))}")
    if not (shown := [yarn for yarn in mesh.yarns if yarn.name not in hide]):
        raise ValueError("no yarn is left to be drawn")
    return shown


def _add_field(
    plotter, skin, field: np.ndarray, label: str, limits: tuple[float, float] | None
) -> None:
    """The skin coloured by a nodal field, and the bar of its colours.

    A face is grey where one of its corners has no value.
    """
    values = field[skin.point_data["node"]]
    known = np.isfinite(values)[skin.regular_faces].all(axis=1)
    if limits is None:
        pixels = np.where(known, _pixels(plotter, skin), 0)
        low, high, steps = limits_of(_most(values[skin.regular_faces], pixels))
    else:
        low, high, steps = *limits, 4

    if not known.all():
        plotter.add_mesh(_part(skin, ~known), color=_UNKNOWN, **_MATT)
    if known.any():
        part = _part(skin, known)
        part.point_data["field"] = field[part.point_data["node"]]
        colours = "coolwarm" if np.isclose(low, -high) else "viridis"
        plotter.add_mesh(
            part,
            scalars="field",
            cmap=colours,
            clim=(low, high),
            show_scalar_bar=False,
            **_MATT,
        )
        inside = f"from {np.nanmin(values):.3g} to {np.nanmax(values):.3g} in all"
        plotter.add_scalar_bar(title=f"{label}; {inside}\n", n_labels=steps + 1, **_BAR)


def _most(values: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Two values between which lies the share _SHOWN of a picture.

    ``values`` (faces, 4) at the corners, ``pixels`` (faces,) that each covers.
    """
    seen = pixels > 0
    if not seen.any():
        return values[np.isfinite(values)]
    inside, weights = values[seen].ravel(), np.repeat(pixels[seen], values.shape[1])
    order = np.argsort(inside)
    shares = np.cumsum(weights[order]) / weights.sum()
    ends = np.searchsorted(shares, [(1 - _SHOWN) / 2, (1 + _SHOWN) / 2])
    return inside[order][ends]


def _pixels(plotter, skin) -> np.ndarray:
    """How many pixels of every face (faces,) a scene's camera sees.

    The faces are painted in a colour each.
    """
    numbers = np.arange(skin.n_cells)
    painted = skin.copy()
    painted.cell_data["number"] = np.stack([numbers >> 16, numbers >> 8, numbers], axis=1).astype(
        np.uint8
    )

    finder = new_scene(off_screen=True)
    try:
        finder.disable_anti_aliasing()
        finder.add_mesh(painted, scalars="number", rgb=True, lighting=False, smooth_shading=False)
        finder.camera = plotter.camera.copy()
        finder.renderer.ResetCameraClippingRange()
        image = finder.screenshot(None, return_img=True, window_size=SIZE).astype(np.int64)
    finally:
        finder.close()

    seen = (image[..., 0] << 16) + (image[..., 1] << 8) + image[..., 2]
    return np.bincount(seen[seen != _NOTHING], minlength=skin.n_cells)[: skin.n_cells]


def _part(skin, faces: np.ndarray):
    """Some faces (faces,) bool of a skin, its normals kept."""
    return skin.extract_cells(np.flatnonzero(faces)).extract_surface(algorithm=None)
