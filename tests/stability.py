"""Random fabrics through every stage, each in a child process with a time limit.

``python tests/stability.py [COUNT] [--kind KIND] [--first SEED] [--workers N]``: every fabric must
come out consistent or be refused for a reason its numbers give; anything else fails the run.
Standard fabrics have contact over the whole width; general ones have chords, offsets and all
three lateral forms.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
TIME_LIMIT = 180.0  # s a fabric


@dataclass(frozen=True)
class Outcome:
    """What became of one fabric: consistent, refused, failed (with its stage), crashed or too slow."""

    seed: int
    kind: str
    what: str
    quality: float = np.nan
    allowed: float = np.nan

    @property
    def fine(self) -> bool:
        return self.kind in ("consistent", "refused")

    @property
    def good_elements(self) -> bool:
        """At least 0.30, or 0.9 of what the yarns' edges allow."""
        return not self.quality < min(0.30, 0.9 * self.allowed)

    def __str__(self) -> str:
        quality = "" if np.isnan(self.quality) else f"  scaled Jacobian {self.quality:.3f} of {self.allowed:.3f}"
        return f"{self.seed:6d}  {self.kind:10}  {self.what}{quality}"


def _child(seed: int, kind: str, pipe) -> None:
    from fabrics import random_general_row, random_row, table

    from fabric_cad.errors import InputError
    from fabric_cad.pipeline import Stages, make_cell

    reached = ["table"]
    try:
        draw = {"standard": random_row, "general": random_general_row}[kind]
        family, row = draw(np.random.default_rng(seed), f"r{seed}")
        measured = table(family, row)
        with tempfile.TemporaryDirectory() as out:
            report = make_cell(measured, out, stages=Stages(lambda name, seconds: reached.append(name)))
        mesh = report["mesh"]
        fraction = report["volumes"]["yarn_volume_fraction"]
        if not 0 < fraction < 1:
            raise ValueError(f"yarn volume fraction {fraction}")
        weave = report["weave"]
        what = f"{family} {weave['over']}*{weave['under']} {report['section']} {report['parameters']} parameters"
        pipe.send(Outcome(seed, "consistent", what, mesh["min_scaled_jacobian"], mesh["scaled_jacobian_edges_allow"]))
    except InputError as error:
        pipe.send(Outcome(seed, "refused", str(error).split(": ", 1)[-1]))
    except BaseException as error:
        pipe.send(Outcome(seed, "failed", f"at {reached[-1]}: {type(error).__name__}: {error}"))


def try_fabric(seed: int, kind: str) -> Outcome:
    """One random fabric through the pipeline in a process of its own."""
    context = multiprocessing.get_context("forkserver" if sys.platform != "win32" else "spawn")
    if sys.platform != "win32":
        context.set_forkserver_preload(["fabric_cad.cad", "fabric_cad.masters.woven", "fabric_cad.views", "gmsh"])
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=_child, args=(seed, kind, send))
    process.start()
    send.close()
    outcome = None
    if receive.poll(TIME_LIMIT):
        try:
            outcome = receive.recv()
        except EOFError:
            pass
    else:
        process.kill()
        outcome = Outcome(seed, "too slow", f"more than {TIME_LIMIT:g} s")
    process.join()
    return outcome or Outcome(seed, "crashed", f"exit code {process.exitcode}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", type=int, nargs="?", default=200)
    parser.add_argument("--kind", choices=("standard", "general"), action="append", help="default: both")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--workers", type=int, default=2)
    settings = parser.parse_args()
    kinds = settings.kind or ["standard", "general"]
    fine = [_run(kind, range(settings.first, settings.first + settings.count), settings.workers) for kind in kinds]
    return 0 if all(fine) else 1


def _run(kind: str, seeds: range, workers: int) -> bool:
    """Try fabrics of one kind and print what became of them; True where all are fine."""
    start = time.perf_counter()
    with ThreadPoolExecutor(workers) as pool:
        outcomes = []
        for outcome in pool.map(lambda seed: try_fabric(seed, kind), seeds):
            outcomes.append(outcome)
            print(outcome, flush=True)
    counts = Counter(outcome.kind for outcome in outcomes)
    poor = [outcome.seed for outcome in outcomes if not outcome.good_elements]
    summary = ", ".join(f"{number} {what}" for what, number in counts.items())
    print(f"{kind}: {summary} in {time.perf_counter() - start:.0f} s")
    print(f"{kind}: below the quality the edges allow: {poor or 'none'}", flush=True)
    return all(outcome.fine for outcome in outcomes)


if __name__ == "__main__":
    sys.exit(main())
