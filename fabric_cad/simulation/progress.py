"""How far a case of loads is, and how long the rest may take."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from .solver import Progress

SECONDS_A_STATE = 2.5
"""Seconds that a state takes per 1000 hexahedra: between 0.7 (twill22, 5376 hexahedra, two idle cores) and 5 (plain,
1344 hexahedra, one thread of two busy cores) were measured, in CalculiX 2.20."""
SECONDS_SPREAD = 3.0
"""Factor by which a case may be faster or slower than that; other machines were not measured."""


@dataclass(frozen=True)
class CaseProgress:
    """Where a case is: ``state`` of ``states`` (0: not begun) in its ``increment``, ``load`` the share of it reached.

    ``seconds`` since the solver was first started; ``expected`` those of the whole case by the
    measured rate, within a factor of :data:`SECONDS_SPREAD`; ``left`` those that the rest takes at
    this run's own rate since its first state, which takes longer than others, None before there is
    one.
    """

    state: int
    states: int
    increment: int
    load: float
    hexahedra: int
    seconds: float
    expected: float
    left: float | None


class CaseWatch:
    """Follows the jobs of a case: what the solver says of one job becomes a :class:`CaseProgress` of all of them.

    ``states`` is the number of states of every job, in their order. ``listen`` hears once before
    the first job starts, then at every increment.
    """

    def __init__(
        self,
        states: Sequence[int],
        hexahedra: int,
        listen: Callable[[CaseProgress], None] | None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.states, self.hexahedra, self.listen, self.clock = (
            tuple(states),
            hexahedra,
            listen,
            clock,
        )
        self.start = clock()
        self.first: tuple[float, float] | None = (
            None  # seconds and states when the first state was reached
        )
        self.tell(0, 0, 0.0)

    def job(self, number: int) -> Callable[[Progress], None] | None:
        """The listener of a job, which counts from 0; None where nobody listens."""
        if self.listen is None:
            return None
        before = sum(self.states[:number])
        return lambda progress: self.tell(before + progress.step, progress.increment, progress.load)

    def tell(self, state: int, increment: int, load: float) -> None:
        """Tell of a state, from 1 over all jobs, and of its increment."""
        if self.listen is None:
            return
        states, seconds = sum(self.states), self.clock() - self.start
        reached = max(state - 1, 0) + load
        if self.first is None and reached >= 1:
            self.first = seconds, reached

        left = None
        if self.first is not None and reached - self.first[1] >= 0.5:
            pace = (seconds - self.first[0]) / (reached - self.first[1])
            left = pace * (states - reached)

        expected = expected_seconds(states, self.hexahedra)
        self.listen(
            CaseProgress(state, states, increment, load, self.hexahedra, seconds, expected, left)
        )


def expected_seconds(states: int, hexahedra: int) -> float:
    """Seconds that so many states take on so many elements, by the measured rate."""
    return states * SECONDS_A_STATE * hexahedra / 1000


def clock_words(seconds: float) -> str:
    """A time as one says it: 40 s, 3 min, 2 h 10 min; no finer than it is known."""
    if seconds < 55:
        return f"{max(5, 5 * round(seconds / 5))} s"
    minutes = round(seconds / 60)
    if minutes < 60:
        return f"{max(minutes, 1)} min"
    hours, minutes = divmod(10 * round(seconds / 600), 60)
    return f"{hours} h {minutes} min" if minutes else f"{hours} h"


def announced(progress: CaseProgress) -> str:
    """What is said before the first state."""
    low, high = (
        clock_words(progress.expected * factor) for factor in (1 / SECONDS_SPREAD, SECONDS_SPREAD)
    )
    return (
        f"{progress.states} states on {progress.hexahedra} hexahedra: about {clock_words(progress.expected)} "
        f"(likely {low} to {high}; {SECONDS_A_STATE:g} s a state per 1000 hexahedra, by few measurements)"
    )


def told(progress: CaseProgress) -> str:
    """What is said of an increment."""
    text = f"state {progress.state} of {progress.states}, increment {progress.increment}: "
    text += f"{100 * progress.load:.0f} % of its load"
    if progress.left is None:
        return text
    if progress.left < 1:
        return text
    return f"{text}, about {clock_words(progress.left)} left"
