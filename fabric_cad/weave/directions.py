"""The two directions of a woven fabric."""

from __future__ import annotations

from enum import StrEnum


class Direction(StrEnum):
    """Weft yarns run along the woven coordinate u, warp yarns along v.

    ::

        v, warp
        |
        |     z: the fabric's normal, towards the reader
        +------ u, weft
    """

    WEFT = "weft"
    WARP = "warp"

    @property
    def other(self) -> Direction:
        """The direction of the yarns that this one's cross."""
        return Direction.WARP if self is Direction.WEFT else Direction.WEFT

    @property
    def axis(self) -> int:
        """The woven coordinate along which the yarns run: 0 for u, 1 for v."""
        return 0 if self is Direction.WEFT else 1


DIRECTIONS = tuple(Direction)
