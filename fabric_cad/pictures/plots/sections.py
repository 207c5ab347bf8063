"""The control sections of one direction."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from ...model.solved import SolvedFabric
from ...section.sections import contact_section, free_section
from ...section.strips import Section
from ...weave.colours import COLOURS
from ...weave.directions import Direction
from .outlines import section_outline

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CONTACTS = (
    ("float", (False, False), "contact, flat"),
    ("edge", (False, True), "contact, turn on the right"),
    ("turn", (True, True), "contact, turn on both sides"),
)
"""Kinds of contact sections, whether the crossed yarn turns left and right of them, titles."""

_RECTANGLE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])


def plot_sections(fabric: SolvedFabric, axes: Iterable[Axes], direction: str = "weft") -> None:
    """The control sections of one direction in their envelope rectangle (Fig. 17).

    ``axes`` are four: crossed yarn floats, turns on the right, turns on both sides, and
    the section between crossings.
    """
    solved, colour = fabric.directions[direction], COLOURS[Direction(direction)]
    envelope = _RECTANGLE * [solved.width / 2, solved.thickness / 2]

    for ax, (title, section) in zip(axes, _titled(fabric, direction)):
        ax.fill(*section_outline(section), color=colour, alpha=0.5)
        ax.plot(*section_outline(section), color="black", linewidth=1)
        ax.plot(*envelope.T, color="grey", linestyle=":", linewidth=1)
        ax.set(title=title, aspect="equal")


def _titled(fabric: SolvedFabric, direction: str) -> Iterator[tuple[str, Section]]:
    solved, frame = fabric.directions[direction], fabric.frame(direction)
    contact = solved.contact["high"]
    for kind, turns, title in _CONTACTS:
        free_side = solved.free_sides["high", kind]
        yield title, contact_section(frame, contact, turns, free_side, below=True)

    yield "between crossings", free_section(frame, solved.between)
