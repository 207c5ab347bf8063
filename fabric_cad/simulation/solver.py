"""CalculiX as a child process: found, run, followed, stopped in time, and its verdict read.

Its exit status alone says little: 0 also where the deck could not be opened or held no step, 201 for an
error in the deck as for a job that did not converge. The verdict here comes from the status, the log and
the increments in the ``.sta`` file together. Where the system has no process groups (Windows), the process alone
is stopped, and its memory is not known.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from ..support.errors import InputError, Problem, SolverError
from ..support.working import lock_of
from .results import Increment, read_sta

_OUTPUTS = (".log", ".sta", ".cvg", ".dat", ".frd", ".12d")
_THREADS = ("OMP_NUM_THREADS", "CCX_NPROC_STIFFNESS", "CCX_NPROC_RESULTS", "CCX_NPROC_EQUATION_SOLVER")
_KILLED = -signal.SIGKILL if hasattr(signal, "SIGKILL") else 1  # the status of what was killed
_DIE_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux
_POLL = 0.1  # s between two looks at the .sta file
_HINT = (
    "install it (Debian, Ubuntu: apt-get install calculix-ccx; elsewhere conda-forge's calculix or a build "
    "from calculix.de) or name it with --ccx PATH"
)


@dataclass(frozen=True)
class Progress:
    """Where a running job is: the increment just converged.

    ``step`` of ``steps`` and ``increment`` count from 1; ``step_time`` and ``total_time`` are the deck's;
    ``load`` is the share of the step reached, 0 to 1.
    """

    step: int
    increment: int
    step_time: float
    total_time: float
    load: float
    steps: int


@dataclass(frozen=True)
class Run:
    """What became of a job.

    ``reason`` is "finished" or why it is not, with the step and the share of its load reached;
    ``increments`` the converged ones, which stay readable in ``.frd`` and ``.dat`` when the job failed
    (killed, it may lack the last); ``cutbacks`` the attempts that failed; ``warnings`` ccx's own, one of
    each kind; ``seconds`` of wall clock;
    ``peak_memory`` in bytes, 0 where the system does not say; ``version`` ccx's, e.g. "2.20", "" if it did not say.
    """

    finished: bool
    reason: str
    increments: tuple[Increment, ...]
    cutbacks: int
    warnings: tuple[str, ...]
    seconds: float
    peak_memory: int
    version: str


def find_solver(option: str | Path | None = None) -> Path:
    """The ccx to run: the one named, else ``ccx``, the newest ``ccx_2.x`` or ``ccx_static`` on the PATH.

    Raises SolverError, in one line that says how to get it, where there is none.
    """
    if option is not None:
        found = shutil.which(os.fspath(option))
        if found is None:
            raise SolverError(f"no CalculiX solver at {option}: {_HINT}")
        return Path(found).resolve()
    for name in ("ccx", *_numbered(), "ccx_static"):
        if found := shutil.which(name):
            return Path(found).resolve()
    raise SolverError(f"the CalculiX solver ccx is not on the PATH: {_HINT}")


def _numbered() -> list[str]:
    """Names like ccx_2.21 or ccx_2.22_MT on the PATH, newest first."""
    folders = [Path(folder) for folder in os.environ.get("PATH", "").split(os.pathsep) if folder]
    names = {path.name for folder in folders for path in folder.glob("ccx_2.*")}
    versions = {name: match[1] for name in names if (match := re.fullmatch(r"ccx_2\.(\d+)\w*", name))}
    return sorted(versions, key=lambda name: (-int(versions[name]), name))


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

    Everything it prints goes to ``<stem>.log`` as it comes; output of an earlier run is removed first.
    ``time_limit`` in seconds of wall clock. ``listen`` is called at every increment that converges. Past
    the limit, when ``stop`` is set (the way to end runs in threads of a pool, which Ctrl-C does not
    reach), or on any exception (Ctrl-C, one raised by ``listen``), the process and its children are
    killed; an exception goes on to the caller. SIGTERM ends Python without one, unless the caller makes
    it one (:func:`fabric_cad.support.interrupts.stoppable`). On Linux ccx ends also where Python is killed outright,
    or the thread ends that called this; elsewhere it then runs on, and holds the lock of the working folder
    its deck is in. The steps are looked for in the deck itself, not in files it includes.
    Raises InputError for a deck that is not there or not an .inp, SolverError where ccx cannot be started.
    """
    deck = Path(deck).resolve()
    if deck.suffix != ".inp" or not deck.is_file():
        raise InputError(Problem("no such deck (an .inp file)", str(deck)))
    for suffix in _OUTPUTS:
        deck.with_suffix(suffix).unlink(missing_ok=True)
    periods = step_periods(deck.read_text(encoding="utf-8", errors="replace"))
    started = time.monotonic()
    with _Child(deck, solver, threads) as child:
        told = 0
        while not child.ended(_POLL):
            told = _tell(deck, periods, told, listen)
            if stop is not None and stop.is_set():
                child.kill("stopped on request")
            elif time.monotonic() - started > time_limit:
                child.kill(f"stopped at the time limit of {time_limit:g} s")
    seconds = time.monotonic() - started
    _tell(deck, periods, told, listen)
    return _verdict(deck, child, periods, seconds)


class _Child:
    """The ccx process, in a process group of its own that never outlives the ``with`` block."""

    def __init__(self, deck: Path, solver: Path, threads: int) -> None:
        self.status: int | None = None
        self.killed = ""
        self.peak = 0
        # ccx prints from C and from Fortran, each with a buffer of its own: neither may hold it back
        command = [os.fspath(solver), "-i", deck.stem]
        if stdbuf := shutil.which("stdbuf"):
            command = [stdbuf, "-oL", *command]
        settings = dict.fromkeys(_THREADS, str(threads)) | {"GFORTRAN_UNBUFFERED_ALL": "1"}
        try:
            os.access(solver, os.X_OK) or _refuse(solver, "not an executable file")
            with open(deck.with_suffix(".log"), "wb") as log:
                self.process = subprocess.Popen(
                    command,
                    cwd=deck.parent,
                    env=os.environ | settings,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    **_ties(deck.parent),
                )
        except OSError as error:
            _refuse(solver, error.strerror or str(error))

    def __enter__(self) -> _Child:
        return self

    def __exit__(self, *_) -> None:
        if self.status is None:
            self.kill("interrupted")
            while not self.ended(_POLL):
                pass

    def kill(self, why: str) -> None:
        """End the whole process group at once, or the process where there are no groups."""
        self.killed = self.killed or why
        with contextlib.suppress(ProcessLookupError):
            if hasattr(os, "killpg"):
                os.killpg(self.process.pid, signal.SIGKILL)
            else:
                self.process.kill()

    def ended(self, wait: float) -> bool:
        """Whether it is over, waited for at most ``wait`` seconds; reads its peak memory meanwhile."""
        until, pause = time.monotonic() + wait, 0.002
        while True:
            self.peak = max(self.peak, _high_water(self.process.pid))
            if self.reaped():
                return True
            if time.monotonic() >= until:
                return False
            time.sleep(pause)
            pause = min(2 * pause, wait)

    def reaped(self) -> bool:
        """Whether it has ended; its status is kept."""
        if not hasattr(os, "wait4"):
            self.status = self.process.poll()
            return self.status is not None
        pid, status, usage = os.wait4(self.process.pid, os.WNOHANG)
        if pid:
            self.status = self.process.returncode = os.waitstatus_to_exitcode(status)
            # what wait4 says counts the parent's memory at the fork: only where there is nothing better
            self.peak = self.peak or usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
        return bool(pid)


def _ties(folder: Path) -> dict:
    """How a child is tied to this process, as options of Popen: a group of its own, our lock, our end."""
    if os.name != "posix":
        return {}
    lock = lock_of(folder)
    ties: dict = {"start_new_session": True, "pass_fds": () if lock is None else (lock,)}
    if sys.platform == "linux":
        parent, prctl = os.getpid(), getattr(ctypes.CDLL(None), "prctl", None)

        def end_with_parent() -> None:
            prctl(_DIE_WITH_PARENT, signal.SIGKILL, 0, 0, 0)
            if os.getppid() != parent:
                os.kill(os.getpid(), signal.SIGKILL)

        if prctl is not None:
            ties["preexec_fn"] = end_with_parent
    return ties


def _refuse(solver: Path, why: str) -> None:
    raise SolverError(f"the CalculiX solver {solver} cannot be started: {why}")


def _high_water(pid: int) -> int:
    """Peak resident memory of a running process in bytes, 0 where the system does not say."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as status:
            return next((int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM:")), 0)
    except OSError:
        return 0


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


def _tell(deck: Path, periods: tuple[float, ...], told: int, listen: Callable[[Progress], None] | None) -> int:
    """Pass on the increments converged since; how many there are now."""
    if listen is None:
        return 0
    done = _converged(read_sta(deck.with_suffix(".sta")))
    for at in done[told:]:
        steps = max(len(periods), at.step)
        listen(Progress(at.step, at.increment, at.step_time, at.total_time, _load(at, periods), steps))
    return len(done)


def _converged(attempts: tuple[Increment, ...]) -> tuple[Increment, ...]:
    return tuple(attempt for attempt in attempts if attempt.converged)


def _load(at: Increment, periods: tuple[float, ...]) -> float:
    """The share of its step's time that an increment reached, 0 to 1."""
    period = periods[at.step - 1] if at.step <= len(periods) else 1.0
    return min(1.0, at.step_time / period) if period > 0 else 1.0


def _verdict(deck: Path, child: _Child, periods: tuple[float, ...], seconds: float) -> Run:
    """The run as the status, the log and the increments tell it."""
    log = deck.with_suffix(".log").read_text(encoding="utf-8", errors="replace")
    attempts = read_sta(deck.with_suffix(".sta"))
    failure = _failure(child, log, _place(attempts, periods), bool(attempts))
    done = _converged(attempts)
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


def _failure(child: _Child, log: str, place: str, reached: bool) -> str:
    """Why the job is not finished, "" if it is; ``reached`` whether any increment was tried."""
    if child.killed and child.status == _KILLED:
        return f"{child.killed} {place}"
    if re.search("best solution and residuals", log):
        return f"did not converge {place}"
    if errors := _messages(log, "ERROR"):
        return "; ".join(errors[:3]) + (f", {place}" if reached else "")
    if child.status < 0:
        return f"ccx was ended by {signal.Signals(-child.status).name} {place}"
    if child.status or "Job finished" not in log:
        return f"ccx ended with status {child.status} before the job was finished, {place}"
    return "" if re.search(r"^ STEP +\d", log, re.MULTILINE) else "the deck has no step to compute"


def _place(attempts: tuple[Increment, ...], periods: tuple[float, ...]) -> str:
    """Where a job stopped, e.g. "in step 3 at 40 % of its load"."""
    step, load = 1, 0.0
    if attempts:
        step = attempts[-1].step
        load = max((_load(at, periods) for at in _converged(attempts) if at.step == step), default=0.0)
        if load > 1 - 1e-6 and step < len(periods):
            step, load = step + 1, 0.0
    return f"in step {step} at {100 * load:.3g} % of its load"


def _messages(log: str, kind: str) -> tuple[str, ...]:
    """ccx's ``*ERROR`` or ``*WARNING`` messages, each on one line; those that differ only in numbers count once."""
    found: dict[str, str] = {}
    for match in re.finditer(rf"^ *\*{kind}\b.*(?:\n {{6,}}\S.*)*", log, re.MULTILINE):
        text = " ".join(match[0].split())
        found.setdefault(re.sub(r"\d[\d.E+-]*", "0", text), text)
    return tuple(found.values())
