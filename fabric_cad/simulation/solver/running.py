"""A job from its deck to its verdict, followed as it runs."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ...support.errors import InputError, Problem
from ..results import read_sta
from .process import POLL, Child
from .steps import share_of_step, step_periods
from .verdict import Run, converged, verdict

_OUTPUTS = (".log", ".sta", ".cvg", ".dat", ".frd", ".12d")


@dataclass(frozen=True)
class Progress:
    """Where a running job is: the increment just converged.

    ``step`` of ``steps`` and ``increment`` count from 1; ``step_time`` and ``total_time`` are the
    deck's; ``load`` is the share of the step reached, 0 to 1.
    """

    step: int
    increment: int
    step_time: float
    total_time: float
    load: float
    steps: int


def run_solver(
    deck: Path,
    solver: Path,
    *,
    threads: int = 1,
    time_limit: float = float("inf"),
    listen: Callable[[Progress], None] | None = None,
    stop: threading.Event | None = None,
) -> Run:
    """Run ccx on a deck in the deck's folder and wait for it.

    Everything it prints goes to ``<stem>.log`` as it comes; output of an earlier run is removed
    first. ``time_limit`` in seconds of wall clock. ``listen`` is called at every increment that
    converges. Past the limit, when ``stop`` is set (the way to end runs in threads of a pool, which
    Ctrl-C does not reach), or on any exception (Ctrl-C, one raised by ``listen``), the process and
    its children are killed; an exception goes on to the caller. SIGTERM ends Python without one,
    unless the caller makes it one (:func:`fabric_cad.support.interrupts.stoppable`). On Linux ccx
    ends also where Python is killed outright, or the thread ends that called this; elsewhere it
    then runs on, and holds the lock of the working folder its deck is in. The steps are looked for
    in the deck itself, not in files it includes. Raises InputError for a deck that is not there or
    not an .inp, SolverError where ccx cannot be started.
    """
    deck = Path(deck).resolve()
    if deck.suffix != ".inp" or not deck.is_file():
        raise InputError(Problem("no such deck (an .inp file)", str(deck)))
    for suffix in _OUTPUTS:
        deck.with_suffix(suffix).unlink(missing_ok=True)
    periods = step_periods(deck.read_text(encoding="utf-8", errors="replace"))
    started = time.monotonic()
    with Child(deck, solver, threads) as child:
        told = 0
        while not child.ended(POLL):
            told = _tell(deck, periods, told, listen)
            if stop is not None and stop.is_set():
                child.kill("stopped on request")
            elif time.monotonic() - started > time_limit:
                child.kill(f"stopped at the time limit of {time_limit:g} s")

    seconds = time.monotonic() - started
    _tell(deck, periods, told, listen)

    return verdict(deck, child, periods, seconds)


def _tell(
    deck: Path, periods: tuple[float, ...], told: int, listen: Callable[[Progress], None] | None
) -> int:
    """Pass on the increments converged since; how many there are now."""
    if listen is None:
        return 0
    done = converged(read_sta(deck.with_suffix(".sta")))
    for new in done[told:]:
        steps, share = max(len(periods), new.step), share_of_step(new, periods)
        listen(Progress(new.step, new.increment, new.step_time, new.total_time, share, steps))
    return len(done)
