"""The parabolas that bound a section, whatever its form; v across, z upwards from the midline.

A contact profile on the bottom, the crossed yarn's own trajectory, turns off at the offset d_c on
each side where that yarn changes sides::

       \\                          /
         '-.___              ___.-'       z = -b/2 + p (|v| - d_c)^2
               ''----------''
                 <- 2 d_c ->
"""

from __future__ import annotations

from typing import NamedTuple

from .frame import ContactSide, Frame, FreeSide
from .splines import Quadratic
from .strips import Strip, parabolic_strip


class Profile(NamedTuple):
    """A side of a section: the parabolas that it has left and right."""

    left: Quadratic
    right: Quadratic


def contact_profile(frame: Frame, contact: ContactSide, turns: tuple[bool, bool]) -> Profile:
    """The touching bottom, flat on a side where the crossed yarn floats on."""
    flat = Quadratic(0.0, frame.floor)
    left, right = (
        Quadratic(sign * contact.offset, frame.floor, 0.0, contact.p) if turn else flat
        for sign, turn in zip((-1, 1), turns)
    )
    return Profile(left, right)


def free_parabola_of(frame: Frame, free: FreeSide) -> Profile:
    """The free top: one parabola."""
    roof = Quadratic(free.v0, frame.ceiling, 0.0, -free.q)
    return Profile(roof, roof)


def contact_strip(frame: Frame, contact: ContactSide, profile: Profile) -> Strip:
    """The strip of the contact chord on the bottom."""
    pieces = list(profile)
    if contact.offset:
        pieces.insert(1, Quadratic(0.0, frame.floor))
    half = contact.half_chord
    return parabolic_strip("bottom", frame.breaks("bottom"), -half, half, pieces)


def free_strip(frame: Frame, free: FreeSide, profile: Profile) -> Strip:
    """The middle strip of the free top."""
    return parabolic_strip("top", frame.breaks("top"), free.left, free.right, profile[:1])


def symmetric_profiles(frame: Frame, between: FreeSide) -> tuple[Profile, Profile]:
    """Bottom and top of the section between crossings: the same parabola twice."""
    bowl = Quadratic(0.0, frame.floor, 0.0, between.q)
    roof = Quadratic(0.0, frame.ceiling, 0.0, -between.q)
    return Profile(bowl, bowl), Profile(roof, roof)
