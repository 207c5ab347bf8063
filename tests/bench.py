"""Times and memory of what users wait for, in one run, as one table and as JSON.

Every figure is of a whole process as the operating system accounts for it, or of a stage of one,
beside what was promised for two cores and, where there is one, a floor measured in the same run:
bare imports, bare gmsh on a block of as many hexahedra, bare OCCT on the same shape. A figure is
one entry of :data:`FIGURES`.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "build" / "bench"
PYTHON = sys.executable
FABRIC_CAD = [PYTHON, "-m", "fabric_cad"]
IMPORTS = "floor: import cadquery, gmsh, pyvista"


@dataclass(frozen=True)
class Figure:
    """One line of the table: medians over ``runs``; s, MB; ``floor`` names the figure it cannot be below."""

    what: str
    seconds: float
    megabytes: float | None = None
    runs: int = 1
    size: str = ""
    floor: str = ""
    promised: str = ""
    stages: dict[str, float] = field(default_factory=dict)


_SILENT = [(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)]


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


def write_table(path: Path, columns: list[str], rows) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(rows)


def prepare(folder: Path) -> None:
    """Family tables the shipped ones do not have: a satin of 16 harnesses, tables of 10 000 rows."""
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
        f"{d}_{q}_{side}_mm"
        for q in ("contact", "offset")
        for d in ("weft", "warp")
        for side in ("top", "bottom")
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
    write_table(
        folder / "families10000g" / "twill.csv", [*columns, *general, "section"], general_rows
    )


@dataclass(frozen=True)
class Bench:
    """Where and how often to measure."""

    folder: Path
    runs: int

    def command(
        self, what: str, command: list[str], promised: str = "", floor: str = "", runs: int = 0
    ) -> Figure:
        """A whole process."""
        seconds, memory = measure(command, runs or self.runs)
        return Figure(what, seconds, memory, runs or self.runs, floor=floor, promised=promised)

    @property
    def folders(self) -> list[str]:
        """The shipped tables, and the folder of results."""
        return ["--families", str(ROOT / "families"), "--out", str(self.folder / "build")]

    def solve(self, what: str, families: str, promised: str) -> Figure:
        folders = ["--out", str(self.folder / "build"), "--families", str(self.folder / families)]
        return self.command(what, [*FABRIC_CAD, "solve", "-q", *folders], promised)

    def cell(
        self,
        row: str,
        promised: str,
        *options: str,
        families: Path = ROOT / "families",
        runs: int = 0,
    ) -> Figure:
        """All files of a cell, with the times of its stages."""
        folders = ["--families", str(families), "--out", str(self.folder / "build")]
        what = f"cell {' '.join([row, *options])}"
        figure = self.command(
            what, [*FABRIC_CAD, "cell", row, *folders, *options], promised, IMPORTS, runs
        )
        report = json.loads((self.folder / "build" / row / "report.json").read_text())
        megabytes = (self.folder / "build" / row / f"{row}.step").stat().st_size / 1e6
        size = f"{report['mesh']['hexahedra']} hexahedra, STEP {megabytes:.2f} MB"
        return Figure(**(asdict(figure) | {"size": size, "stages": report["seconds"]}))

    def stiffness(self, row: str, promised: str, *options: str, runs: int = 0) -> Figure:
        """A composite homogenised, with the times of its stages."""
        what = f"stiffness {' '.join([row, *options])}"
        figure = self.command(
            what, [*FABRIC_CAD, "stiffness", row, *self.folders, *options], promised, runs=runs
        )
        report = json.loads((self.folder / "build" / row / "stiffness.json").read_text())
        size = (
            f"{report['mesh']['hexahedra']} hexahedra, {report['solver']['iterations']} iterations"
        )
        return Figure(**(asdict(figure) | {"size": size, "stages": report["seconds"]}))

    def matrix(self, row: str, promised: str) -> Figure:
        """What the matrix of a composite cell takes beyond the mesh of its yarns: processor time in one process."""
        code = (
            "import sys, time\n"
            "from fabric_cad import composite_mesh_options, identify, read_families\n"
            "from fabric_cad.composite.matrix import composite_cell\n"
            "from fabric_cad.composite.spacing import gap_shares\n"
            "from fabric_cad.meshing.closed import closed_mesh\n"
            "from fabric_cad.meshing.plan import plan_yarns\n"
            "from fabric_cad.weave.weaves import yarns_of\n"
            "rows = (row for family in read_families(sys.argv[1]).values() for row in family)\n"
            "fabric = identify(next(row for row in rows if row.names == (sys.argv[2],)))[sys.argv[2]]\n"
            "mesh = composite_mesh_options(fabric)\n"
            "yarns = yarns_of(fabric.weave.interlacement())\n"
            "plans = plan_yarns(fabric, yarns, mesh, gap_shares(fabric, mesh))\n"
            "alone = closed_mesh(fabric, plans); start = time.process_time()\n"
            "composite_cell(alone, fabric, plans); print(time.process_time() - start)"
        )
        command = [PYTHON, "-c", code, str(ROOT / "families"), row]
        seconds = [
            float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
            for _ in range(self.runs)
        ]
        what = f"matrix of {row} beyond its yarns' mesh, processor time"
        return Figure(what, statistics.median(seconds), runs=self.runs, promised=promised)

    def floors(self, row: str) -> list[Figure]:
        """Two stages of a cell made before, each after its floor."""
        made = self.folder / "build" / row
        report, figures = json.loads((made / "report.json").read_text()), []
        count = str(report["mesh"]["hexahedra"])
        for stage, name, arguments in (
            (
                "mesh",
                "gmsh alone, a block of as many hexahedra",
                ["block", count, str(self.folder / "block.msh")],
            ),
            (
                "write STEP",
                "OCCT alone",
                ["step", str(made / f"{row}.step"), str(self.folder / "bare.step")],
            ),
        ):
            floor = f"floor: {stage} of {count} hexahedra: {name}"
            figures.append(
                Figure(
                    floor,
                    statistics.median(self.printed("floors.py", *arguments) for _ in range(3)),
                    runs=3,
                )
            )
            figures.append(
                Figure(
                    f"{row}, {stage} of {count} hexahedra", report["seconds"][stage], floor=floor
                )
            )
        return figures

    def printed(self, script: str, *arguments: str) -> float:
        """The number a script of the tests prints."""
        command = [PYTHON, str(ROOT / "tests" / script), *arguments]
        return float(
            subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()[-1]
        )

    def identify(self, fabrics: int, promised: str) -> list[Figure]:
        """Fabrics of a study identified: the identification in one process, and the whole command."""
        code = (
            "import sys, time; from fabric_cad.study.definition import read_study\n"
            "from fabric_cad.study.design import DESIGNS; from fabric_cad.study.rows import study_rows\n"
            "from fabric_cad.study.table_figures import identified_figures\n"
            "from fabric_cad.model.identification import identify_rows\n"
            "study = read_study(sys.argv[1], sys.argv[2])\n"
            "samples = DESIGNS[study.design](study.factors, {}, study.samples, study.seed)\n"
            "start = time.perf_counter(); table, refused = study_rows(study.base, samples)\n"
            "identified_figures(table, identify_rows(table)); print(time.perf_counter() - start)"
        )
        file = self.study("many", "plain_measured", "identify", fabrics, '"normal"', '"normal"')
        arguments = [str(file), str(ROOT / "families")]
        alone = [
            float(
                subprocess.run(
                    [PYTHON, "-c", code, *arguments], check=True, capture_output=True, text=True
                ).stdout.split()[-1]
            )
            for _ in range(self.runs)
        ]
        whole = self.command(
            f"study, {fabrics} fabrics, with table and picture", self.run(file), runs=1
        )
        return [
            Figure(
                f"{fabrics} fabrics identified",
                statistics.median(alone),
                runs=self.runs,
                promised=promised,
            ),
            whole,
        ]

    def tension(self, row: str, what: str, case: str, promised: str) -> Figure:
        """A row's biaxial tension, from the table to the pictures; ``case`` is the [tension] of its settings."""
        families = self.folder / "families_loaded"
        families.mkdir(exist_ok=True)
        for table in (ROOT / "families").glob("*.csv"):
            (families / table.name).write_bytes(table.read_bytes())
        (families / "simulation.toml").write_text(f"[tension]\n{case}")
        folders = ["--families", str(families), "--out", str(self.folder / "build")]
        figure = self.command(
            f"tension {row}, {what}", [*FABRIC_CAD, "tension", row, *folders], promised, runs=1
        )
        report = json.loads((self.folder / "build" / row / "tension.json").read_text())
        size = f"{report['mesh']['hexahedra']} hexahedra, {report['solver']['states']} states"
        memory = max(figure.megabytes, report["solver"]["peak_memory_MB"])
        return Figure(
            **(asdict(figure) | {"size": size, "megabytes": memory, "stages": report["seconds"]})
        )

    def page(self) -> list[Figure]:
        """The page that draws a fabric in a browser: until it can be used, and from a slider's event to the drawing."""
        if not (shutil.which("chromium") or shutil.which("chromium-browser")):
            return []
        command = [PYTHON, str(ROOT / "tests" / "page_latency.py"), "8", "16"]
        found = json.loads(
            subprocess.run(command, check=True, capture_output=True, text=True).stdout
        )
        software = "SwiftShader" in found["renderer"]
        size = "SwiftShader (software)" if software else found["renderer"][:34]
        figures = [Figure("page, start to usable", found["usable"], promised="3 s")]
        for crossings, promised in (("8", "0.1 s"), ("16", "0.15 s")):
            what = f"page, {crossings} x {crossings}, event to draw call"
            seconds = {name: value / 1000 for name, value in found[crossings].items()}
            figures.append(
                Figure(what, seconds["drawn"], size=size, promised=promised, stages=seconds)
            )
        return figures

    def study(self, name: str, base: str, depth: str, units: int, width: str, crimp: str) -> Path:
        file = self.folder / f"{name}.toml"
        file.write_text(
            f'base = "{base}"\ndepth = "{depth}"\ndesign = "latin-hypercube"\nsamples = {units}\n'
            f"[factors]\nweft_width_mm = {width}\nweft_crimp = {crimp}\n"
        )
        return file

    def run(self, file: Path) -> list[str]:
        folders = ["--families", str(ROOT / "families"), "--out", str(self.folder / "build")]
        return [*FABRIC_CAD, "study", str(file), "-q", *folders, "--workers", "2"]

    def cells(self, count: int, promised: str) -> list[Figure]:
        """A study of twills 2*2 with mesh over two workers: the whole, the first and one more fabric of a worker."""
        file = self.study(
            "cells",
            "twill22",
            "mesh",
            count,
            "{ from = 2.1, to = 2.7 }",
            "{ from = 0.003, to = 0.005 }",
        )
        whole = self.command(f"study, {count} twill 2*2 with mesh", self.run(file), runs=1)
        with open(self.folder / "build" / "cells" / "costs.csv", newline="") as costs:
            rows = [
                {name: float(cell) for name, cell in row.items()}
                for row in csv.DictReader(costs)
                if row["total"]
            ]
        memory = max(row["process_megabytes"] for row in rows)
        first, more = [row for row in rows if row["load CadQuery"] > 0.1], []
        more = [row for row in rows if row not in first]
        stages = {
            name: round(statistics.median(row[name] for row in more), 4)
            for name in more[0]
            if name not in _NO_STAGE
        }
        return [
            Figure(
                f"{whole.what}, a cell",
                whole.seconds / count,
                memory,
                size=f"{count} cells",
                promised=promised,
            ),
            Figure("  the first of a worker", statistics.median(row["total"] for row in first)),
            Figure("  one more", statistics.median(row["total"] for row in more), stages=stages),
            Figure(
                "  one more, processor time", statistics.median(row["processor"] for row in more)
            ),
            Figure(whole.what, whole.seconds, memory, promised="below 1500 MB a worker"),
        ]


_NO_STAGE = ("unit", "total", "processor", "process_megabytes", "load CadQuery")
_EQUAL = "ratios = [1]\npoints = 1\ngrid = 0\n"
_FINE = ("--across", "32", "--crossing", "32", "--gap", "16", "--through", "8", "--layers", "12")
_VOXELS = ("--cells", "200x200x60")
_MILLION = ("--across", "36", "--through", "8", "--gap", "44")

FIGURES: tuple[Callable[[Bench], Figure | list[Figure]], ...] = (
    lambda b: b.command("floor: python", [PYTHON, "-c", ""]),
    lambda b: b.command(IMPORTS, [PYTHON, "-c", "import cadquery, gmsh, pyvista"]),
    lambda b: b.command(
        "import fabric_cad", [PYTHON, "-c", "import fabric_cad"], "0.3 s", "floor: python"
    ),
    lambda b: b.command(
        "list",
        [*FABRIC_CAD, "list", "--families", str(ROOT / "families")],
        "0.5 s",
        "floor: python",
    ),
    lambda b: b.solve("solve, 10 000 rows", "families10000", "2 s"),
    lambda b: b.solve("solve, 10 000 general rows", "families10000g", "as fast"),
    lambda b: b.identify(100_000, "1 s"),
    lambda b: b.cell("twill32", "8 s, 1000 MB"),
    lambda b: b.floors("twill32"),
    lambda b: b.cell("satin8", "15 s"),
    lambda b: b.cell("satin16", "4.5 x satin8", families=b.folder / "families16", runs=1),
    lambda b: b.cell("twill32", "60 s, 6000 MB", *_MILLION, runs=1),
    lambda b: b.floors("twill32"),
    lambda b: b.tension("plain_flat", "k = 1 to 0.4 %", _EQUAL, "10 s"),
    lambda b: b.tension(
        "plain_flat", "5 x 5 surface", "ratios = [1]\npoints = 4\ngrid = 5\n", "120 s, 2000 MB"
    ),
    lambda b: b.tension("twill22", "k = 1 to 0.4 %", _EQUAL, "60 s"),
    lambda b: b.cells(200, "0.7 s"),
    lambda b: b.page(),
    lambda b: b.matrix("twill32", "0.5 s"),
    lambda b: b.stiffness("plain", "8 s"),
    lambda b: b.stiffness("twill32", "30 s"),
    lambda b: b.stiffness("plain", "300 s, 4000 MB", *_FINE, runs=1),
    lambda b: b.command(
        "voxels twill32, 200 x 200 x 60",
        [*FABRIC_CAD, "voxels", "twill32", *_VOXELS, *b.folders],
        "1 s more",
    ),
)
"""What is measured, in this order: add a line for a figure more."""


def show(figure: Figure, taken: dict[str, Figure]) -> None:
    """Print one line of the table, and the stages below it."""
    floor = taken.get(figure.floor)
    ratio = f"{figure.seconds / floor.seconds:.2f}" if floor else ""
    memory = "" if figure.megabytes is None else f"{figure.megabytes:.0f}"
    print(
        f"{figure.what:66}{figure.seconds:8.2f}{ratio:>8}{memory:>7}  {figure.size:34}{figure.promised}".rstrip()
    )
    if figure.stages:
        print(
            "    " + ", ".join(f"{name} {seconds:.2f}" for name, seconds in figure.stages.items())
        )
    sys.stdout.flush()


def compare(paths: list[Path]) -> None:
    """Two runs side by side: seconds, memory, and the second's share of the first's seconds."""
    one, two = ({each["what"]: each for each in json.loads(path.read_text())} for path in paths)
    names = [path.stem for path in paths]
    print(f"{'':66}{names[0]:>22}{names[1]:>22}{'ratio':>8}")
    for what in dict.fromkeys([*one, *two]):
        cells = []
        for run in (one, two):
            found = run.get(what)
            memory = (
                f"{found['megabytes']:.0f} MB" if found and found["megabytes"] is not None else ""
            )
            cells.append(f"{found['seconds']:.2f} s{memory:>9}" if found else "")
        both = what in one and what in two
        ratio = f"{two[what]['seconds'] / one[what]['seconds']:.2f}" if both else ""
        print(f"{what:66}{cells[0]:>22}{cells[1]:>22}{ratio:>8}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", type=Path, help="default: build/bench/<time>.json")
    parser.add_argument(
        "--compare",
        nargs="*",
        type=Path,
        metavar="RUN.json",
        help="two runs; default: the last two",
    )
    settings = parser.parse_args()
    if settings.compare is not None:
        runs = settings.compare or sorted(RESULTS.glob("*.json"))[-2:]
        if len(runs) != 2:
            raise SystemExit(
                f"two runs are needed, {len(runs)} given or in {RESULTS.relative_to(ROOT)}"
            )
        return compare(runs)
    taken: dict[str, Figure] = {}
    print(f"{'what':66}{'s':>8}{'/floor':>8}{'MB':>7}  {'size':34}promised")
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(Path(scratch), settings.runs)
        prepare(bench.folder)
        for figure in FIGURES:
            found = figure(bench)
            for each in found if isinstance(found, list) else [found]:
                taken[each.what] = each
                show(each, taken)
    print(
        f"satin16 / satin8: {taken['cell satin16'].seconds / taken['cell satin8'].seconds:.2f} (promised 4.5)"
    )
    path = settings.json or RESULTS / f"{time.strftime('%Y-%m-%dT%H-%M-%S')}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps([asdict(figure) for figure in taken.values()], indent=2) + "\n")
    print(path)


if __name__ == "__main__":
    main()
