"""The sections of a direction's yarns where they touch and between crossings, as numbers of a whole table."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TypeVar

import numpy as np

_Values = TypeVar("_Values", "ContactValues", "BetweenValues")


@dataclass(frozen=True, eq=False)
class ContactValues:
    """Contact sections of one direction at one plateau: arrays of shape (rows,), lengths mm.

    The contact profile is G(v) = p (|v| - d_c)^2 out to the ``half_chord``, where the crossed yarn
    turns (0 where it floats on), and has there the ``slope`` of the crossed yarn; the free side
    opposite is split at ``free_half_chord``::

             free_half_chord
            <------------->
         _.---------------+---._
        <                  |     >  edge_rise
         '--.._           _+..--'   rise, slope
               '''-----'''
                   <--><->
                  offset  half_chord - offset
    """

    width: np.ndarray
    thickness: np.ndarray
    lateral_height: np.ndarray
    half_chord: np.ndarray
    free_half_chord: np.ndarray
    offset: np.ndarray
    slope: np.ndarray

    @property
    def p(self) -> np.ndarray:
        """The crossed yarn's parabola, 1/mm: s = 2 p u. (A.25), (A.26)"""
        return self.slope / (2 * (self.half_chord - self.offset))

    @property
    def rise(self) -> np.ndarray:
        """G at the end of the contact chord."""
        return self.p * (self.half_chord - self.offset) ** 2

    @property
    def edge_rise(self) -> np.ndarray:
        """G carried on as a parabola to the section's edge."""
        return self.p * (self.width / 2 - self.offset) ** 2


@dataclass(frozen=True, eq=False)
class BetweenValues:
    """Sections of one direction between crossings, (rows,) mm; see there for the half chord."""

    width: np.ndarray
    thickness: np.ndarray
    lateral_height: np.ndarray
    half_chord: np.ndarray


def of_rows(values: _Values, rows: np.ndarray) -> _Values:
    """The values of some rows, by their numbers."""
    return type(values)(*(getattr(values, field.name)[rows] for field in fields(values)))
