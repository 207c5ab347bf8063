"""One person's editing of one row: what is drawn, what is refused, and the way back.

A session knows no server and no drawing. It holds the row as it stands, the last row that was a
fabric, which stays in view while what stands is refused, and the rows before and after for undo and
redo.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..measured.columns import MEASURED, NUMBERS
from ..model.closing import CLOSING
from ..support.errors import InputError, Problem
from .edited import EditedRow, Solution, answer

MOST_STEPS = 200
"""How many steps can be undone."""

_RANGE = (0.4, 1.8)  # of the value, which a slider spans


@dataclass(frozen=True)
class Quantity:
    """One column of numbers as the page shows it.

    ``role`` is ``identifies`` (the fabric is identified by it), ``compared`` (measured beyond
    need), ``given`` (another measurement), ``follows`` (empty; ``model`` is the model's value) or
    ``empty``. ``bound`` says in words what the number must keep; ``span`` are the ends of its
    slider.
    """

    column: str
    text: str
    unit: str
    bound: str
    role: str
    model: float | None
    span: tuple[float, float]
    refusal: str


class Session:
    """A row being edited. Raises :class:`InputError` where the first one is no fabric."""

    def __init__(self, row: EditedRow) -> None:
        first = answer(row)
        if not isinstance(first, Solution):
            raise InputError(first)

        self.row, self.good = row, first
        self.problems: tuple[Problem, ...] = ()
        self._spans: dict[str, tuple[float, float]] = {}
        self._before: list[EditedRow] = []
        self._after: list[EditedRow] = []
        self._moving = ""

    @property
    def refused(self) -> bool:
        """True where the row as it stands is no fabric; ``good`` is then the last that was one."""
        return bool(self.problems)

    @property
    def can_undo(self) -> bool:
        """Whether there is a row before this one."""
        return bool(self._before)

    @property
    def can_redo(self) -> bool:
        """Whether a row was undone."""
        return bool(self._after)

    def edit(self, row: EditedRow, moving: str = "") -> None:
        """Take a row in place of the one that stands.

        Edits one after the other that are ``moving`` the same, such as one slider, are one step to
        undo.
        """
        if row == self.row:
            return
        if not (moving and moving == self._moving):
            self._before = [*self._before, self.row][-MOST_STEPS:]
        self._moving, self._after = moving, []
        self._stand(row)

    def change(self, column: str, text: str, moving: bool = False) -> None:
        """Write a text into a column."""
        self.edit(self.row.changed(**{column: text}), column if moving else "")

    def undo(self) -> None:
        """Take back the last step, where there is one."""
        if self._before:
            self._after.append(self.row)
            self._step(self._before.pop())

    def redo(self) -> None:
        """Do again what was taken back last."""
        if self._after:
            self._before.append(self.row)
            self._step(self._after.pop())

    def quantities(self) -> tuple[Quantity, ...]:
        """Every column of numbers, in the order of the tables."""
        refusals = {problem.column or "": problem.message for problem in reversed(self.problems)}
        return tuple(self._quantity(column, refusals.get(column, "")) for column in MEASURED)

    def _step(self, row: EditedRow) -> None:
        self._moving = ""
        self._stand(row)

    def _stand(self, row: EditedRow) -> None:
        found = answer(row)
        self.row = row
        if isinstance(found, Solution):
            self.good, self.problems = found, ()
        else:
            self.problems = found

    def _quantity(self, column: str, refusal: str) -> Quantity:
        text, solved = self.row.cells.get(column, ""), self.good.solved.columns
        model = float(solved[column][0]) if column in CLOSING else None
        if column in self.good.identified_by and text:
            role = "identifies"
        elif column in CLOSING:
            role = "compared" if text else "follows"
        else:
            role = "given" if text else "empty"

        kept = NUMBERS[column]
        bound = (
            f"not {kept.bound.word}"
            if not kept.bound.word.startswith("not ")
            else kept.bound.word[4:]
        )

        return Quantity(
            column, text, kept.unit, bound, role, model, self._span(column, model), refusal
        )

    def _span(self, column: str, model: float | None) -> tuple[float, float]:
        """A slider's ends: around the value it first had, so that they do not move under the hand."""
        if column not in self._spans:
            text = self.good.row.cells.get(column, "")
            value = float(text) if text else model
            if value is None:
                return 0.0, 1.0
            self._spans[column] = _RANGE[0] * value, _RANGE[1] * value
        return self._spans[column]
