"""What the paper's model claims of a row that is a fabric, one small value a claim."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..weave.directions import DIRECTIONS, Direction
from .closing import ALONE, ROUNDING, SYMBOLS
from .plausibility import LARGEST_SLOPE, responsible, too_steep
from .solution import Solution

FABRIC_THICKNESS = 4
"""Its number in CLOSING."""


@dataclass(frozen=True)
class Claim:
    """Where it does not hold, boolean (rows,), and for such a row the column to blame and what to say."""

    broken: Callable[[Solution], np.ndarray]
    column: Callable[[Solution, int], str]
    message: Callable[[Solution, int], str]


def last_column(solution: Solution, row: int) -> str:
    """The last of the columns that identify a row."""
    return solution.identifying.names(row)[-1]


def _first_column(solution: Solution, row: int) -> str:
    return solution.identifying.names(row)[0]


def _crimp_is_reached() -> Claim:
    """The length equation has a solution. (A.11), (A.12)"""
    return Claim(
        broken=lambda solution: np.isnan(
            sum(solution.amplitude.values()) + sum(solution.thickness.values())
        ),
        column=_first_column,
        message=lambda solution, row: "no yarn of the model has this crimp",
    )


def _not_too_steep(direction: Direction) -> Claim:
    def column(solution: Solution, row: int) -> str:
        return responsible(direction, solution.identifying.names(row))

    return Claim(
        broken=lambda solution: solution.slope[direction] > LARGEST_SLOPE,
        column=column,
        message=lambda solution, row: too_steep(
            direction, solution.slope[direction][row], column(solution, row)
        ),
    )


def _thick_enough() -> Claim:
    """w is A1 + A2 = b1 + b2 at least. (13) to (15)"""

    def message(solution: Solution, row: int) -> str:
        fabric, least = solution.measured.closing[FABRIC_THICKNESS, row], solution.least[row]
        symbols = " + ".join(SYMBOLS[quantity] for quantity in solution.identifying[row][:2])
        return f"{fabric:g} is below {symbols} = {least:.4g} mm"

    return Claim(
        broken=lambda solution: (
            solution.measured.closing[FABRIC_THICKNESS] < solution.least * (1 - ROUNDING)
        ),
        column=last_column,
        message=message,
    )


def _says_something_new() -> Claim:
    """Where one direction alone reaches the fabric's faces, (15) leaves the other open."""

    def broken(solution: Solution) -> np.ndarray:
        fabric = solution.measured.closing[FABRIC_THICKNESS]
        of_one_direction = solution.identifying.where(ALONE.__contains__)
        return of_one_direction & (fabric <= solution.least * (1 + ROUNDING))

    def message(solution: Solution, row: int) -> str:
        fabric = solution.measured.closing[FABRIC_THICKNESS, row]
        left_open = ALONE[solution.identifying[row]]
        return (
            f"{fabric:g} is A + b of the same direction again and says nothing of the "
            f"{left_open}; fill {left_open}_crimp or {left_open}_thickness_mm"
        )

    return Claim(broken, last_column, message)


def _has_amplitude(direction: Direction) -> Claim:
    return Claim(
        broken=lambda solution: ~(solution.amplitude[direction] > 0),
        column=last_column,
        message=lambda solution, row: (
            f"leaves the {direction} an amplitude A of {solution.amplitude[direction][row]:.4g} mm, not above 0"
        ),
    )


def _has_thickness(direction: Direction) -> Claim:
    return Claim(
        broken=lambda solution: ~(solution.thickness[direction] > 0),
        column=last_column,
        message=lambda solution, row: (
            f"leaves the {direction} a thickness of {solution.thickness[direction][row]:.4g} mm, not above 0"
        ),
    )


def _of_fabrics() -> Iterator[Claim]:
    yield _crimp_is_reached()
    for direction in DIRECTIONS:
        yield _not_too_steep(direction)
    yield _thick_enough()
    yield _says_something_new()


OF_FABRICS = tuple(_of_fabrics())
"""Claims of both directions together, in the order in which they are told."""

OF_DIRECTIONS = {
    direction: (_has_amplitude(direction), _has_thickness(direction)) for direction in DIRECTIONS
}
"""Claims of a direction whatever the form of its sections."""
