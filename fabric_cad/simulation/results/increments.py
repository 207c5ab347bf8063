"""The increments of a job, from its ``.sta`` file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Increment:
    """One attempt at an increment, converged or not; times in the unit of the deck.

    ``step``, ``increment`` and ``attempt`` count from 1; ``step_time`` and ``total_time`` are those
    reached, for an attempt that failed those it set out from; ``size`` is the time it covers.
    """

    step: int
    increment: int
    attempt: int
    iterations: int
    converged: bool
    total_time: float
    step_time: float
    size: float


def read_sta(path: str | Path) -> tuple[Increment, ...]:
    """Every attempt listed in a ``.sta`` file, even of a running job; none without a file."""
    try:
        text = Path(path).read_text(encoding="ascii", errors="replace")
    except FileNotFoundError:
        return ()
    rows = (line.split() for line in text[: text.rfind("\n") + 1].splitlines())
    return tuple(_attempt(row) for row in rows if len(row) == 7 and row[0].isdigit())


def _attempt(row: list[str]) -> Increment:
    """A row of .sta; the attempts that failed carry a U."""
    step, increment, iterations = int(row[0]), int(row[1]), int(row[3])
    return Increment(
        step,
        increment,
        int(row[2].rstrip("U")),
        iterations,
        "U" not in row[2],
        *map(float, row[4:]),
    )
