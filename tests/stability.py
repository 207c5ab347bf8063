"""Random fabrics through every stage, each in a child process with a time limit.

``python tests/stability.py [--part PART] [--seeds FIRST-END] [--workers N]``: every fabric must
come out consistent or be refused for a reason its numbers give; anything else fails the run.

standard  contact over the whole width, widths 0.6 to 0.97 of the spacing
general   chords, offsets and all three lateral forms
patterns  general fabrics of any weave
narrow    widths 0.95 to 0.999 of the spacing
unequal   one direction's yarns up to four times as thick as the other's
flat-gaps as patterns, with float_gap = flat
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

from fabrics import DRAWS, table  # noqa: E402

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
    def wanted(self) -> float:
        """The scaled Jacobian a mesh should have: 0.30, or 0.9 of what the yarns' edges allow."""
        return min(0.30, 0.9 * self.allowed)

    @property
    def good_elements(self) -> bool:
        return not self.quality < self.wanted

    def __str__(self) -> str:
        quality = "" if np.isnan(self.quality) else f"  scaled Jacobian {self.quality:.3f} of {self.allowed:.3f}"
        return f"{self.seed:6d}  {self.kind:10}  {self.what}{quality}"


def _child(seed: int, part: str, pipe) -> None:
    from fabric_cad.cell.pipeline import Stages, make_cell
    from fabric_cad.support.errors import InputError

    reached = ["table"]
    try:
        family, row = DRAWS[part](np.random.default_rng(seed), f"r{seed}")
        measured = table(family, row)
        with tempfile.TemporaryDirectory() as out:
            report = make_cell(measured, out, stages=Stages(lambda name, seconds: reached.append(name)))
        mesh = report["mesh"]
        fraction = report["volumes"]["yarn_volume_fraction"]
        if not 0 < fraction < 1:
            raise ValueError(f"yarn volume fraction {fraction}")
        weave = report["weave"]
        counts = (
            f"{weave['wefts']} x {weave['warps']}" if weave["over"] is None else f"{weave['over']}*{weave['under']}"
        )
        what = f"{family} {counts} {report['section']} {report['parameters']} parameters"
        pipe.send(Outcome(seed, "consistent", what, mesh["min_scaled_jacobian"], mesh["scaled_jacobian_edges_allow"]))
    except InputError as error:
        pipe.send(Outcome(seed, "refused", str(error).split(": ", 1)[-1]))
    except BaseException as error:
        pipe.send(Outcome(seed, "failed", f"at {reached[-1]}: {type(error).__name__}: {error}"))


def try_fabric(seed: int, part: str) -> Outcome:
    """One random fabric through the pipeline in a process of its own."""
    context = multiprocessing.get_context("forkserver" if sys.platform != "win32" else "spawn")
    if sys.platform != "win32":
        context.set_forkserver_preload(["fabric_cad.cad", "fabric_cad.masters.woven", "fabric_cad.pictures", "gmsh"])
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=_child, args=(seed, part, send))
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
    parser.add_argument("--part", choices=DRAWS, action="append", help="default: all")
    parser.add_argument("--seeds", type=seed_range, metavar="FIRST-END", default=range(200), help="default: 0-200")
    parser.add_argument("--workers", type=int, default=2)
    settings = parser.parse_args()
    runs = {part: _run(part, settings.seeds, settings.workers) for part in settings.part or DRAWS}
    print()
    for part, outcomes in runs.items():
        print("\n".join(summary(part, outcomes)))
    return 0 if all(outcome.fine for outcomes in runs.values() for outcome in outcomes) else 1


def seed_range(text: str) -> range:
    """``FIRST-END`` as a range, the end not in it; a single number is that seed."""
    first, _, end = text.partition("-")
    return range(int(first), int(end) if end else int(first) + 1)


def _run(part: str, seeds: range, workers: int) -> list[Outcome]:
    """Try the fabrics of one part; what became of them is printed as they end."""
    start = time.perf_counter()
    outcomes = []
    with ThreadPoolExecutor(workers) as pool:
        for outcome in pool.map(lambda seed: try_fabric(seed, part), seeds):
            outcomes.append(outcome)
            print(f"{part:10}{outcome}", flush=True)
    print(f"{part}: {time.perf_counter() - start:.0f} s", flush=True)
    return outcomes


def summary(part: str, outcomes: list[Outcome], shown: int = 5) -> list[str]:
    """Lines that say what became of a part, and its lowest qualities against what is wanted."""
    counts = Counter(outcome.kind for outcome in outcomes)
    meshed = [outcome for outcome in outcomes if not np.isnan(outcome.quality)]
    lowest = sorted(meshed, key=lambda outcome: outcome.quality / outcome.wanted)[:shown]
    poor = sum(not outcome.good_elements for outcome in meshed)
    lines = [
        f"{part}: {len(outcomes)} fabrics: " + ", ".join(f"{number} {what}" for what, number in counts.items()),
        f"  below min(0.30, 0.9 of what the yarns' edges allow): {poor} of {len(meshed)}; the lowest against it:",
    ]
    lines += [f"    {outcome.quality:.3f} of {outcome.wanted:.3f}  {outcome.seed} {outcome.what}" for outcome in lowest]
    lines += [f"  {outcome}" for outcome in outcomes if not outcome.fine]
    return lines


if __name__ == "__main__":
    sys.exit(main())
