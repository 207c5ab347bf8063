"""A cell's yarns meshed in closed form: the nodes that gmsh finds on the STEP, without CAD and gmsh.

Outline nodes are points of the exact skin; a :mod:`template <fabric_cad.meshing.templates>` fills
every layer of them. Needed where no STEP is, or where gaps are spaced otherwise than those of a dry
cell.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..model.solved import SolvedFabric
from ..weave.bodies import Surface, SurfaceKind
from ..yarn.swept import SweptYarn
from .mesh import Mesh
from .plan import Plan


def yarn_nodes(fabric: SolvedFabric, plan: Plan) -> np.ndarray:
    """All nodes of a yarn, the outline's first: (layers, nodes, 3), woven coordinates in mm."""
    template = plan.template
    assert template is not None  # plan_yarns gives one to every yarn
    outline = outline_nodes(fabric, plan)
    inner = np.einsum("io,roc->ric", template.weights, outline)
    if plan.moved is not None:
        inner[..., [1 - plan.along_axis, 2]] += plan.moved
    return np.concatenate([outline, inner], axis=1)


def outline_nodes(fabric: SolvedFabric, plan: Plan) -> np.ndarray:
    """Places (layers, outline, 3) of the nodes around every layer of a yarn, woven coordinates in mm.

    They are in the order of its template.
    """
    assert plan.template is not None
    places = np.full((plan.rows[-1] + 1, plan.template.outline, 3), np.nan)
    for patch in SweptYarn(fabric, plan.yarn).skin.patches:
        slots, columns = plan.strips[patch.side]
        layers, first = plan.layers[patch.segment], plan.rows[patch.segment]
        places[np.arange(first, first + len(layers))[:, None], slots] = patch.at(layers, columns)

    places[..., 1] += plan.centre
    return places if plan.along_axis == 0 else places[..., [1, 0, 2]]


def closed_mesh(fabric: SolvedFabric, plans: Sequence[Plan]) -> Mesh:
    """The mesh of planned yarns; nodes yarn by yarn, layer by layer, each layer's outline first.

    Surfaces are those of :class:`~fabric_cad.meshing.mesh.Mesh`.
    """
    points, hexahedra, count = [], [], 0
    surfaces: dict[Surface, np.ndarray] = {}

    for plan in plans:
        nodes = yarn_nodes(fabric, plan)
        numbers = count + np.arange(nodes.shape[0] * nodes.shape[1]).reshape(nodes.shape[:2])
        hexahedra.append(_hexahedra(plan, numbers))
        surfaces |= _surfaces(plan, numbers)
        points.append(nodes.reshape(-1, 3))
        count += numbers.size

    body = np.repeat(np.arange(len(plans)), [len(block) for block in hexahedra])
    yarns = tuple(plan.yarn.body for plan in plans)
    places = fabric.lattice.to_space(np.concatenate(points))
    return Mesh(places, np.concatenate(hexahedra), body, yarns, surfaces)


def _hexahedra(plan: Plan, numbers: np.ndarray) -> np.ndarray:
    quads = _quads(plan)
    return np.concatenate([numbers[:-1][:, quads], numbers[1:][:, quads]], axis=2).reshape(-1, 8)


def _quads(plan: Plan) -> np.ndarray:
    """The template's quadrilaterals, so that a layer and the next bound hexahedra of positive volume."""
    assert plan.template is not None
    return plan.template.quads if plan.along_axis == 0 else plan.template.quads[:, ::-1]


def _surfaces(plan: Plan, numbers: np.ndarray) -> dict[Surface, np.ndarray]:
    """Quadrilaterals of one yarn's surfaces."""
    kinds: dict[SurfaceKind, list[np.ndarray]] = {SurfaceKind.CONTACT: [], SurfaceKind.FREE: []}
    for segment, layers in enumerate(plan.layers):
        rows = numbers[plan.rows[segment] : plan.rows[segment] + len(layers)]
        for side, (slots, _) in plan.strips.items():
            sheet = rows[:, slots]
            corners = (sheet[:-1, :-1], sheet[1:, :-1], sheet[1:, 1:], sheet[:-1, 1:])
            kind = SurfaceKind.CONTACT if (segment, side) in plan.contacts else SurfaceKind.FREE
            kinds[kind].append(np.stack([corner.ravel() for corner in corners], axis=1))

    body, quads = plan.yarn.body, _quads(plan)
    return {
        **{Surface(body, kind): np.concatenate(parts) for kind, parts in kinds.items()},
        Surface(body, SurfaceKind.START): numbers[0][quads[:, ::-1]],
        Surface(body, SurfaceKind.END): numbers[-1][quads],
    }
