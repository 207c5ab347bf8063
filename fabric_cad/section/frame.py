"""What a yarn's sections have in common, and what differs between them: in numbers, whatever their form."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from .forms import Form

KINDS = ("float", "edge", "turn")
"""Contact sections: the crossed yarn floats on both sides (flat contact), turns on the right
side only, turns on both."""


@dataclass(frozen=True)
class ContactSide:
    """Contact profile at one plateau.

    The crossed yarn's parabola p (1/mm), d_c and half the contact chord, mm.
    """

    p: float
    offset: float
    half_chord: float


@dataclass(frozen=True)
class FreeSide:
    """Free parabola b/2 - q (v - v0)^2 between ``left`` and ``right``; q in 1/mm, the rest mm.

    Its ends are the points of tangency with the arcs of a round section. In other sections the
    parabola runs on to the edges, and the ends only say where its strip is split, so that
    contact at the next crossing can have a face of its own.
    """

    q: float
    v0: float
    left: float
    right: float

    @property
    def mirrored(self) -> FreeSide:
        """The same with left and right exchanged."""
        return FreeSide(self.q, -self.v0, -self.right, -self.left)


class Split(NamedTuple):
    """Where the strips of a side are split: half its contact chord and d_c, mm."""

    half_chord: float
    offset: float


@dataclass(frozen=True)
class Frame:
    """What the sections of one direction share: envelope (mm), form, and where their strips are split."""

    width: float
    thickness: float
    form: Form
    lateral_height: float
    bottom: Split
    top: Split

    @property
    def edge(self) -> float:
        """Place v of the right edge, mm."""
        return self.width / 2

    @property
    def floor(self) -> float:
        """Height of the envelope rectangle's lower side, mm."""
        return -self.thickness / 2

    @property
    def ceiling(self) -> float:
        """Height of the envelope rectangle's upper side, mm."""
        return self.thickness / 2

    @property
    def upside_down(self) -> Frame:
        """The frame of the sections mirrored at their midline."""
        return replace(self, bottom=self.top, top=self.bottom)

    def split(self, side: str) -> Split:
        """Where the ``bottom`` or ``top`` strip is split."""
        return {"bottom": self.bottom, "top": self.top}[side]

    def has_laterals(self, side: str) -> bool:
        """True where the contact chord of the ``bottom`` or ``top`` ends before the edges."""
        return self.split(side).half_chord < self.width / 2 * (1 - 1e-12)

    def breaks(self, side: str) -> list[float]:
        """Inner and outer breaks of a side's middle strip, as shares from 0 to 1."""
        half_chord, offset = self.split(side)
        if offset == 0.0:
            return [0.0, 0.5, 1.0]
        share = offset / (2 * half_chord)
        return [0.0, 0.5 - share, 0.5 + share, 1.0]
