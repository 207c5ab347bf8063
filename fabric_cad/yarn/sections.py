"""The control sections of a yarn: which section stands in each of its control planes."""

from __future__ import annotations

from collections.abc import Sequence

from ..model.solved import SolvedFabric
from ..section.frame import KINDS
from ..section.sections import contact_section, free_section
from ..section.strips import Section
from ..weave.weaves import Yarn
from .planes import ControlPlane


def control_sections(
    fabric: SolvedFabric, yarn: Yarn, planes: Sequence[ControlPlane]
) -> tuple[Section, ...]:
    """The section in every control plane of one yarn (Fig. 9, 13, 17).

    In the middle of a gap it is the symmetric one (Fig. 13b); with ``float_gap`` flat, between two
    crossings of one float, that of a flat contact on the float's side (Fig. 13a).
    """
    solved, frame = fabric.directions[yarn.direction], fabric.frame(yarn.direction)

    def touching(high: bool, left: bool, right: bool) -> Section:
        plateau = "high" if high else "low"
        free = solved.free_sides[plateau, KINDS[left + right]]
        if left and not right:
            free = free.mirrored
        return contact_section(frame, solved.contact[plateau], (left, right), free, below=high)

    in_crossings = [
        touching(*crossing) for crossing in zip(yarn.high, yarn.turns_left, yarn.turns_right)
    ]

    symmetric, flat = free_section(frame, solved.between), fabric.float_gap == "flat"
    in_gaps = [
        touching(high, False, False) if flat and same else symmetric
        for high, same in zip(yarn.high, yarn.floats_on)
    ]
    gaps = iter([*in_gaps, in_gaps[0]])  # the cell is cut in a gap, which stands at either end

    return tuple(
        next(gaps) if plane.crossing is None else in_crossings[plane.crossing] for plane in planes
    )
