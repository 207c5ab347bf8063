"""What can go wrong, as the user is told it: one exception per exit status."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

MOST_TOLD = 50
"""So many problems of one file are printed; the others are counted."""


def printable(text: str) -> str:
    """The text with all that a terminal would obey, and what turns the direction of writing, as escapes."""
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text
    )


def quoted(value: object, most: int = 300) -> str:
    """A value as Python writes it; of a long text its beginning.

    A text stands in quotation marks, with control characters as escapes.
    """
    if isinstance(value, str) and len(value) > most:
        return f"{value[:most]!r}..."
    written = repr(value)
    return written if isinstance(value, str) or len(written) <= most else f"{written[:most]}..."


def _short(text: str | None, most: int = 300) -> str:
    text = text or ""
    return text if len(text) <= most else f"{text[:most]}..."


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input, with the place where it stands.

    Any part of the place may be unknown; ``str()`` leaves such a part out, e.g.
    ``families/twill.csv:7: warp_width_mm: 3.1 is not below ... (row twill32)``. In a workbook
    ``line`` is the row of the ``sheet`` and ``letter`` the column's:
    ``families/twill.xlsx: sheet1!F7: warp_width_mm: 3.1 is not below ...``. Control characters
    are written out, so that no cell can act on the terminal.
    """

    message: str
    path: str | None = None
    line: int | None = None
    column: str | None = None
    row: str | None = None
    sheet: str | None = None
    letter: str | None = None

    def __str__(self) -> str:
        parts = [self.where, _short(self.column), self.message]
        text = ": ".join(part for part in parts if part)

        return printable(f"{text} (row {_short(self.row)})" if self.row else text)

    @property
    def where(self) -> str:
        """File and line, or file, sheet and cell."""
        if self.path is None or self.line is None:
            return self.path or ""
        if self.sheet is None:
            return f"{self.path}:{self.line}"

        sheet = self.sheet if re.fullmatch(r"\w+", self.sheet) else f"'{self.sheet}'"
        cell = f"!{self.letter}{self.line}" if self.letter else f" row {self.line}"
        return f"{self.path}: {sheet}{cell}"


@dataclass(frozen=True)
class Place:
    """Where a table stands: its file and, in a workbook, the sheet and the letter of every column by name."""

    path: str | None = None
    sheet: str | None = None
    letters: Mapping[str, str] = field(default_factory=dict)

    def problem(
        self,
        message: str,
        line: int | None = None,
        column: str | None = None,
        row: str | None = None,
    ) -> Problem:
        """A :class:`Problem` of this table, at a line and a column."""
        return Problem(
            message, self.path, line, column, row, self.sheet, self.letters.get(column or "")
        )


def did_you_mean(name: str, known: Iterable[str], cutoff: float = 0.6) -> str:
    """``; did you mean ...?`` with the nearest known name, nothing where none is as near as ``cutoff`` (0 to 1)."""
    from difflib import get_close_matches

    nearest = get_close_matches(name, list(known), n=1, cutoff=cutoff)
    return f"; did you mean {nearest[0]}?" if nearest else ""


def read_input(path: Path) -> bytes:
    """The bytes of a user's file. Raises :class:`InputError` where it cannot be read."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(Problem(f"cannot be read: {error.strerror}", str(path))) from error


class FabricCadError(Exception):
    """Base of every error this package raises on purpose; exit status 1."""

    exit_status = 1


class InputError(FabricCadError):
    """The input is wrong; carries every :class:`Problem` found, of which it prints 50 a file.

    The exit status is 2.
    """

    exit_status = 2

    def __init__(self, problems: Problem | str | Iterable[Problem]) -> None:
        if isinstance(problems, str):
            problems = Problem(problems)
        self.problems = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(_told(self.problems)))

    def __str__(self) -> str:
        return self.args[0]  # where a subclass is a KeyError too, that would print a repr

    def __reduce__(self):
        return type(self), (self.problems,)


class UnknownRowError(InputError, KeyError):
    """A table has no row of that name."""


class ArgumentError(InputError, TypeError):
    """A function of this package was given something of the wrong kind."""


def expect(value: object, kind: type, name: str, hint: str = "") -> None:
    """Raise :class:`ArgumentError` where the argument ``name`` is none of a kind."""
    if not isinstance(value, kind):
        raise ArgumentError(
            f"{name}: expected a {kind.__name__}{hint}, got {type(value).__name__} {value!r:.60}"
        )


def _told(problems: Iterable[Problem]) -> list[str]:
    """The lines to print: of every file the first problems, and how many more there are."""
    counts: Counter[str | None] = Counter()
    lines = []
    for problem in problems:
        counts[problem.path] += 1
        if counts[problem.path] <= MOST_TOLD:
            lines.append(str(problem))

    for path, count in counts.items():
        if count > MOST_TOLD:
            lines.append(str(Problem(f"and {count - MOST_TOLD} more", path)))
    return lines


class BuildError(FabricCadError):
    """A stage could not make what it was asked for (CAD, mesh or a file written)."""


class OutputError(FabricCadError):
    """The output directory cannot take the result (not writable, full, in the way)."""


class MissingPackageError(FabricCadError, ImportError):
    """An optional package that a function needs is not installed."""


class SolverError(FabricCadError):
    """The finite-element solver is not there or cannot be started."""
