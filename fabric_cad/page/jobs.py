"""The pipeline behind the page: one run at a time in a process of its own, told stage by stage, to be cancelled.

::

    page                       this module                     python -m fabric_cad.page.job
     | "run" the row ------------> starts, hands the row over --> stdin
     | "job" every half second --> stages so far  <------------ stdout, a line of JSON a stage
     | "cancel" -----------------> SIGTERM  ------------------> leaves earlier results as they were
"""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .edited import EditedRow

KINDS = {
    "step": (".step", "model/step"),
    "mesh": (".msh", "application/octet-stream"),
    "deck": (".inp", "text/plain"),
    "vtu": (".vtu", "application/octet-stream"),
    "picture": (".png", "image/png"),
    "report": ("report.json", "application/json"),
    "datasheet": ("datasheet.pdf", "application/pdf"),
}
"""What can be downloaded: the end of its name, or its name, in a row's folder, and its media type."""

_PATIENCE = 10.0  # seconds a cancelled run has to clear away


@dataclass
class Job:
    """A run of the pipeline for a row; ``stages`` are (name, seconds), None while it lasts."""

    row: EditedRow
    out: Path
    stages: list[tuple[str, float | None]] = field(default_factory=list)
    problem: str = ""
    state: str = "running"
    _process: subprocess.Popen | None = field(default=None, repr=False)

    def start(self) -> None:
        """Start the run."""
        command = [sys.executable, "-m", "fabric_cad.page.job"]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        self._process = subprocess.Popen(command, text=True, encoding="utf-8", **pipes)  # type: ignore[call-overload]
        threading.Thread(target=self._follow, daemon=True).start()

    def cancel(self) -> None:
        """Stop the run; what it had made is cleared away, and earlier results are as they were."""
        if self._process is not None and self._process.poll() is None:
            self.state = "cancelled"
            self._process.terminate()
            try:
                self._process.wait(_PATIENCE)
            except subprocess.TimeoutExpired:
                self._process.kill()

    def told(self) -> dict[str, Any]:
        """How it stands, for the page."""
        return {
            "state": self.state,
            "stages": list(self.stages),
            "problem": self.problem,
            "row": self.row.name,
        }

    def file(self, kind: str) -> Path:
        """Where a file of the row is. Raises KeyError for a kind that there is none of."""
        ending, _ = KINDS[kind]
        name = f"{self.row.name}{ending}" if ending.startswith(".") else ending
        return self.out / self.row.name / name

    def _follow(self) -> None:
        process = self._process
        assert process is not None and process.stdin and process.stdout and process.stderr
        task = {"family": self.row.family, "cells": dict(self.row.cells), "out": str(self.out)}
        try:
            process.stdin.write(json.dumps(task))
            process.stdin.close()
        except BrokenPipeError:
            pass

        for line in process.stdout:
            name, seconds = json.loads(line)
            if self.stages and self.stages[-1][0] == name:
                self.stages.pop()
            self.stages.append((name, seconds))

        told = process.stderr.read().strip()
        status = process.wait()
        if self.state == "running":
            self.state = "failed" if status else "done"
            self.problem = told.splitlines()[-1] if status and told else ""
