"""Random fabrics through every stage, each in a child process with a time limit.

``python tests/stability.py [--part PART] [--seeds FIRST-END] [--workers N]``: every fabric must
come out consistent or be refused for a reason its numbers give; anything else fails the run.

standard  contact over the whole width, widths 0.6 to 0.97 of the spacing
general   chords, offsets and all three lateral forms
patterns  general fabrics of any weave
narrow    widths 0.95 to 0.999 of the spacing
unequal   one direction's yarns up to four times as thick as the other's
flat-gaps as patterns, with float_gap = flat

Two parts fill the space between the yarns instead, as ``composite`` does at its default mesh, without CAD:

matrix          the fabrics of standard
matrix-general  those of general
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

from fabrics import DRAWS, random_general_row, random_row, table  # noqa: E402

TIME_LIMIT = 180.0  # s a fabric
MATRIX_DRAWS = {"matrix": random_row, "matrix-general": random_general_row}
PARTS = DRAWS | MATRIX_DRAWS
SEEDS = {part: range(100 if part in MATRIX_DRAWS else 200) for part in PARTS}


@dataclass(frozen=True)
class Outcome:
    """What became of one fabric: consistent, refused, failed (with its stage), crashed or too slow.

    ``quality`` is the least scaled Jacobian, ``allowed`` what the yarns' edges allow; of a matrix nothing is known.
    """

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
        allowed = "" if np.isnan(self.allowed) else f" of {self.allowed:.3f}"
        quality = "" if np.isnan(self.quality) else f"  scaled Jacobian {self.quality:.3f}{allowed}"
        return f"{self.seed:6d}  {self.kind:10}  {self.what}{quality}"


def _child(seed: int, part: str, pipe) -> None:
    from fabric_cad.support.errors import InputError

    reached = ["table"]
    try:
        family, row = PARTS[part](np.random.default_rng(seed), f"r{seed}")
        made = _matrix if part in MATRIX_DRAWS else _cell
        pipe.send(made(seed, table(family, row), reached))
    except InputError as error:
        pipe.send(Outcome(seed, "refused", str(error).split(": ", 1)[-1]))
    except BaseException as error:
        pipe.send(Outcome(seed, "failed", f"at {reached[-1]}: {type(error).__name__}: {error}"))


def _cell(seed: int, measured, reached: list[str]) -> Outcome:
    """All files of a dry cell; the stages that are done go to ``reached``."""
    from fabric_cad.cell.pipeline import Stages, make_cell

    with tempfile.TemporaryDirectory() as out:
        report = make_cell(measured, out, stages=Stages(lambda name, seconds: reached.append(name)))
    mesh = report["mesh"]
    fraction = report["volumes"]["yarn_volume_fraction"]
    if not 0 < fraction < 1:
        raise ValueError(f"yarn volume fraction {fraction}")
    weave = report["weave"]
    counts = (
        f"{weave['wefts']} x {weave['warps']}"
        if weave["over"] is None
        else f"{weave['over']}*{weave['under']}"
    )
    what = f"{measured.family} {counts} {report['section']} {report['parameters']} parameters"
    return Outcome(
        seed, "consistent", what, mesh["min_scaled_jacobian"], mesh["scaled_jacobian_edges_allow"]
    )


def _matrix(seed: int, measured, reached: list[str]) -> Outcome:
    """The composite cell's mesh, with what has to hold of it; the stages that are done go to ``reached``."""
    from composite_checks import check_fills, check_repeats

    from fabric_cad.composite.matrix import mesh_composite
    from fabric_cad.composite.spacing import composite_mesh_options
    from fabric_cad.meshing.quality import hexahedra_quality
    from fabric_cad.model.identification import identify
    from fabric_cad.model.plausibility import LEAST_JACOBIAN

    (fabric,) = identify(measured)
    reached.append("identify")
    cell = mesh_composite(fabric, composite_mesh_options(fabric))
    reached.append("mesh")
    check_fills(cell)
    check_repeats(cell)

    jacobian = hexahedra_quality(cell.mesh.points, cell.mesh.hexahedra).scaled_jacobian
    if not jacobian.min() > LEAST_JACOBIAN:
        raise ValueError(f"scaled Jacobian {jacobian.min():.3g}")
    what = f"{measured.family} {fabric.weave.wefts} x {fabric.weave.warps} {fabric.section}"
    return Outcome(seed, "consistent", what, float(jacobian[cell.in_matrix].min()))


def try_fabric(seed: int, part: str) -> Outcome:
    """One random fabric through the pipeline in a process of its own."""
    context = multiprocessing.get_context("forkserver" if sys.platform != "win32" else "spawn")
    if sys.platform != "win32":
        context.set_forkserver_preload(
            ["fabric_cad.cad", "fabric_cad.masters.woven", "fabric_cad.pictures", "gmsh"]
        )
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
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--part", choices=PARTS, action="append", help="default: all")
    parser.add_argument(
        "--seeds", type=seed_range, metavar="FIRST-END", help="default: 0-200, of a matrix 0-100"
    )
    parser.add_argument("--workers", type=int, default=2)
    settings = parser.parse_args()
    runs = {
        part: _run(part, settings.seeds or SEEDS[part], settings.workers)
        for part in settings.part or PARTS
    }
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
    lines = [
        f"{part}: {len(outcomes)} fabrics: "
        + ", ".join(f"{number} {what}" for what, number in counts.items())
    ]
    if part in MATRIX_DRAWS:
        lines += _matrix_summary(meshed, shown)
    else:
        lowest = sorted(meshed, key=lambda outcome: outcome.quality / outcome.wanted)[:shown]
        poor = sum(not outcome.good_elements for outcome in meshed)
        bound = "below min(0.30, 0.9 of what the yarns' edges allow)"
        lines.append(f"  {bound}: {poor} of {len(meshed)}; the lowest against it:")
        lines += [
            f"    {one.quality:.3f} of {one.wanted:.3f}  {one.seed} {one.what}" for one in lowest
        ]
    lines += [f"  {outcome}" for outcome in outcomes if not outcome.fine]
    return lines


def _matrix_summary(meshed: list[Outcome], shown: int) -> list[str]:
    """Least scaled Jacobians of the matrix: their least and median by the section's form, and the lowest."""
    lines = []
    for form in ("lenticular", "flat", "round"):
        least = [outcome.quality for outcome in meshed if outcome.what.endswith(form)]
        if least:
            lines.append(
                f"  {len(least)} {form}: {min(least):.3f} at least, median {np.median(least):.3f}"
            )
    lowest = sorted(meshed, key=lambda outcome: outcome.quality)[:shown]
    return lines + [
        f"    {outcome.quality:.3f}  {outcome.seed} {outcome.what}" for outcome in lowest
    ]


if __name__ == "__main__":
    sys.exit(main())
