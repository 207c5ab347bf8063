"""The flat section: an upright side of measured height at either edge (Fig. 17)::

_.-'''''''''''-._
.-'                 '-.
|                       |  lateral height h
'--.._           _..--'
'''-----'''
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .edged import Edged
from .frame import Frame


@dataclass(frozen=True)
class Flat(Edged):
    """Two upright sides, of the height that a row gives."""

    word: ClassVar[str] = "flat"
    takes_lateral_height: ClassVar[bool] = True

    def upright(self, frame: Frame) -> float:
        """The lateral height, mm."""
        return frame.lateral_height
