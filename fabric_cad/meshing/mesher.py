"""The door to gmsh: STEP to hexahedra, and a mesh file back to arrays.

gmsh reads the STEP, spaces nodes on every edge so that layers of them are vertical planes,
and meshes the yarns' faces transfinitely. A :mod:`template <fabric_cad.meshing.templates>` then fills each layer of
nodes between the faces, and two layers in a row bound the hexahedra.
"""

from __future__ import annotations

import atexit
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType

import numpy as np

from ..model.solved import SolvedFabric
from ..support.errors import BuildError, expect
from ..support.interrupts import uninterrupted
from ..weave.bodies import Body, Surface, SurfaceKind
from ..weave.directions import Direction
from ..weave.lattice import Lattice
from ..weave.weaves import yarns_of
from .count import hexahedra
from .mesh import Mesh
from .options import MeshOptions
from .plan import Plan, plan_yarns

_HEXAHEDRON, _QUADRILATERAL = 5, 3  # gmsh's element types
_PLACE = 1e-6  # mm, by which a face's nodes are told apart


@contextmanager
def _session() -> Iterator:
    """gmsh with an empty model and its own options; started once a process and ended with it."""
    with uninterrupted():
        import gmsh

        if not gmsh.isInitialized():
            gmsh.initialize(["-nopopup"], readConfigFiles=False, interruptible=False)
            atexit.register(_end, gmsh)
    try:
        gmsh.option.restoreDefaults()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.AbortOnError", 2)
        yield gmsh
    finally:
        gmsh.clear()


def _end(gmsh) -> None:
    if gmsh.isInitialized():
        gmsh.finalize()


def mesh_cell(step: str | Path, fabric: SolvedFabric, options: MeshOptions, msh: str | Path) -> None:
    """Mesh the STEP of a fabric's cell with hexahedra and write it as gmsh 4.1.

    Raises :class:`InputError` where the options do not fit the section, :class:`BuildError`
    where gmsh or the STEP does not give what the fabric asks for.
    """
    expect(fabric, SolvedFabric, "fabric", " (identify(table)['name'] gives one)")
    expect(options, MeshOptions, "options")
    options.check(fabric)
    with _session() as gmsh:
        try:
            _mesh(gmsh, Path(step), fabric, options, Path(msh))
        except BuildError:
            raise
        except MemoryError as error:
            raise BuildError(f"out of memory while meshing {hexahedra(fabric, options)} hexahedra") from error
        except Exception as error:  # gmsh raises bare Exception
            raise BuildError(f"gmsh: {str(error) or 'no reason given'}") from error


def _mesh(gmsh, step: Path, fabric: SolvedFabric, options: MeshOptions, msh: Path) -> None:
    gmsh.option.setNumber("Geometry.OCCBoundsUseStl", 0)
    gmsh.merge(str(step))
    solids = {gmsh.model.getEntityName(3, tag).split("/")[-1]: tag for _, tag in gmsh.model.getEntities(3)}
    plans = plan_yarns(fabric, yarns_of(fabric.weave.interlacement()), options)
    if missing := [plan.yarn.name for plan in plans if plan.yarn.name not in solids]:
        raise BuildError(f"{step}: holds no solid named {', '.join(missing)}")
    lattice = fabric.lattice
    faces = {plan.yarn.name: _classify(gmsh, plan, lattice, solids[plan.yarn.name]) for plan in plans}
    curves = {plan.yarn.name: list(_curves(gmsh, plan, lattice, faces[plan.yarn.name])) for plan in plans}
    for plan in plans:
        _set_transfinite(gmsh, faces[plan.yarn.name], curves[plan.yarn.name])
    gmsh.option.setNumber("Mesh.MeshOnlyVisible", 1)
    gmsh.model.setVisibility([(2, each[side]) for each in faces.values() for side in ("start", "end")], 0)
    gmsh.model.mesh.generate(1)
    for plan in plans:
        _space(gmsh, curves[plan.yarn.name])
    gmsh.model.mesh.generate(2)
    for plan in plans:
        _fill(gmsh, plan, lattice, solids[plan.yarn.name], faces[plan.yarn.name])
    for plan in plans:
        _name(gmsh, plan, solids[plan.yarn.name], faces[plan.yarn.name])
    gmsh.model.mesh.renumberNodes()
    gmsh.model.mesh.renumberElements()
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(msh))


def _classify(gmsh, plan: Plan, lattice: Lattice, solid: int) -> dict:
    """Faces of a yarn by place: ``start``, ``end`` and (segment, side).

    A face is told by its middle: which control planes it lies between, and which strip of
    the model's skin has its middle nearest.
    """
    faces: dict = {}
    for _, face in gmsh.model.getBoundary([(3, solid)], oriented=False):
        low, high = gmsh.model.getParametrizationBounds(2, face)
        middle = (low + high) / 2
        points = gmsh.model.getValue(2, face, [low[0], middle[1], *middle, high[0], middle[1]]).reshape(-1, 3)
        points = lattice.to_woven(points)
        along = points[:, plan.along_axis]
        if np.ptp(along) < _PLACE:
            faces["start" if along[0] < plan.places.mean() else "end"] = face
            continue
        segment = int(np.searchsorted(plan.places, along[1])) - 1
        sides, middles = plan.middles[segment]
        across = points[1, 1 - plan.along_axis] - plan.centre
        distances = np.hypot(middles[:, 0] - across, middles[:, 1] - points[1, 2])
        faces[segment, sides[int(distances.argmin())]] = face
    expected = len(plan.strips) * len(plan.layers) + 2
    if len(faces) != expected:
        raise BuildError(f"{plan.yarn.name} has {len(faces)} faces that can be told apart, not {expected}")
    return faces


def _curves(gmsh, plan: Plan, lattice: Lattice, faces: dict) -> Iterator[tuple[int, np.ndarray]]:
    """Every edge of a yarn's skin and the shares of its parameter at which its nodes lie."""
    seen = set()
    for key, face in faces.items():
        if key in ("start", "end"):
            continue
        segment, side = key
        for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False):
            if curve in seen:
                continue
            seen.add(curve)
            low, high = gmsh.model.getParametrizationBounds(1, curve)
            start, end = lattice.to_woven(gmsh.model.getValue(1, curve, [low[0], high[0]]).reshape(2, 3))
            axis = 2 if side in ("left", "right") else 1 - plan.along_axis
            shares = plan.strips[side][1]
            if abs(start[plan.along_axis] - end[plan.along_axis]) > _PLACE:
                axis, shares = plan.along_axis, plan.layers[segment]
            yield curve, shares if start[axis] < end[axis] else 1 - shares[::-1]


def _set_transfinite(gmsh, faces: dict, curves: list) -> None:
    for curve, shares in curves:
        gmsh.model.mesh.setTransfiniteCurve(curve, len(shares))
    for key, face in faces.items():
        if key not in ("start", "end"):
            gmsh.model.mesh.setTransfiniteSurface(face)
            gmsh.model.mesh.setRecombine(2, face)


def _space(gmsh, curves: list) -> None:
    """Move the nodes of every edge to their shares of its parameter, which runs with x, y or z.

    gmsh spaces them by arc length, which differs between the two edges of a yarn.
    """
    for curve, shares in curves:
        tags, _, at = gmsh.model.mesh.getNodes(1, curve, returnParametricCoord=True)
        low, high = gmsh.model.getParametrizationBounds(1, curve)
        parameters = low[0] + (high[0] - low[0]) * shares[1:-1]
        places = gmsh.model.getValue(1, curve, parameters).reshape(-1, 3)
        for tag, place, parameter in zip(tags[np.argsort(at)], places, parameters):
            gmsh.model.mesh.setNode(tag, place, [parameter])


def _fill(gmsh, plan: Plan, lattice: Lattice, solid: int, faces: dict) -> None:
    """Add the inner nodes, the hexahedra, and the quadrilaterals of both end sections."""
    tags, places = _outline(gmsh, plan, faces)
    template = plan.template
    inner = np.einsum("io,roc->ric", template.weights, places)
    if plan.moved is not None:
        moved = np.zeros_like(inner)
        moved[..., [1 - plan.along_axis, 2]] = plan.moved
        inner += lattice.to_space(moved)
    first = int(gmsh.model.mesh.getMaxNodeTag()) + 1
    inner_tags = np.arange(first, first + inner.shape[0] * inner.shape[1]).reshape(inner.shape[:2])
    quads = template.quads if plan.yarn.direction is Direction.WEFT else template.quads[:, ::-1]
    layer_tags = np.hstack([tags, inner_tags])
    for entity, rows in (((3, solid), slice(1, -1)), ((2, faces["start"]), [0]), ((2, faces["end"]), [-1])):
        gmsh.model.mesh.addNodes(*entity, inner_tags[rows].ravel(), inner[rows].ravel())
    gmsh.model.mesh.addElementsByType(faces["start"], _QUADRILATERAL, [], layer_tags[0][quads[:, ::-1]].ravel())
    gmsh.model.mesh.addElementsByType(faces["end"], _QUADRILATERAL, [], layer_tags[-1][quads].ravel())
    hexahedra = np.concatenate([layer_tags[:-1][:, quads], layer_tags[1:][:, quads]], axis=2)
    gmsh.model.mesh.addElementsByType(solid, _HEXAHEDRON, [], hexahedra.ravel())


def _outline(gmsh, plan: Plan, faces: dict) -> tuple[np.ndarray, np.ndarray]:
    """Tags (layers, outline) and places (layers, outline, 3) of the nodes around every layer."""
    count, outline = plan.rows[-1] + 1, plan.template.outline
    tags = np.zeros((count, outline), dtype=np.uint64)
    places = np.full((count, outline, 3), np.nan)
    for (segment, side), face in ((key, face) for key, face in faces.items() if key not in ("start", "end")):
        (slots, columns), layers = plan.strips[side], plan.layers[segment]
        found, coordinates, parameters = gmsh.model.mesh.getNodes(
            2, face, includeBoundary=True, returnParametricCoord=True
        )
        low, high = gmsh.model.getParametrizationBounds(2, face)
        share = (parameters.reshape(-1, 2) - low) / (high - low)
        row, column = (np.searchsorted((s[1:] + s[:-1]) / 2, at) for s, at in zip((layers, columns), share.T))
        if len(found) != len(layers) * len(slots) or len(np.unique(row * len(slots) + column)) != len(found):
            raise BuildError(f"gmsh did not mesh a face of {plan.yarn.name} transfinitely")
        at = plan.rows[segment] + row, slots[column]
        tags[at], places[at] = found, coordinates.reshape(-1, 3)
    return tags, places


def _name(gmsh, plan: Plan, solid: int, faces: dict) -> None:
    body = plan.yarn.body
    gmsh.model.addPhysicalGroup(3, [solid], name=body.name)
    contact = [faces[key] for key in plan.contacts]
    ends = {faces["start"], faces["end"]}
    free = [face for face in faces.values() if face not in ends and face not in set(contact)]
    for kind, tags in (
        (SurfaceKind.CONTACT, contact),
        (SurfaceKind.FREE, free),
        (SurfaceKind.START, [faces["start"]]),
        (SurfaceKind.END, [faces["end"]]),
    ):
        gmsh.model.addPhysicalGroup(2, tags, name=Surface(body, kind).name)


def read_mesh(msh: str | Path) -> Mesh:
    """Read a mesh written by :func:`mesh_cell`. Raises :class:`BuildError` where it cannot be."""
    with _session() as gmsh:
        try:
            gmsh.open(str(msh))
            return _read(gmsh)
        except Exception as error:  # gmsh raises bare Exception
            raise BuildError(f"{msh}: gmsh: {error}") from error


def _read(gmsh) -> Mesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.empty((len(tags), 3))
    index = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    order = np.argsort(tags)
    index[tags[order]] = np.arange(len(tags))
    points[:] = coordinates.reshape(-1, 3)[order]
    bodies: list[Body] = []
    hexahedra, others = [], 0
    surfaces = {}
    for dimension, group in gmsh.model.getPhysicalGroups():
        name = gmsh.model.getPhysicalName(dimension, group)
        found = []
        wanted, corners = (_HEXAHEDRON, 8) if dimension == 3 else (_QUADRILATERAL, 4)
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, group):
            for kind, elements, nodes in zip(*gmsh.model.mesh.getElements(dimension, entity)):
                if kind == wanted:
                    found.append(index[nodes].reshape(-1, corners))
                elif dimension == 3:
                    others += len(elements)
        block = np.vstack(found) if found else np.empty((0, corners), dtype=np.int64)
        if dimension == 3:
            bodies.append(Body.named(name))
            hexahedra.append(block)
        else:
            surfaces[Surface.named(name)] = block
    body = np.repeat(np.arange(len(bodies)), [len(block) for block in hexahedra])
    return Mesh(points, np.vstack(hexahedra), body, tuple(bodies), MappingProxyType(surfaces), others)
