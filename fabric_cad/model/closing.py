"""What closes the identification: two relations between crimps, yarn and fabric thickness.

At a crossing the midlines are (b1 + b2)/2 apart. Written for a crossing with the warp on top
and for one with the weft, this gives

    A1 + A2 = b1 + b2                          from (13), (14)
    w = max(b1 + A1, b2 + A2)                  (15)

so that any three of A1, A2, b1, b2, w leave the others (in a balanced fabric any one).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

CLOSING = (
    "weft_crimp",
    "warp_crimp",
    "weft_thickness_mm",
    "warp_thickness_mm",
    "fabric_thickness_mm",
)
"""Quantities that close the identification, in the order in which they are preferred."""

ROUNDING = 1e-9
"""What is thinner than this, as a share of the fabric, is rounding and not a difference."""

_NAMES = ("A1", "A2", "b1", "b2")


@dataclass(frozen=True)
class Closed:
    """A1, A2 (amplitudes) and b1, b2 (yarn thicknesses), each shape (rows,), mm."""

    A1: np.ndarray
    A2: np.ndarray
    b1: np.ndarray
    b2: np.ndarray

    @property
    def fabric(self) -> np.ndarray:
        """Fabric thickness w. (15)"""
        return np.maximum(self.b1 + self.A1, self.b2 + self.A2)

    def where(self, mask: np.ndarray, other: Closed) -> Closed:
        """This solution where ``mask``, the other elsewhere."""
        return Closed(
            *(np.where(mask, getattr(self, name), getattr(other, name)) for name in _NAMES)
        )

    def put(self, rows: np.ndarray, other: Closed) -> None:
        """Write the solution of some rows, by their numbers, into the arrays of this one."""
        for name in _NAMES:
            getattr(self, name)[rows] = getattr(other, name)


# One rule for each three of {A1, A2, b1, b2, w}: all solutions of the two relations. Where the
# fabric thickness leaves two, the first has the weft as the outer (thicker) system.
_Rule = Callable[..., tuple[Closed, ...]]


def _two_amplitudes_and_fabric(A1, A2, w):
    return Closed(A1, A2, w - A1, 2 * A1 + A2 - w), Closed(A1, A2, 2 * A2 + A1 - w, w - A2)


def _two_thicknesses_and_fabric(b1, b2, w):
    return Closed(w - b1, 2 * b1 + b2 - w, b1, b2), Closed(2 * b2 + b1 - w, w - b2, b1, b2)


def _weft_alone_and_fabric(A1, b1, w):
    return (Closed(A1, (w - A1 + b1) / 2, b1, (w + A1 - b1) / 2),)


def _warp_alone_and_fabric(A2, b2, w):
    return (Closed((w - A2 + b2) / 2, A2, (w + A2 - b2) / 2, b2),)


def _weft_crimp_warp_thickness_and_fabric(A1, b2, w):
    weft_outside = Closed(A1, w + b2 - 2 * A1, w - A1, b2)
    return (weft_outside.where(A1 >= b2, Closed(A1, w - b2, A1 + w - 2 * b2, b2)),)


def _warp_crimp_weft_thickness_and_fabric(A2, b1, w):
    warp_outside = Closed(w + b1 - 2 * A2, A2, b1, w - A2)
    return (warp_outside.where(A2 >= b1, Closed(w - b1, A2, b1, A2 + w - 2 * b1)),)


RULES: dict[tuple[int, ...], _Rule] = {
    (0, 1, 2): lambda A1, A2, b1: (Closed(A1, A2, b1, A1 + A2 - b1),),
    (0, 1, 3): lambda A1, A2, b2: (Closed(A1, A2, A1 + A2 - b2, b2),),
    (0, 1, 4): _two_amplitudes_and_fabric,
    (0, 2, 3): lambda A1, b1, b2: (Closed(A1, b1 + b2 - A1, b1, b2),),
    (1, 2, 3): lambda A2, b1, b2: (Closed(b1 + b2 - A2, A2, b1, b2),),
    (0, 2, 4): _weft_alone_and_fabric,
    (1, 3, 4): _warp_alone_and_fabric,
    (0, 3, 4): _weft_crimp_warp_thickness_and_fabric,
    (1, 2, 4): _warp_crimp_weft_thickness_and_fabric,
    (2, 3, 4): _two_thicknesses_and_fabric,
    # balanced: A = b, w = 2 A
    (0,): lambda A: (Closed(A, A, A, A),),
    (2,): lambda b: (Closed(b, b, b, b),),
    (4,): lambda w: (Closed(w / 2, w / 2, w / 2, w / 2),),
}

BOUNDED = ((0, 1, 4), (2, 3, 4), (0, 2, 4), (1, 3, 4))
"""Sets in which the sum of the first two is the least fabric thickness there is."""

ALONE: dict[tuple[int, ...], str] = {(0, 2, 4): "warp", (1, 3, 4): "weft"}
"""Sets that tell of one direction only where that one reaches the fabric's faces: then (15)
repeats what crimp and thickness say, and the other direction is left open."""

SYMBOLS = ("A1", "A2", "b1", "b2", "w")
