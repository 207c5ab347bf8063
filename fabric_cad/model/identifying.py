"""What identifies a row: the first quantities given that suffice, in the order of preference."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..measured.family import Family
from ..support.errors import Problem
from .closing import CLOSING, RULES
from .measured_values import Measured

SETS: tuple[tuple[int, ...], ...] = ((), *RULES)
"""What can identify a row, by number of quantities in CLOSING.

Nothing where its measurements do not suffice.
"""

_ALONE = (0, 2, 4)
"""Quantities of which any one identifies a balanced row."""


@dataclass(frozen=True, eq=False)
class Identifying:
    """Which of CLOSING identify each row: ``number``, shape (rows,), indexes :data:`SETS`."""

    number: np.ndarray

    @classmethod
    def of(cls, measured: Measured) -> Identifying:
        """The first quantity that a balanced row gives, the first three of an unbalanced one."""
        given = ~np.isnan(measured.closing)

        # every combination of given quantities as a binary number, and a last bit for balanced
        codes = 2 ** np.arange(len(CLOSING)) @ given + 2 ** len(CLOSING) * measured.balanced
        return cls(_SET_OF_CODE[codes])

    def __getitem__(self, row: int) -> tuple[int, ...]:
        return SETS[self.number[row]]

    def names(self, row: int) -> tuple[str, ...]:
        """The columns that identify a row."""
        return tuple(CLOSING[quantity] for quantity in self[row])

    def uses(self, quantity: int) -> np.ndarray:
        """Boolean (rows,): the quantity of that number in CLOSING identifies the row."""
        return self.where(lambda quantities: quantity in quantities)

    def where(self, test: Callable[[tuple[int, ...]], bool]) -> np.ndarray:
        """Boolean (rows,): the row's set passes a test."""
        return np.array([bool(test(quantities)) for quantities in SETS])[self.number]


def _set_of(code: int) -> int:
    """The number in SETS of what a row with these given quantities is identified by."""
    given = tuple(quantity for quantity in range(len(CLOSING)) if code >> quantity & 1)
    if code >> len(CLOSING):
        return SETS.index(next(((quantity,) for quantity in _ALONE if quantity in given), ()))
    return SETS.index(given[:3] if len(given) >= 3 else ())


_SET_OF_CODE = np.array([_set_of(code) for code in range(2 ** (len(CLOSING) + 1))])


def insufficient(table: Family, measured: Measured, row: int) -> Problem:
    """Why a row's measurements do not identify it."""
    if measured.balanced[row]:
        return table.problem(
            row,
            CLOSING[0],
            "this cell is empty, and so are weft_thickness_mm and fabric_thickness_mm; "
            "a balanced fabric needs one of the three",
        )

    given = [
        column for column, value in zip(CLOSING, measured.closing[:, row]) if not np.isnan(value)
    ]
    missing = [column for column in CLOSING if column not in given]
    return table.problem(
        row,
        missing[0],
        f"this cell is empty; an unbalanced fabric needs three of {', '.join(CLOSING)}, "
        f"and {' and '.join(given) or 'none'} is given: fill {3 - len(given)} more of {', '.join(missing)}",
    )
