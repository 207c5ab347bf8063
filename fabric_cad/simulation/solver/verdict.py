"""What became of a job, from its status, its log and its increments together."""

from __future__ import annotations

import re
import signal
from dataclasses import dataclass
from pathlib import Path

from ..results import Increment, read_sta
from .process import Child
from .steps import share_of_step

_KILLED = -signal.SIGKILL if hasattr(signal, "SIGKILL") else 1  # the status of what was killed


@dataclass(frozen=True)
class Run:
    """What became of a job.

    ``reason`` is "finished" or why it is not, with the step and the share of its load reached;
    ``increments`` the converged ones, which stay readable in ``.frd`` and ``.dat`` when the job
    failed (killed, it may lack the last); ``cutbacks`` the attempts that failed; ``warnings`` ccx's
    own, one of each kind; ``seconds`` of wall clock; ``peak_memory`` in bytes, 0 where the system
    does not say; ``version`` ccx's, e.g. "2.20", "" if it did not say.
    """

    finished: bool
    reason: str
    increments: tuple[Increment, ...]
    cutbacks: int
    warnings: tuple[str, ...]
    seconds: float
    peak_memory: int
    version: str


def verdict(deck: Path, child: Child, periods: tuple[float, ...], seconds: float) -> Run:
    """The run as the status, the log and the increments tell it."""
    log = deck.with_suffix(".log").read_text(encoding="utf-8", errors="replace")
    attempts = read_sta(deck.with_suffix(".sta"))
    failure = _failure(child, log, _place(attempts, periods), bool(attempts))
    done = converged(attempts)
    version = re.search(r"CalculiX Version (\S+?),", log)

    return Run(
        finished=not failure,
        reason=failure or "finished",
        increments=done,
        cutbacks=len(attempts) - len(done),
        warnings=_messages(log, "WARNING"),
        seconds=seconds,
        peak_memory=child.peak,
        version=version[1] if version else "",
    )


def converged(attempts: tuple[Increment, ...]) -> tuple[Increment, ...]:
    """The attempts that converged."""
    return tuple(attempt for attempt in attempts if attempt.converged)


def _failure(child: Child, log: str, place: str, reached: bool) -> str:
    """Why the job is not finished, "" if it is; ``reached`` whether any increment was tried."""
    if child.killed and child.status == _KILLED:
        return f"{child.killed} {place}"
    if re.search("best solution and residuals", log):
        return f"did not converge {place}"
    if errors := _messages(log, "ERROR"):
        return "; ".join(errors[:3]) + (f", {place}" if reached else "")
    if child.status is not None and child.status < 0:
        return f"ccx was ended by {signal.Signals(-child.status).name} {place}"
    if child.status or "Job finished" not in log:
        return f"ccx ended with status {child.status} before the job was finished, {place}"
    return "" if re.search(r"^ STEP +\d", log, re.MULTILINE) else "the deck has no step to compute"


def _place(attempts: tuple[Increment, ...], periods: tuple[float, ...]) -> str:
    """Where a job stopped, e.g. "in step 3 at 40 % of its load"."""
    step, load = 1, 0.0
    if attempts:
        step = attempts[-1].step
        load = max(
            (
                share_of_step(attempt, periods)
                for attempt in converged(attempts)
                if attempt.step == step
            ),
            default=0.0,
        )
        if load > 1 - 1e-6 and step < len(periods):
            step, load = step + 1, 0.0

    return f"in step {step} at {100 * load:.3g} % of its load"


def _messages(log: str, kind: str) -> tuple[str, ...]:
    """ccx's ``*ERROR`` or ``*WARNING`` messages, each on one line.

    Those that differ only in numbers count once.
    """
    found: dict[str, str] = {}
    for match in re.finditer(rf"^ *\*{kind}\b.*(?:\n {{6,}}\S.*)*", log, re.MULTILINE):
        text = " ".join(match[0].split())
        found.setdefault(re.sub(r"\d[\d.E+-]*", "0", text), text)
    return tuple(found.values())
