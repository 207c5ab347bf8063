"""The ccx process: started in a group of its own, watched, and ended with us."""

from __future__ import annotations

import contextlib
import ctypes
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from ...support.errors import SolverError
from ...support.working import lock_of

_THREADS = (
    "OMP_NUM_THREADS",
    "CCX_NPROC_STIFFNESS",
    "CCX_NPROC_RESULTS",
    "CCX_NPROC_EQUATION_SOLVER",
)
_DIE_WITH_PARENT = 1  # PR_SET_PDEATHSIG of Linux
POLL = 0.1
"""Seconds between two looks at the process and its ``.sta`` file."""


class Child:
    """The ccx process, in a process group of its own that never outlives the ``with`` block."""

    def __init__(self, deck: Path, solver: Path, threads: int) -> None:
        self.status: int | None = None
        self.killed = ""
        self.peak = 0
        # ccx prints from C and from Fortran, each with a buffer of its own: neither may hold it
        # back
        command = [os.fspath(solver), "-i", deck.stem]
        if stdbuf := shutil.which("stdbuf"):
            command = [stdbuf, "-oL", *command]
        settings = dict.fromkeys(_THREADS, str(threads)) | {"GFORTRAN_UNBUFFERED_ALL": "1"}
        try:
            if not os.access(solver, os.X_OK):
                raise _refused(solver, "not an executable file")
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
            raise _refused(solver, error.strerror or str(error)) from error

    def __enter__(self) -> Child:
        return self

    def __exit__(self, *_) -> None:
        if self.status is None:
            self.kill("interrupted")
            while not self.ended(POLL):
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
        """Whether it is over, waited for at most ``wait`` seconds.

        Reads its peak memory meanwhile.
        """
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
            # what wait4 says counts the parent's memory at the fork: only where there is nothing
            # better
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
        if prctl is not None:
            ties["preexec_fn"] = partial(_end_with, parent, prctl)
    return ties


def _end_with(parent: int, prctl: Callable[..., int]) -> None:
    """Ask the system to kill this process when its parent ends, which may have happened just before."""
    prctl(_DIE_WITH_PARENT, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)


def _refused(solver: Path, why: str) -> SolverError:
    return SolverError(f"the CalculiX solver {solver} cannot be started: {why}")


def _high_water(pid: int) -> int:
    """Peak resident memory of a running process in bytes, 0 where the system does not say."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as status:
            return next(
                (int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM:")), 0
            )
    except OSError:
        return 0
