"""What makes a row no fabric: the first claim of the model that it breaks."""

from __future__ import annotations

import numpy as np

from ..measured.family import Family
from ..support.errors import Problem
from ..weave.directions import DIRECTIONS, Direction
from .claims import OF_DIRECTIONS, OF_FABRICS, Claim
from .form_claims import form_claims
from .solution import Solution


def refusals(table: Family, solution: Solution) -> dict[int, Problem]:
    """What is wrong with the rows that are no fabric under one solution, by row number."""
    refused: dict[int, Problem] = {}
    identified = solution.identifying.number > 0

    for claim, rows in _claims(solution):
        for row in np.flatnonzero(claim.broken(solution) & identified & rows).tolist():
            if row not in refused:
                column, message = claim.column(solution, row), claim.message(solution, row)
                refused[row] = table.problem(row, column, message)
    return refused


def _claims(solution: Solution) -> list[tuple[Claim, np.ndarray]]:
    """Every claim with the rows, boolean (rows,), that it is made of, in the order in which they are told."""
    every = np.ones(len(solution.least), dtype=bool)
    claims = [(claim, every) for claim in OF_FABRICS]
    for direction in DIRECTIONS:
        claims += [(claim, every) for claim in OF_DIRECTIONS[direction]]
        claims += _of_forms(solution, direction)
    return claims


def _of_forms(solution: Solution, direction: Direction) -> list[tuple[Claim, np.ndarray]]:
    claims = []
    for form, numbers in solution.measured.forms:
        rows = np.zeros(len(solution.least), dtype=bool)
        rows[numbers] = True
        claims += [(claim, rows) for claim in form_claims(form, direction)]
    return claims
