"""What can go wrong, as the user is told it: one exception per exit status."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input, with the place where it stands.

    Any part of the place may be unknown; ``str()`` leaves such a part out, e.g.
    ``families/twill.csv:7: warp_width_mm: 3.1 is not below ... (row twill32)``.
    """

    message: str
    path: str | None = None
    line: int | None = None
    column: str | None = None
    row: str | None = None

    def __str__(self) -> str:
        text = ""
        if self.path is not None:
            text += self.path if self.line is None else f"{self.path}:{self.line}"
            text += ": "
        if self.column:
            text += f"{self.column}: "
        text += self.message
        if self.row:
            text += f" (row {self.row})"
        return text


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
    """The input is wrong; carries every :class:`Problem` found; exit status 2."""

    exit_status = 2

    def __init__(self, problems: Problem | str | Iterable[Problem]) -> None:
        if isinstance(problems, str):
            problems = Problem(problems)
        self.problems = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(map(str, self.problems)))

    def __reduce__(self):
        return InputError, (self.problems,)


class BuildError(FabricCadError):
    """A stage could not make what it was asked for (CAD, mesh or a file written)."""


class OutputError(FabricCadError):
    """The output directory cannot take the result (not writable, full, in the way)."""


class SolverError(FabricCadError):
    """The finite-element solver is not there or cannot be started."""
