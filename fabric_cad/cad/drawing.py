"""A swept yarn as CadQuery draws it: planes, wires and an edge, with the model's own poles."""

from __future__ import annotations

from collections.abc import Sequence

import cadquery as cq
import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.Geom import Geom_BSplineCurve
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TColStd import TColStd_Array1OfReal

from ..section.strips import Section
from ..weave.directions import Direction
from ..yarn.trajectory import Trajectory
from .solids import knots_and_times


def planes_of(path: Trajectory) -> list[cq.Plane]:
    """The control planes: origin on the trajectory, x across the yarn, y upwards, mm."""
    heights = [piece.poles[0] for piece in path.pieces] + [path.pieces[-1].poles[-1]]
    places = [plane.place for plane in path.planes]

    if path.direction is Direction.WEFT:
        return [
            cq.Plane((place, path.axis, height), xDir=(0, 1, 0), normal=(1, 0, 0))
            for place, height in zip(places, heights)
        ]
    return [
        cq.Plane((path.axis, place, height), xDir=(1, 0, 0), normal=(0, -1, 0))
        for place, height in zip(places, heights)
    ]


def wire_of(section: Section, plane: cq.Plane) -> cq.Wire:
    """A control section, drawn in its plane: one edge a strip, exactly."""
    edges = []
    for strip in section.strips.values():
        points = [plane.toWorldCoords((v, z)).toTuple() for v, z in strip.poles[:, :2].tolist()]
        degree = 1 if len(points) == 2 else 2
        edges.append(_spline_edge(points, strip.poles[:, 2].tolist(), strip.knots, degree))
    return cq.Wire.assembleEdges(cq.Wire.combine(edges, 1e-7)[0].Edges())


def edge_of(path: Trajectory) -> cq.Edge:
    """The trajectory as one quadratic spline along the cell, straight pieces raised to degree 2."""
    knots = [path.planes[0].place] * 3
    poles: list[tuple[float, float]] = []

    for piece in path.pieces:
        heights = piece.poles
        inner = piece.knots[piece.degree + 1 : -piece.degree - 1].tolist()
        if piece.degree == 1:
            heights = np.array([heights[0], heights.mean(), heights[1]])

        whole = np.array([piece.knots[0]] * 3 + inner + [piece.knots[-1]] * 3)
        along = (whole[1:-2] + whole[2:-1]) / 2  # Greville abscissae
        poles += list(zip(along.tolist(), heights.tolist()))[1 if poles else 0 :]
        knots += [*inner, piece.knots[-1], piece.knots[-1]]

    knots.append(knots[-1])

    weft = path.direction is Direction.WEFT
    points = [(t, path.axis, z) if weft else (path.axis, t, z) for t, z in poles]
    return _spline_edge(points, [1.0] * len(points), np.array(knots), 2)


def sweep_multisection(wires: Sequence[cq.Wire], path: cq.Edge) -> cq.Solid:
    """CadQuery's own sweep through the wires: close to the exact skin, but not it."""
    return cq.Solid.sweep_multi(list(wires), path)


def _spline_edge(
    points: Sequence[tuple[float, float, float]],
    weights: Sequence[float],
    knots: np.ndarray,
    degree: int,
) -> cq.Edge:
    poles = TColgp_Array1OfPnt(1, len(points))
    factors = TColStd_Array1OfReal(1, len(points))
    for number, (point, weight) in enumerate(zip(points, weights), start=1):
        poles.SetValue(number, gp_Pnt(*point))
        factors.SetValue(number, weight)
    values, times = knots_and_times(knots)
    curve = Geom_BSplineCurve(poles, factors, values, times, degree)
    return cq.Edge(BRepBuilderAPI_MakeEdge(curve).Edge())
