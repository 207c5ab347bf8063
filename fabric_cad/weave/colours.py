"""The colours of every picture and STEP file."""

from __future__ import annotations

from types import MappingProxyType

from .bodies import Body
from .directions import Direction

COLOURS = MappingProxyType({Direction.WEFT: (0.88, 0.52, 0.18), Direction.WARP: (0.20, 0.42, 0.62)})
"""Red, green, blue of the yarns of either direction, from 0 to 1."""

BETWEEN = (0.80, 0.80, 0.74)
"""Red, green, blue of what lies between the yarns, from 0 to 1."""


def colour_of(body: Body) -> tuple[float, float, float]:
    """Red, green, blue of a body, from 0 to 1."""
    return BETWEEN if body.direction is None else COLOURS[body.direction]
