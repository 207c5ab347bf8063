"""The steps of a deck and the time each covers."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from ..results import Increment


def step_periods(text: str) -> tuple[float, ...]:
    """The time every ``*STATIC`` step of a deck covers: the second number below the card, else 1."""
    periods: list[float] = []
    for card, data in _cards(text):
        if card.startswith("*STEP"):
            periods.append(1.0)
        elif card.startswith(("*STATIC", "*DYNAMIC")) and periods:
            numbers = data.split(",")
            with contextlib.suppress(ValueError, IndexError):
                periods[-1] = float(numbers[1])
    return tuple(periods)


def _cards(text: str) -> Iterator[tuple[str, str]]:
    """Every keyword line, upper case without blanks, and the data line below it ("" for none)."""
    lines = [line.strip() for line in text.splitlines() if not line.lstrip().startswith("**")]
    for line, below in zip(lines, [*lines[1:], ""]):
        if line.startswith("*"):
            yield line.upper().replace(" ", ""), "" if below.startswith("*") else below


def share_of_step(increment: Increment, periods: tuple[float, ...]) -> float:
    """The share of its step's time that an increment reached, 0 to 1."""
    period = periods[increment.step - 1] if increment.step <= len(periods) else 1.0
    return min(1.0, increment.step_time / period) if period > 0 else 1.0
