"""Sections with two edges: contact and free side run on as parabolas to v = -c/2 and +c/2."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .forms import Form, contact_strips, free_strips
from .frame import ContactSide, Frame, FreeSide
from .profiles import (
    Profile,
    contact_profile,
    contact_strip,
    free_parabola_of,
    free_strip,
    symmetric_profiles,
)
from .strips import Strip, parabolic_strip, upright_strip


@dataclass(frozen=True)
class Edged(Form):
    """A form whose contact and free side end at the section's edges, in a point or at an upright side."""

    def upright(self, frame: Frame) -> float:
        """Height of the upright sides, mm; 0 where the two sides meet in a point."""
        return 0.0


@contact_strips.register
def _(
    form: Edged, frame: Frame, contact: ContactSide, turns: tuple[bool, bool], free: FreeSide
) -> list[Strip]:
    lower, upper = contact_profile(frame, contact, turns), free_parabola_of(frame, free)
    half = contact.half_chord

    return [
        contact_strip(frame, contact, lower),
        free_strip(frame, free, upper),
        *_laterals(frame, "bottom", lower, (-half, half)),
        *_laterals(frame, "top", upper, (free.left, free.right)),
        *_uprights(frame, lower, form.upright(frame)),
    ]


@free_strips.register
def _(form: Edged, frame: Frame, between: FreeSide) -> list[Strip]:
    sides = dict(zip(("bottom", "top"), symmetric_profiles(frame, between)))
    ends = {side: (-frame.split(side).half_chord, frame.split(side).half_chord) for side in sides}
    middles = [
        parabolic_strip(side, frame.breaks(side), *ends[side], profile[:1])
        for side, profile in sides.items()
    ]
    laterals = [
        strip
        for side, profile in sides.items()
        for strip in _laterals(frame, side, profile, ends[side])
    ]
    return [*middles, *laterals, *_uprights(frame, sides["bottom"], form.upright(frame))]


def _laterals(
    frame: Frame, side: str, profile: Profile, ends: tuple[float, float]
) -> Iterator[Strip]:
    """Strips between the ends of a side's middle strip and the edges."""
    if not frame.has_laterals(side):
        return
    level = {"bottom": "lower", "top": "upper"}[side]
    left, right = ends
    yield parabolic_strip(f"left_{level}", [0.0, 1.0], -frame.edge, left, [profile.left])
    yield parabolic_strip(f"right_{level}", [0.0, 1.0], right, frame.edge, [profile.right])


def _uprights(frame: Frame, lower: Profile, height: float) -> Iterator[Strip]:
    """Upright sides on the ends of the lower profile."""
    if height:
        for side, v, parabola in zip(("left", "right"), (-frame.edge, frame.edge), lower):
            yield upright_strip(side, v, parabola.polar(v, v), height)
