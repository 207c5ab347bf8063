"""Skins to solids: each patch becomes a B-spline face with the very same poles."""

from __future__ import annotations

import cadquery as cq
import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_Sewing
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal

from ..section.strips import Section
from ..support.errors import BuildError
from ..weave.directions import Direction
from ..weave.lattice import AS_WOVEN, Lattice
from ..yarn.skin import Patch, Skin, skin
from ..yarn.trajectory import Trajectory

_SEWING_TOLERANCE = 1e-7  # mm, OCCT's confusion; the edges sewn agree to rounding


def sweep(path: Trajectory, sections: tuple[Section, ...], lattice: Lattice = AS_WOVEN) -> cq.Solid:
    """One valid solid: the control sections swept along a trajectory, exactly.

    It lies where ``lattice`` puts it. Raises :class:`BuildError` where OCCT does not close it to a
    valid solid.
    """
    return solid_of(skin(path, sections), lattice)


def solid_of(surface: Skin, lattice: Lattice = AS_WOVEN) -> cq.Solid:
    """The solid bounded by a skin and its two end sections."""
    faces = [face_of(patch, surface, lattice) for patch in surface.patches]
    open_shell, rim = sew(faces)

    along = lattice.woven_coordinate(surface.direction.axis)
    places = surface.planes[0].place, surface.planes[-1].place
    ends = [_cap(rim, along, place) for place in places]
    shell, _ = sew([*open_shell.Faces(), *ends])

    solid = cq.Solid.makeSolid(shell) if isinstance(shell, cq.Shell) else None
    if solid is None or not solid.isValid():
        yarn = f"the {surface.direction} at {surface.axis:g} mm"
        raise BuildError(f"{yarn} does not close to a valid solid")
    return solid


def face_of(patch: Patch, surface: Skin, lattice: Lattice) -> cq.Face:
    """The face of a patch, with the patch's own poles, where the lattice puts them."""
    t, v, z, weight = np.moveaxis(patch.poles, 2, 0)
    plan = (t, v + surface.axis) if surface.direction == Direction.WEFT else (v + surface.axis, t)
    places = lattice.to_space(np.stack([*plan, z], axis=2))

    rows, columns = weight.shape
    poles = TColgp_Array2OfPnt(1, rows, 1, columns)
    weights = TColStd_Array2OfReal(1, rows, 1, columns)

    for i, (row, shares) in enumerate(zip(places.tolist(), weight.tolist()), start=1):
        for j, (place, share) in enumerate(zip(row, shares), start=1):
            poles.SetValue(i, j, gp_Pnt(*place))
            weights.SetValue(i, j, share)

    (along, along_degree), (across, across_degree) = patch.along, patch.across
    u_knots, u_times = knots_and_times(along)
    v_knots, v_times = knots_and_times(across)
    knots = u_knots, v_knots, u_times, v_times, along_degree, across_degree
    if (weight != 1.0).any():
        spline = Geom_BSplineSurface(poles, weights, *knots)
    else:
        spline = Geom_BSplineSurface(poles, *knots)

    return cq.Face(BRepBuilderAPI_MakeFace(spline, _SEWING_TOLERANCE).Face())


def knots_and_times(knots: np.ndarray) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """The distinct knots and how often each stands, as OCCT takes them."""
    distinct, times = np.unique(knots, return_counts=True)
    values = TColStd_Array1OfReal(1, len(distinct))
    multiplicities = TColStd_Array1OfInteger(1, len(distinct))
    for i, (knot, count) in enumerate(zip(distinct.tolist(), times.tolist()), start=1):
        values.SetValue(i, knot)
        multiplicities.SetValue(i, count)
    return values, multiplicities


def sew(faces: list[cq.Face]) -> tuple[cq.Shape, list[cq.Edge]]:
    """The faces sewn, and those of its edges that bound one face only, in its order."""
    sewing = BRepBuilderAPI_Sewing(_SEWING_TOLERANCE)
    for face in faces:
        sewing.Add(face.wrapped)
    sewing.Perform()
    sewn = cq.Shape.cast(sewing.SewedShape())
    free = {cq.Shape.cast(sewing.FreeEdge(i)) for i in range(1, sewing.NbFreeEdges() + 1)}
    return sewn, [edge for edge in sewn.Edges() if edge in free]


def _cap(rim: list[cq.Edge], along: np.ndarray, place: float) -> cq.Face:
    """The planar end section, from those of the edges the skin ends in that lie there.

    ``along`` (3,) times a point of space is the woven coordinate along the yarn, mm.
    """

    def lies_there(edge: cq.Edge) -> bool:
        ends = edge.startPoint(), edge.endPoint()
        return all(abs(along @ end.toTuple() - place) < _SEWING_TOLERANCE for end in ends)

    edges = [edge for edge in rim if lies_there(edge)]
    return cq.Face.makeFromWires(cq.Wire.assembleEdges(edges))
