"""What a cell is made of: its bodies, and the named parts of their surfaces.

Names such as ``weft_1`` and ``weft_1_contact`` are how files call them; they are written from these
values and read back into them where a file is read, nowhere else.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

from .directions import Direction

_YARN = re.compile(r"(weft|warp)_([1-9]\d*)")


class BodyKind(StrEnum):
    """What a body is."""

    YARN = "yarn"
    MATRIX = "matrix"


@dataclass(frozen=True)
class Body:
    """One body of a cell.

    A yarn (:class:`YarnBody`) has a direction and an index, others neither.
    """

    kind: BodyKind
    direction: Direction | None = None
    index: int | None = None

    def __post_init__(self) -> None:
        is_yarn = isinstance(self, YarnBody)
        if is_yarn != (self.kind is BodyKind.YARN) or is_yarn != (self.direction is not None):
            raise ValueError("a yarn has a direction and an index, any other body has neither")

    @staticmethod
    def yarn(direction: Direction, index: int) -> YarnBody:
        """The yarn with that index (from 0) of a direction."""
        return YarnBody(BodyKind.YARN, direction, index)

    @staticmethod
    def named(name: str) -> Body:
        """The body that a file calls so. Raises ValueError for a name that is none."""
        if match := _YARN.fullmatch(name):
            return Body.yarn(Direction(match[1]), int(match[2]) - 1)
        return Body(BodyKind(name))

    @property
    def name(self) -> str:
        """What files call it: ``weft_1``, ``warp_3``, ``matrix``."""
        return str(self.kind)

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class YarnBody(Body):
    """A yarn of a cell: its direction, and its index from 0 among the yarns of it."""

    direction: Direction
    index: int

    @property
    def name(self) -> str:
        """What files call it: ``weft_1``, ``warp_3``."""
        return f"{self.direction}_{self.index + 1}"

    def __str__(self) -> str:
        return self.name


class SurfaceKind(StrEnum):
    """A part of a yarn's surface.

    Its ends lie a period apart. In a composite it is bonded to the matrix where free.
    """

    CONTACT = "contact"
    FREE = "free"
    START = "start"
    END = "end"
    MATRIX = "matrix"


_KINDS = "|".join(SurfaceKind)


@dataclass(frozen=True)
class Surface:
    """One kind of surface of one body."""

    body: Body
    kind: SurfaceKind

    @classmethod
    def named(cls, name: str) -> Surface:
        """The surface that a file calls so. Raises ValueError for a name that is none."""
        if not (match := re.fullmatch(rf"(.+)_({_KINDS})", name)):
            raise ValueError(f"{name} names no surface")
        return cls(Body.named(match[1]), SurfaceKind(match[2]))

    @property
    def name(self) -> str:
        """What files call it: ``weft_1_contact``."""
        return f"{self.body.name}_{self.kind}"

    def __str__(self) -> str:
        return self.name
