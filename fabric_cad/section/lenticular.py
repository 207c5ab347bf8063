"""The lenticular section: contact and free side meet in a point (Fig. 9, the standard model's)::

_.-'''''''''''-._
.-'                 '-.
<                       >
'--.._           _..--'
'''-----'''
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .edged import Edged


@dataclass(frozen=True)
class Lenticular(Edged):
    """Two pointed edges."""

    word: ClassVar[str] = "lenticular"
