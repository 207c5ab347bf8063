"""What a composite cell is asked to be: clearance, layers, their grading, and how yarns meet."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from numbers import Integral

import numpy as np

from ..support.errors import InputError, Problem
from ..support.numerals import number

CONTACTS = ("bonded", "double")
"""Yarns that touch share their nodes, or have nodes of their own inside the patch of contact."""

_LEAST_SHARE = 1e-4  # of the thickness: below it layers are thinner than a node can be placed
_MOST_LAYERS = 1000
_MOST_GRADING = 1e3


@dataclass(frozen=True)
class Margin:
    """Clearance above and below the yarns: ``amount`` in mm, or as a share of the fabric's thickness."""

    amount: float = 0.05
    is_share: bool = True

    @classmethod
    def read(cls, text: str) -> Margin:
        """``5%`` of the fabric's thickness, or ``0.04``: mm. Raises :class:`InputError`."""
        written = text.strip().removesuffix("mm").strip()
        is_share = written.endswith("%")
        try:
            amount = number(written.removesuffix("%").strip())
        except ValueError as error:
            message = f"{text!r} is neither a share of the fabric's thickness, as 5%, nor a length in mm, as 0.04"
            raise InputError(Problem(message, column="margin")) from error
        return cls(amount / 100 if is_share else amount, is_share)

    def __str__(self) -> str:
        return f"{100 * self.amount:g} %" if self.is_share else f"{self.amount:g} mm"

    def length(self, thickness: float) -> float:
        """The clearance (mm) of a fabric of a thickness (mm). Raises :class:`InputError` where it is none."""
        length = self.amount * thickness if self.is_share else self.amount
        if not isfinite(length):
            raise InputError(Problem(f"{self} is not finite", column="margin"))
        if length <= 0:
            message = f"{self} leaves no matrix: the yarns reach the fabric's faces and would touch the box"
            raise InputError(Problem(message, column="margin"))
        if length < _LEAST_SHARE * thickness:
            bound = f"{100 * _LEAST_SHARE:g} % of the fabric's thickness, {_LEAST_SHARE * thickness:.3g} mm"
            raise InputError(Problem(f"{self} is not at least {bound}", column="margin"))
        return length


@dataclass(frozen=True)
class CompositeOptions:
    """How the matrix fills the box.

    ``layers`` of hexahedra lie between the yarns and either face of the box; ``grading`` is the
    height of the layer at the box over that at the yarns, layers between follow a geometric series.

    ``contact``: ``bonded``, yarns that touch share their nodes; ``double``, each has nodes of its
    own inside their patch of contact, so that they may slide and part there. The matrix is bonded
    to the yarns either way, and closes on the rim of the patch, where all three share their nodes.
    Raises :class:`InputError`.
    """

    margin: Margin = Margin()
    layers: int = 4
    grading: float = 1.0
    contact: str = "bonded"

    def __post_init__(self) -> None:
        if not isinstance(self.layers, Integral):
            raise InputError(Problem(f"{self.layers!r} is not a whole number", column="layers"))
        if not 1 <= self.layers <= _MOST_LAYERS:
            raise InputError(
                Problem(f"{self.layers} is not from 1 to {_MOST_LAYERS}", column="layers")
            )
        if not 1 / _MOST_GRADING <= self.grading <= _MOST_GRADING:
            message = f"{self.grading:g} is not from {1 / _MOST_GRADING:g} to {_MOST_GRADING:g}"
            raise InputError(Problem(message, column="grading"))
        if self.contact not in CONTACTS:
            raise InputError(
                Problem(f"{self.contact!r} is none of {', '.join(CONTACTS)}", column="contact")
            )

    def shares(self) -> np.ndarray:
        """Where layers end on the way from the yarns, 0, to the box, 1: (layers + 1,)."""
        if self.layers == 1:
            return np.array([0.0, 1.0])
        heights = np.geomspace(1.0, self.grading, self.layers)
        ends = np.concatenate([[0.0], np.cumsum(heights)])
        return ends / ends[-1]


USUAL = CompositeOptions()
"""What a composite is where nothing else is said."""
