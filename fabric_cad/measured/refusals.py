"""Problems of the rows of a table being read, told row by row in the order of its columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from ..support.errors import Place, Problem
from .records import Record


class Step(IntEnum):
    """The order in which the problems of one row are told."""

    LINE = 0
    NAME = 1
    SHEET = 2  # cells of a workbook, by column
    CELL = 3  # texts and bounds, by column
    CHOICE = 4
    WEAVE = 5
    SCATTER = 6  # by column
    RELATION = 7


@dataclass(frozen=True)
class _Refusal:
    row: int
    step: Step
    position: int
    problem: Problem

    @property
    def order(self) -> tuple[int, int, int]:
        return self.row, self.step, self.position


class Refusals:
    """Gathers what is wrong with rows, by their numbers, of which ``names`` are the names."""

    def __init__(
        self, place: Place, records: Sequence[Record], names: Sequence[str], header: Sequence[str]
    ) -> None:
        self.place, self.records, self.names = place, records, names
        self.positions = {column: position for position, column in enumerate(header)}
        self.refusals: list[_Refusal] = []
        self.closed: set[int] = set()

    def close(self, row: int, message: str) -> None:
        """The one problem of a line whose cells cannot be told apart: nothing else of it is told."""
        self.add(row, Step.LINE, message)
        self.closed.add(row)

    def add(
        self, row: int, step: Step, message: str, column: str | None = None, named: bool = True
    ) -> None:
        """A problem of a row.

        By columns where the step is. Where it is not ``named``, its name is no name to tell.
        """
        if row in self.closed:
            return
        by_column = step in (Step.SHEET, Step.CELL, Step.SCATTER)
        position = self.positions[column] if by_column and column is not None else 0
        name = self.names[row] if named else ""
        problem = self.place.problem(message, self.records[row].line, column, name)
        self.refusals.append(_Refusal(row, step, position, problem))

    @property
    def rows(self) -> set[int]:
        """Numbers of the rows that have a problem."""
        return {refusal.row for refusal in self.refusals}

    def told(self) -> tuple[Problem, ...]:
        """All problems, in order."""
        return tuple(
            refusal.problem for refusal in sorted(self.refusals, key=lambda refusal: refusal.order)
        )
