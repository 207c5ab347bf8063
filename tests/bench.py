"""Times and memory of what users wait for, in one run and as one table.

Every figure is of a whole process as the operating system accounts for it, beside what was
promised for two cores and, where there is one, a floor measured in the same run.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import statistics
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
PYTHON = sys.executable
FABRIC_CAD = [PYTHON, "-m", "fabric_cad"]


@dataclass(frozen=True)
class Figure:
    """One line of the table: medians over ``runs``; seconds, MB."""

    what: str
    seconds: float
    megabytes: float
    runs: int
    promised: str = ""
    note: str = ""


def measure(command: list[str], runs: int) -> tuple[float, float]:
    """Median wall time (s) and peak memory (MB) of a command."""
    seconds, memory = [], []
    for _ in range(runs):
        start = time.perf_counter()
        process = os.posix_spawn(command[0], command, os.environ, file_actions=_SILENT)
        _, status, usage = os.wait4(process, 0)
        seconds.append(time.perf_counter() - start)
        memory.append(usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3))
        if os.waitstatus_to_exitcode(status):
            raise SystemExit(f"failed: {' '.join(command)}")
    return statistics.median(seconds), statistics.median(memory)


_SILENT = [(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)]


def write_table(path: Path, columns: list[str], rows) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(rows)


def prepare(folder: Path) -> None:
    """Family tables the shipped ones do not have: a satin of 16 harnesses, a table of 10 000 rows."""
    write_table(
        folder / "families16" / "satin.csv",
        ["name", "harness", "step", "weft_density_per_mm", "weft_width_mm", "weft_crimp"],
        [("satin16", 16, 5, 0.8, 1.0, 0.003)],
    )
    columns = ["name", "over", "under"] + [
        f"{direction}_{quantity}"
        for direction in ("weft", "warp")
        for quantity in ("density_per_mm", "width_mm", "crimp")
    ]
    general = [
        f"{d}_{q}_{side}_mm" for q in ("contact", "offset") for d in ("weft", "warp") for side in ("top", "bottom")
    ]
    rows, general_rows = [], []
    for k in range(10_000):
        weft = (0.35, 2.0 + 0.00005 * k, 0.001 + 1e-6 * k)
        warp = (0.33, 2.6 - 0.00005 * k, 0.006 - 4e-7 * k) if k % 2 else ("", "", "")
        rows.append((f"row{k}", 1 + k % 4, 1 + k % 3, *weft, *warp, 0.35 if k % 2 else ""))
        width = weft[1], warp[1] or weft[1]
        rounded = k % 20 == 0
        shares = (0.985,) * 4 if rounded else (0.97, 0.95, 0.96, 0.94)
        chords = [share * width[at // 2] for at, share in enumerate(shares)]
        if not k % 2:
            chords[2:] = ["", ""]
        offsets = [0.05 if chord else "" for chord in chords]
        general_rows.append((*rows[-1], *chords, *offsets, ("lenticular", "round")[rounded]))
    columns.append("weft_thickness_mm")
    write_table(folder / "families10000" / "twill.csv", columns, rows)
    write_table(folder / "families10000g" / "twill.csv", [*columns, *general, "section"], general_rows)


def figures(folder: Path, runs: int):
    """Every figure, one after another; stage times go to the notes."""
    out = folder / "build"

    def take(what, command, promised="", note="", repeat=runs):
        seconds, memory = measure(command, repeat)
        return Figure(what, seconds, memory, repeat, promised, note)

    def cell(row, promised, *options, families=ROOT / "families", repeat=runs):
        command = [*FABRIC_CAD, "cell", row, "--families", str(families), "--out", str(out), *options]
        figure = take(f"cell {' '.join([row, *options])}", command, promised, repeat=repeat)
        report = json.loads((out / row / "report.json").read_text())
        stages = ", ".join(f"{name} {seconds:.2f}" for name, seconds in report["seconds"].items())
        size = (out / row / f"{row}.step").stat().st_size / 1e6
        note = f"{report['mesh']['hexahedra']} hexahedra, STEP {size:.2f} MB; {stages}"
        return Figure(**(asdict(figure) | {"note": note}))

    yield take("floor: python", [PYTHON, "-c", ""])
    yield take("floor: import cadquery, gmsh, pyvista", [PYTHON, "-c", "import cadquery, gmsh, pyvista"])
    yield take("import fabric_cad", [PYTHON, "-c", "import fabric_cad"], "0.3 s")
    yield take("list", [*FABRIC_CAD, "list", "--families", str(ROOT / "families")], "0.5 s")
    solve = [*FABRIC_CAD, "solve", "-q", "--out", str(out), "--families"]
    yield take("solve, 10 000 rows", [*solve, str(folder / "families10000")], "2 s")
    yield take("solve, 10 000 general rows", [*solve, str(folder / "families10000g")], "as fast")
    yield cell("twill32", "8 s, 1000 MB")
    yield cell("satin8", "15 s")
    yield cell("satin16", "4.5 x satin8", families=folder / "families16", repeat=1)
    million = ("--across", "36", "--through", "8", "--gap", "44")
    yield cell("twill32", "60 s, 6000 MB", *million, repeat=1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", type=Path, default=ROOT / "build" / "bench.json")
    settings = parser.parse_args()
    taken = []
    print(f"{'what':52}{'s':>8}{'x import':>10}{'MB':>8}  promised")
    with tempfile.TemporaryDirectory() as scratch:
        prepare(Path(scratch))
        for figure in figures(Path(scratch), settings.runs):
            taken.append(figure)
            floor = next((f.seconds for f in taken if "import cadquery" in f.what), None)
            ratio = f"{figure.seconds / floor:.2f}" if floor else ""
            print(
                f"{figure.what:52}{figure.seconds:8.2f}{ratio:>10}{figure.megabytes:8.0f}  {figure.promised}",
                flush=True,
            )
            if figure.note:
                print(f"    {figure.note}")
    by_name = {figure.what: figure.seconds for figure in taken}
    print(f"satin16 / satin8: {by_name['cell satin16'] / by_name['cell satin8']:.2f} (promised 4.5)")
    settings.json.parent.mkdir(parents=True, exist_ok=True)
    settings.json.write_text(json.dumps([asdict(figure) for figure in taken], indent=2) + "\n")
    print(settings.json)


if __name__ == "__main__":
    main()
