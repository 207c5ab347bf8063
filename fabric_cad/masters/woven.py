"""What the masters share: every yarn drawn by CadQuery, swept, and shown.

Every yarn of the elementary cell is cut by control planes: mid-gap, begin and end of each
crossing (paper, Fig. 12). In each plane stands a control section (Fig. 9, 13), and the
sections are swept along the trajectory (Fig. 11). Which yarn lies on top at each crossing,
and which section stands in a plane, is what a master says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import cadquery as cq
import numpy as np
from numpy.typing import ArrayLike

from fabric_cad.cad.drawing import edge_of, planes_of, sweep_multisection, wire_of
from fabric_cad.cad.solids import sweep
from fabric_cad.cad.step import Cell, assemble
from fabric_cad.model.solved import SolvedFabric, read_solved
from fabric_cad.section.strips import Section
from fabric_cad.support.errors import ArgumentError, InputError, Problem
from fabric_cad.weave.bodies import Body
from fabric_cad.weave.colours import colour_of as colour_of_body
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.swept import SweptYarn

SWEEPS = ("exact", "multisection")
"""The exact skin of the model, or CadQuery's own sweep through the same wires.

In a weft of the row ``plain`` points of the exact skin lie up to 0.062 mm outside the multisection
sweep (nine a patch, tests/masters/test_masters.py).
"""

Sections = Callable[[SweptYarn, int], Section]
"""The section in a yarn's control plane of a number, from 0."""


@dataclass(frozen=True, eq=False)
class Drawing:
    """A yarn of a cell in CadQuery's terms, mm."""

    name: str
    planes: list[cq.Plane]
    wires: list[cq.Wire]
    path: cq.Edge

    @property
    def frame(self) -> tuple[float, float]:
        """Extents to draw a control plane with, half as large again as the section in it, mm."""
        box = self.wires[0].BoundingBox()
        return 1.5 * max(box.xlen, box.ylen), 1.5 * box.zlen


@dataclass(frozen=True, eq=False)
class Part:
    """What CQ-editor shows: a shape, its name and, in ``options``, its colour."""

    shape: cq.Edge | cq.Wire | cq.Workplane | cq.Solid
    name: str
    options: dict[str, tuple[int, ...]] = field(default_factory=dict)


def own(swept: SweptYarn, number: int) -> Section:
    """The model's own control section in a plane."""
    return swept.sections[number]


def draw(
    fabric: SolvedFabric,
    weft_over_warp: ArrayLike,
    section: Sections = own,
) -> dict[str, Drawing]:
    """Yarn name to its planes, wires and trajectory, wefts first."""
    drawings = {}
    for yarn in yarns_of(np.asarray(weft_over_warp)):
        swept = SweptYarn(fabric, yarn)
        planes = planes_of(swept.trajectory)
        wires = [wire_of(drawn, plane) for drawn, plane in zip(_sections(swept, section), planes)]
        drawings[yarn.name] = Drawing(yarn.name, planes, wires, edge_of(swept.trajectory))
    return drawings


def parts(
    fabric: SolvedFabric,
    weft_over_warp: ArrayLike,
    section: Sections = own,
    kind: str = "exact",
) -> Iterator[Part]:
    """Everything that makes a cell, yarn by yarn: trajectory, control planes and sections, solid.

    Arguments and errors as of :func:`woven`.
    """
    solids = woven(fabric, weft_over_warp, section, kind).solids
    for name, yarn in draw(fabric, weft_over_warp, section).items():
        yield Part(yarn.path, f"{name} trajectory")  # M11 ... M16 or M21 ... M26, all along

        for number, (plane, wire) in enumerate(zip(yarn.planes, yarn.wires)):
            frame = cq.Workplane(plane).rect(*yarn.frame)  # x across the yarn, y upwards
            yield Part(frame, f"{name} plane {number}")
            yield Part(wire, f"{name} section {number}")

        yield Part(solids[name], name, {"color": colour_of(name)})


def woven(
    fabric: SolvedFabric,
    weft_over_warp: ArrayLike,
    section: Sections = own,
    kind: str = "exact",
) -> Cell:
    """The cell of a fabric; ``weft_over_warp[i][j]`` is True where weft i passes over warp j.

    Raises ArgumentError where ``kind`` is none of :data:`SWEEPS`, BuildError where OCCT makes no
    valid solid of a yarn.
    """
    if kind not in SWEEPS:
        raise ArgumentError(f"a sweep is {' or '.join(SWEEPS)}, not {kind!r}")

    if kind == "multisection":
        drawings = draw(fabric, weft_over_warp, section).values()
        solids = {yarn.name: sweep_multisection(yarn.wires, yarn.path) for yarn in drawings}
        return assemble(solids, fabric.name)

    solids = {}
    lattice = fabric.lattice
    for yarn in yarns_of(np.asarray(weft_over_warp)):
        swept = SweptYarn(fabric, yarn)
        solids[yarn.name] = sweep(swept.trajectory, _sections(swept, section), lattice)

    return assemble(solids, fabric.name)


def solved_row(path: str) -> SolvedFabric:
    """The solved row at a path, sought from the working folder, then from this file, upwards.

    Raises InputError that says how to get one where there is none.
    """
    for folder in (Path.cwd(), *Path.cwd().parents, *Path(__file__).resolve().parents):
        if (folder / path).is_file():
            return read_solved(folder / path)

    name = Path(path).parent.name
    raise InputError(Problem(f"no solved row yet; 'fabric-cad cell {name}' writes one", path))


def colour_of(name: str) -> tuple[int, ...]:
    """Red, green and blue of a yarn, 0 to 255."""
    return tuple(int(255 * share) for share in colour_of_body(Body.named(name)))


def _sections(swept: SweptYarn, section: Sections) -> tuple[Section, ...]:
    return tuple(section(swept, number) for number in range(len(swept.planes)))
