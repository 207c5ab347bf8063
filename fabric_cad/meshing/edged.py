"""Meshes of sections with two edges: pointed ones, and ones with upright sides.

Top and bottom share their columns of nodes, one above the other, which end at the ends of either
contact chord among others.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..section.flat import Flat
from ..section.frame import Frame
from ..section.lenticular import Lenticular
from ..support.errors import Problem
from .section_mesh import Around, Outline, SectionMesh, StripNodes, mesh_form
from .templates import Template, flat_template, lenticular_template

if TYPE_CHECKING:
    from .options import MeshOptions

_NEARLY = 0.1
"""Two half chords that differ by less than this share of a column count as nearly equal."""


class EdgedMesh(SectionMesh):
    """Columns of nodes from edge to edge; the template between them is a subclass's."""

    has_uprights: bool

    def template(self, places: np.ndarray, through: int) -> Template:
        """The template over columns at these places v, mm."""
        raise NotImplementedError

    def columns(self, frame: Frame, side: str, across: int) -> list[np.ndarray]:
        """Places of the nodes across a side, mm; in one piece where its chord reaches the edges."""
        typical, halves = _chord_ends(frame, side, across)
        counts = _column_counts(typical, across)
        middle = np.linspace(-halves[0], halves[0], counts[0] + 1)
        outer = [
            np.linspace(inner, outer, count // 2 + 1)[1:]
            for inner, outer, count in zip(halves, halves[1:], counts[1:])
        ]
        right = np.concatenate([[halves[0]], *outer])
        places = np.concatenate([-right[:0:-1], middle, right[1:]])
        places = (places - places[::-1]) / 2  # symmetric to the last bit
        if not frame.has_laterals(side):
            return [places]

        first = int(np.abs(places + frame.split(side).half_chord).argmin())
        last = len(places) - first
        return [places[: first + 1], places[first:last], places[last - 1 :]]

    def column_count(self, frame: Frame, side: str, across: int) -> int:
        """The same for both sides."""
        return sum(_column_counts(_chord_ends(frame, side, across)[0], across))

    def quadrilaterals(self, frame: Frame, across: int, through: int) -> int:
        """One in every column and layer."""
        return self.column_count(frame, "bottom", across) * through

    def outline(self, frame: Frame, across: int, through: int) -> Outline:
        """Bottom and top of the outline, cut into strips, and the upright sides."""
        columns = {side: self.columns(frame, side, across) for side in ("bottom", "top")}
        places = np.unique(np.concatenate(columns["bottom"]))
        around = Around.of(len(places) - 1, through if self.has_uprights else 0)

        strips: dict[str, StripNodes] = {}
        for side, level, nodes in (
            ("bottom", "lower", around.bottom),
            ("top", "upper", around.top),
        ):
            laterals = len(columns[side]) == 3
            names = [f"left_{level}", side, f"right_{level}"] if laterals else [side]
            first = 0
            for name, piece in zip(names, columns[side]):
                strips[name] = StripNodes(nodes[first : first + len(piece)], _shares(piece))
                first += len(piece) - 1

        if self.has_uprights:
            strips |= {
                "left": StripNodes.evenly(around.left),
                "right": StripNodes.evenly(around.right),
            }

        return Outline(self.template(places, through), strips)


class FlatMesh(EdgedMesh):
    """Layers from upright side to upright side."""

    has_uprights = True

    def template(self, places: np.ndarray, through: int) -> Template:
        """A plain grid."""
        return flat_template(len(places) - 1, through)


class LenticularMesh(EdgedMesh):
    """Layers that end in two points."""

    has_uprights = False

    def template(self, places: np.ndarray, through: int) -> Template:
        """A grid with three patches at either point."""
        k = through // 2
        near = (places[k] - places[0]) / (places[2 * k] - places[0])
        return lenticular_template(len(places) - 1, through, near)

    def quadrilaterals(self, frame: Frame, across: int, through: int) -> int:
        """Either pointed edge has 3 k^2 in place of 4 k^2, k = through / 2."""
        return super().quadrilaterals(frame, across, through) - through**2 // 2

    def fault(self, options: MeshOptions) -> Problem | None:
        """The layers are even, and the two points take four columns for every two of them."""
        if options.through % 2:
            return Problem(
                f"{options.through} is odd; a lenticular section has an even number of layers",
                column="through",
            )

        for name in ("across", "crossing"):
            if getattr(options, name) < 2 * options.through:
                return Problem(
                    f"{getattr(options, name)} is below {2 * options.through}, twice the "
                    f"{options.through} layers through the thickness, which the pointed edges "
                    "of a lenticular section take",
                    column=name,
                )

        return None

    def layers(self, through: int) -> int:
        """An even number."""
        return through + through % 2

    def least_across(self, through: int) -> int:
        """What the two points take."""
        return 2 * through

    def usual_across(self, through: int) -> int:
        """Three columns for every layer, so that some are left between the points."""
        return 3 * through


def _shares(places: np.ndarray) -> np.ndarray:
    return (places - places[0]) / (places[-1] - places[0])


def _chord_ends(frame: Frame, side: str, across: int) -> tuple[list[float], list[float]]:
    """Half widths (mm) at which columns end: typical ones of both sides, and this side's.

    Where the two chords are nearly equal there is no column for so small a difference, and each
    side has its own chord's end in the same column.
    """
    edge, half = frame.edge, frame.split(side).half_chord
    chords = [
        frame.split(each).half_chord for each in ("bottom", "top") if frame.has_laterals(each)
    ]
    if len(chords) == 2 and max(chords) - min(chords) < _NEARLY * frame.width / across:
        return [sum(chords) / 2, edge], [half, edge]

    ends = sorted({*chords, edge})
    return ends, ends


def _column_counts(ends: Sequence[float], across: int) -> list[int]:
    """Elements on the middle interval, from -ends[0] to ends[0], and on the pairs beside it.

    They are ``across`` in all, but a narrow interval gets one element still, so that there may be
    more.
    """
    pairs = [2 * max(1, round(across * (b - a) / (2 * ends[-1]))) for a, b in zip(ends, ends[1:])]
    return [max(1, across - sum(pairs)), *pairs]


mesh_form(Lenticular, LenticularMesh())
mesh_form(Flat, FlatMesh())
