"""The round section: a circular arc joins the contact and the free side (Fig. 17)::

_.-'''''''''''-._
.-'                 '-.
(           arc, v = c/2 )
'-._             _.-'
'''-------'''
contact chord
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .conics import lateral_arc
from .forms import Form, contact_strips, free_strips
from .frame import ContactSide, Frame, FreeSide
from .profiles import (
    contact_profile,
    contact_strip,
    free_parabola_of,
    free_strip,
    symmetric_profiles,
)
from .strips import Strip, parabolic_strip


@dataclass(frozen=True)
class Round(Form):
    """Two arcs, tangent to the contact profile at its chord's ends, to the envelope and to the free side."""

    word: ClassVar[str] = "round"
    parameters: ClassVar[int] = 9


@dataclass(frozen=True)
class _Arc:
    """An arc on the right, mm and rad: from ``start`` < 0 over 0, the edge, to ``end`` > 0."""

    v: float
    z: float
    radius: float
    start: float
    end: float

    def strips(self, edge: str) -> Iterator[Strip]:
        """Its lower and its upper strip; on the ``left`` edge those of its mirror image."""
        sign = -1 if edge == "left" else 1
        for level, start in (("lower", self.start), ("upper", self.end)):
            half = (0.0 - start) / 2
            middle, weight = start + half, np.cos(half)
            polar = [(self.radius, start), (self.radius / weight, middle), (self.radius, 0.0)]
            poles = np.array(
                [[sign * (self.v + r * np.cos(a)), self.z + r * np.sin(a), 1.0] for r, a in polar]
            )
            poles[1, 2] = weight

            knots = np.array([0.0] * 3 + [1.0] * 3)
            yield Strip(f"{edge}_{level}", knots, poles[::-1] if sign < 0 else poles)


@contact_strips.register
def _(
    form: Round, frame: Frame, contact: ContactSide, turns: tuple[bool, bool], free: FreeSide
) -> list[Strip]:
    half, reach = contact.half_chord, contact.half_chord - contact.offset
    strips = [
        contact_strip(frame, contact, contact_profile(frame, contact, turns)),
        free_strip(frame, free, free_parabola_of(frame, free)),
    ]
    for edge, turn, tangency in zip(("left", "right"), turns, (free.left, free.right)):
        rise, slope = (contact.p * reach**2, 2 * contact.p * reach) if turn else (0.0, 0.0)
        radius, height = lateral_arc(frame.thickness, frame.width, half, rise, slope)
        centre = frame.edge - radius

        end = np.arccos(np.clip((abs(tangency) - centre) / radius, -1, 1))
        strips += _Arc(centre, height, radius, -np.pi / 2 + np.arctan(slope), end).strips(edge)

    return strips


@free_strips.register
def _(form: Round, frame: Frame, between: FreeSide) -> list[Strip]:
    half = between.right
    strips = [
        parabolic_strip(side, frame.breaks(side), -half, half, profile[:1])
        for side, profile in zip(("bottom", "top"), symmetric_profiles(frame, between))
    ]

    theta = np.arctan2(1.0, 2 * between.q * half)
    radius = (frame.edge - half) / (1 - np.cos(theta))
    arc = _Arc(frame.edge - radius, 0.0, radius, -theta, theta)
    return [*strips, *arc.strips("left"), *arc.strips("right")]
