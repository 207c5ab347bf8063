"""The nodes of the yarns' skins, station by station along the plan grid.

A section's outline, seen against the direction of travel::

          top 0 ... columns
         _.-*----*----*-._
    left *               * right     upright sides: ``upright`` edges (none in a lenticular section)
         '-.*----*----*.-'
          bottom 0 ... columns
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..meshing.closed import outline_nodes
from ..meshing.mesh import Mesh
from ..meshing.plan import Plan
from ..meshing.section_mesh import Around
from ..model.solved import SolvedFabric
from ..support.errors import BuildError
from ..weave.bodies import SurfaceKind
from ..weave.directions import Direction

_PLACE = 1e-6  # mm, within which a node of the mesh stands where the plan has it


@dataclass(frozen=True, eq=False)
class Strip:
    """A yarn's skin as node numbers.

    ``bottom`` and ``top`` (stations, columns + 1), ``left`` and ``right`` (stations, upright + 1)
    from the lower corner to the upper; ``high`` tells for each crossing whether the yarn passes
    over. Station 0 is the yarn's start, the last one its end, a period further.
    """

    direction: Direction
    index: int
    high: tuple[bool, ...]
    bottom: np.ndarray
    top: np.ndarray
    left: np.ndarray
    right: np.ndarray

    def side(self, right: bool) -> np.ndarray:
        """``left`` or ``right``."""
        return self.right if right else self.left

    @property
    def everything(self) -> np.ndarray:
        """All of them side by side, (stations, nodes)."""
        return np.hstack([self.bottom, self.top, self.left, self.right])


def strips_of(mesh: Mesh, fabric: SolvedFabric, plans: Sequence[Plan]) -> list[Strip]:
    """The skins of the yarns of a mesh, which has its nodes where the plans have them.

    Raises :class:`BuildError` where it has not.
    """
    from scipy.spatial import cKDTree

    strips = []
    for plan in plans:
        own = mesh.nodes_of(plan.yarn.body, SurfaceKind.CONTACT, SurfaceKind.FREE)
        places = fabric.lattice.to_space(outline_nodes(fabric, plan))
        if not len(own):
            raise BuildError(f"{plan.yarn.name}: the mesh has no such yarn")
        distance, nearest = cKDTree(mesh.points[own]).query(places, distance_upper_bound=_PLACE)
        if not np.isfinite(distance).all():
            raise BuildError(f"{plan.yarn.name}: the mesh has no node where its plan has one")
        strips.append(_strip(plan, own[nearest]))

    return strips


def _strip(plan: Plan, outline: np.ndarray) -> Strip:
    """The skin of a yarn from its outline's nodes (stations, outline)."""
    edges = upright(plan)
    around = Around.of(outline.shape[1] // 2 - edges, edges)
    return Strip(
        direction=plan.yarn.direction,
        index=plan.yarn.index,
        high=plan.yarn.high,
        bottom=outline[:, around.bottom],
        right=outline[:, around.right],
        top=outline[:, around.top],
        left=outline[:, around.left],
    )


def upright(plan: Plan) -> int:
    """Edges of a section's outline between its bottom and its top, on either side."""
    if "right" in plan.strips:
        return len(plan.strips["right"][0]) - 1
    if plan.sections[0].rounded:
        return sum(len(plan.strips[f"right_{level}"][0]) - 1 for level in ("lower", "upper"))
    return 0


def of_direction(strips: Sequence[Strip], direction: Direction) -> list[Strip]:
    """Those of one direction, in their order."""
    return [strip for strip in strips if strip.direction is direction]
