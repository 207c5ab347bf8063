"""``cell`` ended at random moments: the row's folder holds one complete result, and the next run tidies up.

A third of the moments are drawn over the whole run, a third over its last fifth, and a third from when its
report is written on, since what moves files into place is over in milliseconds.
"""

from __future__ import annotations

import os
import signal
import tempfile
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

from .results import mixed, read_folder
from .tables import SHIPPED
from .trial import fork_command, tracebacks, wait

ROW = "plain"
OLD, NEW = ("--across", "4", "--gap", "2"), ("--across", "6", "--gap", "2")
SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
CELL_LIMIT = 120.0  # s


def load_cad() -> None:
    """Load what a cell takes, so that a fork of this process has it at once."""
    import fabric_cad.cad
    import fabric_cad.cell.report
    import fabric_cad.decks.cell
    import fabric_cad.masters
    import fabric_cad.meshing.mesher
    import fabric_cad.model.identification
    import fabric_cad.pictures  # noqa: F401


class Place:
    """A folder with the shipped tables, a folder of results and a temp folder of its own."""

    def __init__(self, root: Path) -> None:
        self.root, self.temporary, self.log = root / "here", root / "temporary", root / "log"
        self.temporary.mkdir()
        (self.root / "families").mkdir(parents=True)
        (self.root / "families" / f"{ROW}.csv").write_bytes((SHIPPED / f"{ROW}.csv").read_bytes())

    @property
    def folder(self) -> Path:
        return self.root / "build" / ROW

    def start(self, options: tuple[str, ...], log: str = "log") -> int:
        """Start ``cell`` in a fork; its process number."""
        with open(self.log.with_name(log), "ab") as output:
            return fork_command(
                ("cell", ROW, "-q", *options),
                self.root,
                self.temporary,
                output.fileno(),
                output.fileno(),
            )

    def told(self, log: str = "log") -> str:
        return self.log.with_name(log).read_text(encoding="utf-8", errors="replace")

    def elements(self) -> tuple[int | None, list[str]]:
        """Hexahedra of the folder's result (None: there is no result), and what is wrong with it."""
        import json

        try:
            contents = read_folder(self.folder)
        except FileNotFoundError:
            return None, []
        if wrong := mixed(ROW, contents):
            return None, wrong
        return json.loads(contents["report.json"])["mesh"]["hexahedra"], []

    def reported(self, process: int, rng: np.random.Generator) -> float:
        """Wait until a run has written its report aside, or ended, and 0.1 to 300 ms more; these s."""
        later = float(10 ** rng.uniform(-4, -0.5))
        while not (
            any(self.reports())
            or os.waitid(os.P_PID, process, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        ):
            time.sleep(2e-4)
        time.sleep(later)
        return later

    def reports(self) -> Iterator[Path]:
        """Reports in the working folders of runs."""
        for depth in (".*/report.json", ".*/*/report.json"):
            yield from (self.root / "build").glob(depth)

    def litter(self) -> list[str]:
        """Whatever lies about beside the row's result; what is kept on purpose (locks) has no content."""
        paths = [
            *self.temporary.iterdir(),
            *(path for path in (self.root / "build").iterdir() if path != self.folder),
        ]
        return [
            path.name
            for path in paths
            if path.is_dir() or path.stat().st_size or path.parent == self.temporary
        ]


@cache
def undisturbed() -> tuple[float, int, int]:
    """Seconds of a run, and the hexahedra of the old and the new mesh."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as scratch:
        place = Place(Path(scratch))
        counts = []
        for options in (OLD, NEW):
            start = time.perf_counter()
            status = wait(place.start(options), CELL_LIMIT)
            seconds = time.perf_counter() - start
            if status:
                raise RuntimeError(
                    f"an undisturbed cell ended with status {status}: {place.told()}"
                )
            counts.append(place.elements()[0])
        return seconds, *counts


def kill_run(seed: int) -> tuple[str, str, list[str]]:
    """End a run at a random moment, in a folder that holds an older result every other time.

    A name, how it ended, and what is wrong.
    """
    rng = np.random.default_rng((5, seed))
    seconds, old, new = undisturbed()
    signalled = SIGNALS[seed % 3]
    share = (rng.uniform(0, 1.05), rng.uniform(0.8, 1.05), None)[seed // 6 % 3]
    with tempfile.TemporaryDirectory(prefix="fuzz-") as scratch:
        place = Place(Path(scratch))
        before = old if seed // 3 % 2 else None
        if before is not None and wait(place.start(OLD), CELL_LIMIT):
            return "the older run", "failed", [place.told()]
        process = place.start(NEW, "killed")
        if share is None:
            moment = f"{1e3 * place.reported(process, rng):.1f} ms after its report"
        else:
            time.sleep(share * seconds)
            moment = f"{share * seconds:.2f} s after its start"
        wrong = []
        try:
            os.kill(process, signalled)
        except ProcessLookupError:
            pass
        status = wait(process, CELL_LIMIT)
        elements, problems = place.elements()
        wrong += problems
        if not problems and elements not in (before, new):
            wrong.append(f"{elements} elements, neither those before nor those of the new mesh")
        if status == 0 and elements != new:
            wrong.append("status 0 without the new result")
        told = place.told("killed")
        if "earlier results are as they were" in told and elements != before:
            wrong.append("'earlier results are as they were' is not true")
        wrong += tracebacks(told)
        if status is None:
            wrong.append(f"does not end within {CELL_LIMIT:g} s of its signal")
        if seed % 5 == 0:  # the next run tidies up
            if wait(place.start(OLD), CELL_LIMIT):
                wrong.append(f"the next run fails: {place.told()}")
            elif litter := place.litter():
                wrong.append(f"left after the next run: {', '.join(litter)}")
        ending = "new result" if elements == new else "old result" if elements else "none"
        return f"{signalled.name} {moment}", ending, wrong
