"""The faces and edges of a yarn's solid in gmsh, told by where they lie, and the nodes on them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..support.errors import BuildError
from ..weave.lattice import Lattice
from .plan import Plan
from .templates import Template

_PLACE = 1e-6  # mm, by which the ends of an edge or face are told apart

Edge = tuple[int, np.ndarray]
"""A curve of gmsh, and the shares from 0 to 1 of its parameter at which its nodes lie."""


@dataclass(frozen=True, eq=False)
class YarnFaces:
    """A planned yarn in gmsh: the tags of its ``solid``, of its end sections and of its skin.

    ``skin`` maps (segment, side) to faces; ``lattice`` says where woven coordinates are in space.
    """

    plan: Plan
    lattice: Lattice
    solid: int
    start: int
    end: int
    skin: Mapping[tuple[int, str], int]

    @property
    def template(self) -> Template:
        """What fills a layer of nodes. Raises ValueError where the plan has none."""
        if self.plan.template is None:
            raise ValueError(f"{self.plan.yarn.name} is planned without a template")
        return self.plan.template

    def edges(self, gmsh: Any) -> list[Edge]:
        """Every edge of the skin, once."""
        edges: dict[int, Edge] = {}
        for (segment, side), face in self.skin.items():
            for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False):
                if curve not in edges:
                    edges[curve] = curve, self._shares(gmsh, curve, segment, side)
        return list(edges.values())

    def _shares(self, gmsh: Any, curve: int, segment: int, side: str) -> np.ndarray:
        """Where the nodes of an edge of a face lie, as shares of the edge's parameter."""
        (low,), (high,) = gmsh.model.getParametrizationBounds(1, curve)
        ends = gmsh.model.getValue(1, curve, [low, high]).reshape(2, 3)
        start, end = self.lattice.to_woven(ends)

        along = self.plan.along_axis
        if abs(start[along] - end[along]) > _PLACE:
            axis, shares = along, self.plan.layers[segment]
        else:
            axis = 2 if side in ("left", "right") else 1 - along
            shares = self.plan.strips[side][1]
        return shares if start[axis] < end[axis] else 1 - shares[::-1]


def classified(gmsh: Any, plan: Plan, lattice: Lattice, solid: int) -> YarnFaces:
    """The faces of a yarn's solid by where they lie.

    A face is told by its middle: which control planes it lies between, and which strip of
    the model's skin has its middle nearest. Raises BuildError where two are taken for one.
    """
    ends: dict[str, int] = {}
    skin: dict[tuple[int, str], int] = {}

    for _, face in gmsh.model.getBoundary([(3, solid)], oriented=False):
        points = lattice.to_woven(_middle_line(gmsh, face))
        along = points[:, plan.along_axis]
        if np.ptp(along) < _PLACE:
            ends["start" if along[0] < plan.places.mean() else "end"] = face
            continue

        segment = int(np.searchsorted(plan.places, along[1])) - 1
        skin[segment, _nearest_side(plan, segment, points[1])] = face

    expected = len(plan.strips) * len(plan.layers) + 2
    if (count := len(ends) + len(skin)) != expected:
        name = plan.yarn.name
        raise BuildError(f"{name} has {count} faces that can be told apart, not {expected}")

    return YarnFaces(plan, lattice, solid, ends["start"], ends["end"], skin)


def _middle_line(gmsh: Any, face: int) -> np.ndarray:
    """Points (3, 3), mm, of a face: start, middle and end of the line along its middle."""
    low, high = gmsh.model.getParametrizationBounds(2, face)
    middle = (low + high) / 2
    parameters = [low[0], middle[1], *middle, high[0], middle[1]]
    return gmsh.model.getValue(2, face, parameters).reshape(3, 3)


def _nearest_side(plan: Plan, segment: int, point: np.ndarray) -> str:
    """The side of the skin whose middle in a segment is nearest to a point (3,), mm."""
    sides, middles = plan.middles[segment]
    across = point[1 - plan.along_axis] - plan.centre
    distances = np.hypot(middles[:, 0] - across, middles[:, 1] - point[2])
    return sides[int(distances.argmin())]


def set_transfinite(gmsh: Any, yarn: YarnFaces, edges: Iterable[Edge]) -> None:
    """Ask for quadrilaterals between as many nodes on every edge as it has shares."""
    for curve, shares in edges:
        gmsh.model.mesh.setTransfiniteCurve(curve, len(shares))
    for face in yarn.skin.values():
        gmsh.model.mesh.setTransfiniteSurface(face)
        gmsh.model.mesh.setRecombine(2, face)


def space_nodes(gmsh: Any, edges: Iterable[Edge]) -> None:
    """Move the nodes of every edge to their shares of its parameter, which runs with x, y or z.

    gmsh spaces them by arc length, which differs between the two edges of a yarn.
    """
    for curve, shares in edges:
        nodes, _, positions = gmsh.model.mesh.getNodes(1, curve, returnParametricCoord=True)
        low, high = gmsh.model.getParametrizationBounds(1, curve)
        parameters = low[0] + (high[0] - low[0]) * shares[1:-1]
        places = gmsh.model.getValue(1, curve, parameters).reshape(-1, 3)
        for node, place, parameter in zip(nodes[np.argsort(positions)], places, parameters):
            gmsh.model.mesh.setNode(node, place, [parameter])
