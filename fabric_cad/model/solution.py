"""Solutions of the closing relations for all rows of a table, and which of two is taken."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..measured.family import Family
from ..support.errors import Problem
from ..weave.directions import DIRECTIONS, Direction
from .closing import BOUNDED, ROUNDING, RULES, Closed
from .contacts import BetweenValues, ContactValues
from .identifying import SETS, Identifying
from .measured_values import Measured
from .transitions import Transitions


@dataclass(frozen=True, eq=False)
class Solution:
    """One solution of the closing relations, (13) to (15), for every row; arrays of shape (rows,), mm.

    ``least`` is the least fabric thickness that the other two numbers allow where (15) bounds it.
    """

    measured: Measured
    transitions: Mapping[Direction, Transitions]
    identifying: Identifying
    closed: Closed
    least: np.ndarray

    @property
    def amplitude(self) -> dict[Direction, np.ndarray]:
        """A1 and A2."""
        return {Direction.WEFT: self.closed.A1, Direction.WARP: self.closed.A2}

    @property
    def thickness(self) -> dict[Direction, np.ndarray]:
        """b1 and b2."""
        return {Direction.WEFT: self.closed.b1, Direction.WARP: self.closed.b2}

    @cached_property
    def slope(self) -> dict[Direction, np.ndarray]:
        """Slope s of the straight segments, A = s rise. (A.27)-(A.29)"""
        return {d: self.amplitude[d] / self.transitions[d].rise for d in DIRECTIONS}

    @cached_property
    def contacts(self) -> dict[tuple[Direction, str], ContactValues]:
        """The contact sections by direction and plateau."""
        measured = self.measured
        return {
            (direction, plateau): ContactValues(
                width=measured.width[direction],
                thickness=self.thickness[direction],
                lateral_height=measured.lateral_height,
                half_chord=measured.half_chord(direction, plateau),
                free_half_chord=measured.half_chord(direction, opposite),
                offset=measured.offset[direction, plateau],
                slope=self.slope[direction.other],
            )
            for direction in DIRECTIONS
            for plateau, opposite in (("low", "high"), ("high", "low"))
        }

    def between(self, direction: Direction) -> BetweenValues:
        """The sections between crossings."""
        return BetweenValues(
            width=self.measured.width[direction],
            thickness=self.thickness[direction],
            lateral_height=self.measured.lateral_height,
            half_chord=self.measured.between_half_chord(direction),
        )


def solutions(
    measured: Measured, transitions: Mapping[Direction, Transitions], identifying: Identifying
) -> tuple[Solution, Solution]:
    """Both solutions of the two relations for every row; the same twice where one exists."""
    rows = len(identifying.number)
    amplitudes = [
        transitions[d].rise * transitions[d].slope(crimp)
        for d, crimp in zip(DIRECTIONS, measured.closing)
    ]
    values = np.concatenate([np.reshape(amplitudes, (2, rows)), measured.closing[2:]])

    first, second = (Closed(*np.full((4, rows), np.nan)) for _ in range(2))
    least = np.full(rows, np.nan)
    for number in np.unique(identifying.number[identifying.number > 0]).tolist():
        quantities, group = SETS[number], np.flatnonzero(identifying.number == number)
        given = values[np.ix_(quantities, group)]
        closed = RULES[quantities](*given)
        first.put(group, closed[0])
        second.put(group, closed[-1])
        if quantities in BOUNDED:
            least[group] = given[0] + given[1]

    one = Solution(measured, transitions, identifying, first, least)
    return one, replace(one, closed=second)


@dataclass(frozen=True, eq=False)
class Choice:
    """Which of two solutions a row takes, boolean (rows,): ``second``, and whether there are ``two``."""

    second: np.ndarray
    two: np.ndarray

    def of(self, first: Solution, second: Solution) -> tuple[Closed, Closed]:
        """What is taken, and what is not."""
        taken = second.closed.where(self.second, first.closed)
        return taken, first.closed.where(self.second, second.closed)

    def refused(
        self, first: Mapping[int, Problem], second: Mapping[int, Problem]
    ) -> dict[int, Problem]:
        """The problems of the solutions taken, by row number."""
        return {
            row: problem
            for chosen, problems in enumerate((first, second))
            for row, problem in problems.items()
            if self.second[row] == chosen
        }


def choose(
    table: Family,
    solved: tuple[Solution, Solution],
    refused: tuple[Mapping[int, Problem], Mapping[int, Problem]],
) -> Choice:
    """Where the fabric thickness leaves two solutions, the row's ``thicker`` cell decides.

    Without it the more nearly equal yarn thicknesses do, on a tie the weft as the thicker.
    """
    first, second = (solution.closed for solution in solved)
    with np.errstate(invalid="ignore"):
        apart = np.abs(first.b1 - second.b1) + np.abs(first.A1 - second.A1)
        differ = apart > ROUNDING * first.fabric
        unevenness = [np.abs(closed.b1 - closed.b2) for closed in (first, second)]
        more_even = unevenness[1] < unevenness[0] * (1 - ROUNDING)

    possible = np.ones((2, len(table)), dtype=bool)
    for row_possible, problems in zip(possible, refused):
        row_possible[list(problems)] = False

    asked_weft, asked_warp = (
        np.array([thicker == direction for thicker in table.thicker], dtype=bool)
        for direction in DIRECTIONS
    )
    by_default = np.where(possible[0] & possible[1], more_even, possible[1])
    second_taken = differ & (asked_warp | (by_default & ~asked_weft))

    return Choice(second_taken, differ & possible[0] & possible[1])
