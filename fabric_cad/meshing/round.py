"""Meshes of round sections: an inner block in one ring, chosen and smoothed for all yarns of a direction."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..section.frame import Frame
from ..section.round import Round
from ..support.errors import Problem
from ..weave.directions import DIRECTIONS
from .rings import Span, fill_rings
from .section_mesh import Around, Outline, SectionMesh, StripNodes, mesh_form

if TYPE_CHECKING:
    from ..weave.weaves import Yarn
    from .options import MeshOptions
    from .plan import Plan
    from .templates import Template


class RoundMesh(SectionMesh):
    """``across`` elements on either chord, and the arcs follow."""

    usual_through = 4

    def columns(self, frame: Frame, side: str, across: int) -> list[np.ndarray]:
        """Places of the nodes left of the chord, on it, and right of it, mm."""
        half = frame.split(side).half_chord
        outside = np.linspace(half, frame.edge, _lateral_count(frame, side, across) + 1)
        return [-outside[::-1], np.linspace(-half, half, across + 1), outside]

    def column_count(self, frame: Frame, side: str, across: int) -> int:
        """Those on the chord and on two arcs."""
        return across + 2 * _lateral_count(frame, side, across)

    def quadrilaterals(self, frame: Frame, across: int, through: int) -> int:
        """A block of two layers less in a ring without corners."""
        return (across + 2) * through - 4

    def outline(self, frame: Frame, across: int, through: int) -> Outline:
        """Bottom, top and the four arcs; the ring's template is chosen in :meth:`completed`."""
        upright = through - 2  # the ring adds a layer below and above
        around, half = Around.of(across, upright), upright // 2

        slots = {
            "bottom": around.bottom,
            "top": around.top,
            "right_lower": around.right[: half + 1],
            "right_upper": around.right[half:][::-1],
            "left_lower": around.left[: half + 1][::-1],
            "left_upper": around.left[half:],
        }
        return Outline(None, {side: StripNodes.evenly(nodes) for side, nodes in slots.items()})

    def completed(self, plans: list[Plan], options: MeshOptions) -> list[Plan]:
        """The plans with one ring for all yarns of a direction, smoothed section by section."""
        rings: dict[Yarn, tuple[Template, np.ndarray]] = {}
        for direction, across in zip(DIRECTIONS, (options.across, options.crossing)):
            alike = [plan for plan in plans if plan.yarn.direction == direction]
            spans = [
                list(map(Span, plan.sections, plan.sections[1:], plan.layers)) for plan in alike
            ]
            if spans:
                template, moved = fill_rings(spans, alike[0].strips, across, options.through - 2)
                rings |= {plan.yarn: (template, shift) for plan, shift in zip(alike, moved)}

        return [
            replace(plan, template=rings[plan.yarn][0], moved=rings[plan.yarn][1]) for plan in plans
        ]

    def fault(self, options: MeshOptions) -> Problem | None:
        """The layers are even and at least four."""
        if options.through % 2 or options.through < 4:
            return Problem(
                f"{options.through} is not an even number of at least 4, as a round section needs",
                column="through",
            )
        return None

    def layers(self, through: int) -> int:
        """An even number of at least four."""
        return max(through + through % 2, 4)


def _lateral_count(frame: Frame, side: str, across: int) -> int:
    """Elements on either arc of a side, about as long as the ``across`` ones on its chord."""
    half = frame.split(side).half_chord
    return max(1, round(across * (frame.edge - half) / (2 * half)))


mesh_form(Round, RoundMesh())
