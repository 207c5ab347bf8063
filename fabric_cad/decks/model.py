"""What a load case adds to the dry cell: yarn material, contact, periodicity, fixings, steps.

The cell is periodic. What one end of a yarn moves more than the other is the cell vector's
change, and every yarn of a direction shares it through one reference node a direction. Yarns do
not reach the cell's sides, so no node is in two equations. Three fixed displacements hold the
whole in place; what holds the yarns to each other is contact.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..meshing.mesh import Mesh
from ..support.errors import BuildError
from ..weave.bodies import Body, Surface, SurfaceKind
from ..weave.directions import DIRECTIONS, Direction
from ..weave.lattice import Lattice
from .cell import ORIENTATION, cell_keywords
from .faces import touching_faces
from .keywords import (
    Boundary,
    Comment,
    Compaction,
    ContactPair,
    EngineeringConstants,
    Equation,
    Hexahedra,
    Keyword,
    Material,
    Nodes,
    NodeSet,
    Output,
    PenaltyInteraction,
    SolidSection,
    StaticStep,
    Tie,
)

_PAIRS = (("weft_top", "warp_bottom"), ("weft_bottom", "warp_top"))
_PLACE = 1e-6  # mm, within which the ends of a yarn match


@dataclass(frozen=True)
class Load:
    """A state of the cell: what its two vectors, a weft's and a warp's period, change by, each (3,) mm."""

    title: str
    weft: tuple[float, float, float]
    warp: tuple[float, float, float]

    @classmethod
    def of(cls, title: str, change: np.ndarray) -> Load:
        """The state whose vectors have changed by ``change``, (2, 3) mm."""
        weft, warp = (tuple(vector) for vector in change.tolist())
        return cls(title, weft, warp)

    @property
    def change(self) -> np.ndarray:
        """What the vectors change by, (2, 3) mm."""
        return np.array([self.weft, self.warp])


@dataclass(frozen=True)
class Touch:
    """The contact of yarns: see :class:`fabric_cad.simulation.settings.ContactLaw`.

    ``rings`` widen the patches.
    """

    kind: str
    stiffness: float
    friction: float = 0.0
    stick: float = 0.0
    rings: int = 0


def model_keywords(
    mesh: Mesh,
    lattice: Lattice,
    law: EngineeringConstants,
    hardening: float,
    touch: Touch,
    loads: Iterable[Load],
    title: str,
) -> Iterator[Keyword]:
    """A whole model: the cell of ``mesh``, which repeats as ``lattice`` says, through ``loads`` one after another.

    ``hardening`` (MPa) of the yarns' compaction, 0 for none, works in a second set of elements on
    the same nodes: it adds to the law's stress. Raises :class:`BuildError` where a yarn's two ends
    do not match.
    """
    yield Comment(f"{title}\nmm, N, MPa; axis 1 of a yarn is its fibres'")
    yield from cell_keywords(mesh, touch.rings)
    yield from _material(mesh, law, hardening)
    pairs = _touching_pairs(mesh)
    yield from _contact(pairs, touch)
    reference = {name: len(mesh.points) + 1 + at for at, name in enumerate(DIRECTIONS)}
    yield Nodes("cell_vectors", lattice.vectors, first=reference[Direction.WEFT])
    yield from periodic_equations(mesh, lattice, reference)
    for name in DIRECTIONS:
        ends = (Surface(yarn, SurfaceKind.END) for yarn in mesh.yarns if yarn.direction is name)
        yield NodeSet(f"{name}_ends", tuple(end.name for end in ends))

    yield Boundary(fixings(mesh))
    output = Output(
        tuple(f"{name}_ends" for name in DIRECTIONS),
        contact=bool(pairs) and touch.kind == "penalty",
    )
    for load in loads:
        moved = [(name, getattr(load, name)) for name in DIRECTIONS]
        driven = [
            (reference[name], axis, value)
            for name, change in moved
            for axis, value in enumerate(change, 1)
        ]
        yield StaticStep(load.title, (Boundary(tuple(driven)), output))


def _material(mesh: Mesh, law: EngineeringConstants, hardening: float) -> Iterator[Keyword]:
    yield Material("yarn", law)
    for name in DIRECTIONS:
        yield SolidSection(name, "yarn", ORIENTATION)
    if hardening:
        count = len(mesh.hexahedra)
        yield Hexahedra("compaction", np.arange(count + 1, 2 * count + 1), mesh.hexahedra + 1)
        yield Material("yarn_compaction", Compaction(hardening))
        yield SolidSection("compaction", "yarn_compaction")


def _touching_pairs(mesh: Mesh) -> list[tuple[str, str]]:
    """Slave and master surface of every contact there is."""
    present = {name for name, faces in touching_faces(mesh).items() if len(faces)}
    return [pair for pair in _PAIRS if present.issuperset(pair)]


def _contact(pairs: list[tuple[str, str]], touch: Touch) -> Iterator[Keyword]:
    if touch.kind == "tie":
        yield from (Tie(f"{slave}_on_{master}", slave, master, 1e-3) for slave, master in pairs)
    elif pairs:
        yield PenaltyInteraction("yarn_on_yarn", touch.stiffness, touch.friction, touch.stick)
        yield from (ContactPair("yarn_on_yarn", slave, master) for slave, master in pairs)


def periodic_equations(
    mesh: Mesh, lattice: Lattice, reference: dict[Direction, int]
) -> Iterator[Equation]:
    """Three equations a pair of end nodes: displacement of the end = of the start + of the reference node."""
    from scipy.spatial import cKDTree

    for yarn in mesh.yarns:
        shift = lattice.vectors[yarn.direction.axis]
        starts, ends = mesh.nodes_of(yarn, SurfaceKind.START), mesh.nodes_of(yarn, SurfaceKind.END)
        distance, partner = map(
            np.asarray, cKDTree(mesh.points[ends]).query(mesh.points[starts] + shift)
        )
        if (
            len(starts) != len(ends)
            or distance.max() > _PLACE
            or len(np.unique(partner)) != len(ends)
        ):
            raise BuildError(f"{yarn}: the nodes of its two ends do not match")

        for start, end in zip((starts + 1).tolist(), (ends[partner] + 1).tolist()):
            for axis in (1, 2, 3):
                yield Equation(
                    ((end, axis, 1.0), (start, axis, -1.0), (reference[yarn.direction], axis, -1.0))
                )


def fixings(mesh: Mesh) -> tuple[tuple[int, int, float], ...]:
    """Displacements that hold the whole cell: the middle of weft 1's start in x and z, of warp 1's in y."""
    held = []
    for direction, axes in ((Direction.WEFT, (1, 3)), (Direction.WARP, (2,))):
        yarn = Body.yarn(direction, 0)
        if Surface(yarn, SurfaceKind.START) in mesh.surfaces:
            nodes = mesh.nodes_of(yarn, SurfaceKind.START)
            places = mesh.points[nodes]
            middle = nodes[((places - places.mean(axis=0)) ** 2).sum(axis=1).argmin()]
            held += [(int(middle) + 1, axis, 0.0) for axis in axes]
    return tuple(held)
