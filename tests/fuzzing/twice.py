"""Two runs of one row at once with different meshes, and a reader beside them: always one complete result."""

from __future__ import annotations

import os
import signal
import tempfile
import time
from pathlib import Path

import numpy as np

from .kills import CELL_LIMIT, NEW, OLD, ROW, Place, undisturbed
from .results import mixed, read_folder
from .trial import tracebacks


def run_twice(seed: int) -> tuple[str, str, list[str]]:
    """Two runs a little apart; a name, how they ended, and what is wrong."""
    rng = np.random.default_rng((6, seed))
    apart = float(rng.uniform(0, 0.5))
    _, old, new = undisturbed()
    wrong: list[str] = []
    with tempfile.TemporaryDirectory(prefix="fuzz-") as scratch:
        place = Place(Path(scratch))
        processes = [place.start(OLD, "first")]
        time.sleep(apart)
        processes.append(place.start(NEW, "second"))
        statuses, seen = _watch(place, processes, wrong)
        elements, problems = place.elements()
        wrong += problems
        for name, status in zip(("first", "second"), statuses):
            told = place.told(name)
            if status != 0 and "under way" not in told:
                wrong.append(f"the {name} run ends with {status}: {told}")
            wrong += tracebacks(told)
        if elements not in (old, new):
            wrong.append(f"{elements} elements")
        if litter := place.litter():
            wrong.append(f"left: {', '.join(litter)}")
    return f"{apart:.2f} s apart, {seen} looks", f"statuses {statuses}", wrong


def _watch(place: Place, processes: list[int], wrong: list[str]) -> tuple[list[int | None], int]:
    """Read the folder again and again until both runs have ended; their statuses and how often it was read."""
    statuses: dict[int, int | None] = {}
    looks, end = 0, time.perf_counter() + CELL_LIMIT
    while len(statuses) < len(processes):
        for process in set(processes) - set(statuses):
            ended, status = os.waitpid(process, os.WNOHANG)
            if ended:
                statuses[process] = os.waitstatus_to_exitcode(status)
            elif time.perf_counter() > end:
                os.killpg(process, signal.SIGKILL)
                os.waitpid(process, 0)
                statuses[process] = None
        try:
            problems = mixed(ROW, read_folder(place.folder))
            looks += 1
            if problems and not wrong:
                wrong.append(f"a reader saw {'; '.join(problems)}")
        except FileNotFoundError:
            pass
        time.sleep(0.005)
    return [statuses[process] for process in processes], looks
