"""The command ``fabric-cad``."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from pathlib import Path

from . import __version__
from .errors import FabricCadError, InputError, OutputError

_DESCRIPTION = """\
From a few numbers measured on a woven fabric to a CAD model and a hexahedral mesh of its
elementary cell, in which the yarns touch exactly where they should and never run into each other.

Fabrics are rows of the family tables plain.csv, twill.csv, satin.csv and, for any other weave,
pattern.csv (lengths in mm): yarn density and width, and crimps or thicknesses. 'fabric-cad init'
puts tables to start from into ./families.
"""
_EPILOG = "exit status: 0 done, 2 bad input or usage, 1 anything else"

_MESH = (
    ("size", float, "MM", "target element size in mm; numbers given below win over it"),
    ("across", int, "N", "elements across a weft, and along a warp's crossings (default 12)"),
    ("crossing", int, "N", "elements along a weft's crossings, and across a warp (default: as --across)"),
    (
        "through",
        int,
        "N",
        "layers through the thickness, even for lenticular sections (default 2), from 4 for round ones (default 4)",
    ),
    ("gap", int, "N", "elements along the gap between crossings, even (default 4)"),
)


def _parser() -> argparse.ArgumentParser:
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument(
        "--families", metavar="DIR", default=argparse.SUPPRESS, help="folder of the family tables (default: families)"
    )
    common.add_argument("--out", metavar="DIR", default=argparse.SUPPRESS, help="folder for results (default: build)")
    common.add_argument("-q", "--quiet", action="store_true", default=argparse.SUPPRESS, help="say nothing but errors")
    parser = argparse.ArgumentParser(
        prog="fabric-cad",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        parents=[common],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"fabric-cad {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)

    def command(name: str, run, text: str, **more) -> argparse.ArgumentParser:
        added = commands.add_parser(name, parents=[common], help=text, description=text, epilog=_EPILOG, **more)
        added.set_defaults(run=run)
        return added

    command("list", _list, "list every row with its weave, its model and what identifies it")
    command("solve", _solve, "solve every row of every table into OUT/families/<family>.csv")
    command(
        "validate", _validate, "compare what rows measure beyond need with the model; propagate their *_std columns"
    )
    cell = command("cell", _cell, "make a row's STEP, mesh, deck, picture and report in OUT/<row>")
    cell.add_argument("row", metavar="ROW", help="name of a row of any family table")
    for name, kind, metavar, text in _MESH:
        cell.add_argument(f"--{name}", type=kind, metavar=metavar, help=text)
    cell.add_argument(
        "--deck",
        choices=("calculix", "abaqus"),
        default="calculix",
        help="dialect of the .inp; abaqus adds the *DISTRIBUTION TABLE that CalculiX does not know (default: calculix)",
    )
    for name, run, text in (
        ("tension", _tension, "stretch a row's cell biaxially with CalculiX: curves and surfaces of tension"),
        ("shear", _shear, "shear a row's cell with CalculiX: moment and force against the angle"),
    ):
        case = command(name, run, f"{text}; materials and loads: FAMILIES/simulation.toml")
        case.add_argument("row", metavar="ROW", help="name of a row of any family table")
        for option, kind, metavar, explained in _MESH:
            coarser = explained.split(" (default")[0] + (
                " (default: simulation.toml)" if "(default" in explained else ""
            )
            case.add_argument(f"--{option}", type=kind, metavar=metavar, help=coarser)
        case.add_argument("--ccx", metavar="PATH", help="the CalculiX solver (default: ccx on the PATH)")
        case.add_argument(
            "--threads", type=_positive(int), metavar="N", help="threads of the solver (default: all cores)"
        )
        case.add_argument(
            "--time-limit",
            type=_positive(float),
            metavar="S",
            default=3600.0,
            help="seconds for a solver job (default 3600)",
        )
        case.add_argument(
            "--deck",
            choices=("calculix", "abaqus"),
            help="write the deck in a solver's dialect and run nothing",
        )
    study = command("study", _study, "run a study of many fabrics into OUT/<study>; the same command again goes on")
    study.add_argument("file", metavar="STUDY.toml", help="base row, factors, design and depth (README, 'Studies')")
    study.add_argument("--scheduler", metavar="ADDRESS", help="a running Dask cluster, e.g. tcp://host:8786")
    study.add_argument("--workers", type=_count, metavar="N", help="processes on this machine (default: one a core)")
    show = command("show", _show, "show a row's cell in a window; makes it first if it is not there")
    show.add_argument("row", metavar="ROW", help="name of a row of any family table")
    wif = command("wif", _wif, "print a weaving draft (.wif) as a row to paste into pattern.csv")
    wif.add_argument("draft", metavar="DRAFT.wif", help="a draft with a tie-up and treadling, or a liftplan")
    wif.add_argument("--name", required=True, metavar="NAME", help="name of the row")
    command(
        "init",
        _init,
        "put the shipped family tables, simulation.toml and an example of a study into ./families "
        "(files that exist are kept)",
    )
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit status."""
    parsed = _parser().parse_args(arguments)
    settings = vars(parsed)
    settings.setdefault("families", "families")
    settings.setdefault("out", "build")
    settings.setdefault("quiet", False)
    try:
        status = parsed.run(parsed)
        sys.stdout.flush()
        return status
    except FabricCadError as error:
        print(error, file=sys.stderr)
        return error.exit_status
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # the reader has gone; nothing to flush to it
        return 1
    except BaseException as error:
        if library := _missing_library(error):
            print(
                f"the system lacks the library {library}; the README lists what a bare container lacks", file=sys.stderr
            )
            return 1
        if not _is_interrupt(error):
            raise
        print("\nstopped; earlier results are as they were", file=sys.stderr)
        return 1


def _missing_library(error: BaseException) -> str | None:
    """Name of the shared library that an extension module could not load."""
    text = str(error)
    if isinstance(error, (ImportError, OSError)) and "cannot open shared object file" in text:
        return text.split(":")[0]
    return None


def _is_interrupt(error: BaseException | None) -> bool:
    """True for Ctrl-C, also where an extension module has turned it into an error of its own."""
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__
    return False


class _Progress:
    """Stages as they run, on standard error: in place on a terminal, a line each elsewhere."""

    def __init__(self, quiet: bool) -> None:
        self.quiet = quiet
        self.terminal = sys.stderr.isatty()

    def __call__(self, name: str, seconds: float | None) -> None:
        if self.quiet or (seconds is None and not self.terminal):
            return
        if seconds is None:
            print(f"\r\033[K  {name} ...", end="", file=sys.stderr, flush=True)
        else:
            start = "\r\033[K" if self.terminal else ""
            print(f"{start}  {name:14}{seconds:6.2f} s", file=sys.stderr, flush=True)

    def solver(self, at) -> None:
        """An increment of a solver job, as :class:`fabric_cad.simulation.solver.Progress`."""
        if not self.quiet:
            start, end = ("\r\033[K", "") if self.terminal else ("", "\n")
            text = f"  state {at.step} of {at.steps}, increment {at.increment}: {100 * at.load:.0f} % of its load"
            print(f"{start}{text}", end=end, file=sys.stderr, flush=True)


def _tables(settings) -> tuple[dict, list[InputError]]:
    """Solved tables by family, and the errors of those that have none."""
    from .identification import identify
    from .tables import read_families

    solved, errors = {}, []
    for family, table in read_families(settings.families).items():
        if isinstance(table, InputError):
            errors.append(table)
            continue
        try:
            solved[family] = table, identify(table)
        except InputError as error:
            errors.append(error)
    return solved, errors


def _raise(errors: list[InputError]) -> None:
    if errors:
        raise InputError([problem for error in errors for problem in error.problems])


def _list(settings) -> int:
    solved, errors = _tables(settings)
    lines = [("row", "weave", "section", "model", "identified by", "thickness mm")]
    for family, (measured, table) in solved.items():
        columns = table.columns
        for at, name in enumerate(columns["name"]):
            kind = measured.weaves[at].name(family)
            quantities = ["density", "width", *columns["identified_by"][at].split()]
            lines.append(
                (
                    name,
                    kind,
                    columns["section"][at],
                    f"{columns['parameters'][at]} parameters",
                    ", ".join(quantities),
                    f"{columns['fabric_thickness_mm'][at]:.4g}",
                )
            )
    if not settings.quiet:
        _print_table(lines)
    _raise(errors)
    return 0


def _print_table(lines: list[tuple[str, ...]]) -> None:
    widths = [max(map(len, column)) for column in zip(*lines)]
    for line in lines:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())


def _solve(settings) -> int:
    from .staging import staged

    solved, errors = _tables(settings)
    target = Path(settings.out) / "families"
    with staged(target) as aside:
        for family, (_, table) in solved.items():
            table.write(aside / f"{family}.csv")
    if not settings.quiet:
        for family, (_, table) in solved.items():
            print(f"{target / family}.csv: {len(table)} rows")
            _print_notes(table)
    _raise(errors)
    return 0


def _print_notes(table) -> None:
    """What a solved table has to say beyond its numbers."""
    columns = table.columns
    for at, name in enumerate(columns["name"]):
        if columns["other_weft_thickness_mm"][at] != "":
            print(
                f"  {name}: two solutions, yarns of {columns['weft_thickness_mm'][at]:.4g} (weft) and "
                f"{columns['warp_thickness_mm'][at]:.4g} mm (warp), taken, "
                f"or {columns['other_weft_thickness_mm'][at]:.4g} and {columns['other_warp_thickness_mm'][at]:.4g} mm; "
                "column thicker = weft or warp chooses"
            )
        for quantity, measured, model in table.comparisons[at]:
            difference = 100 * (model - measured) / measured
            print(f"  {name}: {quantity} measured {measured:.4g}, model {model:.4g} ({difference:+.2f} %)")


def _validate(settings) -> int:
    from .scatter import doubts, propagate
    from .validation import compared, spread_out

    solved, errors = _tables(settings)
    comparisons, spreads, notes, worst = [], [], [], []
    for measured, table in solved.values():
        try:
            spread = propagate(measured, table)
        except InputError as error:
            errors.append(error)
            continue
        comparisons += compared(measured, table, spread)
        spreads += spread_out(measured, spread)
        notes += doubts(measured, table)
        worst += [100 * abs(model / value - 1) for row in table.comparisons for _, value, model in row]
    if not settings.quiet:
        if comparisons:
            _print_table([("row", "quantity", "measured", "model", "difference %"), *comparisons])
            print(f"{len(worst)} comparisons, the largest difference {max(worst):.2f} %")
        else:
            print("no row measures more than what identifies it: nothing to compare with the model")
        print()
        if spreads:
            _print_table([("row", "identified", "weft", "warp"), *spreads])
        else:
            print("no row gives a standard deviation (columns *_std): none to propagate")
        for note in notes:
            print(f"note: {note}")
    _raise(errors)
    return 0


def _cell(settings) -> int:
    from .pipeline import Stages, find_row, make_cell
    from .report import summary

    row, others = find_row(settings.families, settings.row)
    if not settings.quiet:
        for error in others:
            print(f"note, in a table this row is not of: {error}", file=sys.stderr)
    mesh = {name: getattr(settings, name) for name, *_ in _MESH if getattr(settings, name) is not None}
    report = make_cell(row, settings.out, mesh, settings.deck, Stages(_Progress(settings.quiet)))
    if not settings.quiet:
        print(summary(report))
        folder = Path(settings.out) / settings.row
        for name in (
            *(f"{settings.row}.{kind}" for kind in ("step", "msh", "inp", "vtu", "png")),
            "solved.csv",
            "report.json",
        ):
            print(f"  {folder / name}")
    return 0


def _positive(kind: type):
    """An option's reader: a number of a kind, above 0."""

    def read(text: str):
        value = kind(text)
        if not value > 0:
            raise ValueError
        return value

    read.__name__ = f"{kind.__name__} above 0"
    return read


def _tension(settings) -> int:
    from .simulation.run import make_tension

    return _simulate(settings, "tension", make_tension)


def _shear(settings) -> int:
    from .simulation.run import make_shear

    return _simulate(settings, "shear", make_shear)


def _simulate(settings, kind: str, make) -> int:
    """Run a case, or write its deck alone."""
    from .cores import cores
    from .pipeline import Stages, find_row
    from .simulation.job import Solver
    from .simulation.report import summary
    from .simulation.run import write_case
    from .simulation.solver import find_solver

    row, others = find_row(settings.families, settings.row)
    if not settings.quiet:
        for error in others:
            print(f"note, in a table this row is not of: {error}", file=sys.stderr)
    progress = _Progress(settings.quiet)
    mesh = {name: getattr(settings, name) for name, *_ in _MESH if getattr(settings, name) is not None}
    options = {"mesh": mesh, "stages": Stages(progress)}
    if settings.deck:
        for deck in write_case(kind, row, settings.families, settings.out, settings.deck, **options):
            if not settings.quiet:
                print(f"  {deck}")
        return 0
    solver = Solver(find_solver(settings.ccx), settings.threads or cores(), settings.time_limit, progress.solver)
    report = make(row, settings.families, settings.out, solver, **options)
    if not settings.quiet:
        print(summary(report))
        for file in report["files"]:
            print(f"  {Path(settings.out) / settings.row / file}")
    return 0


def _show(settings) -> int:
    mesh_file = Path(settings.out) / settings.row / f"{settings.row}.msh"
    if not mesh_file.exists():
        for name, *_ in _MESH:
            setattr(settings, name, None)
        settings.deck = "calculix"
        _cell(settings)
    from .meshing.mesher import read_mesh
    from .views import show_cell

    show_cell(read_mesh(mesh_file), settings.row)
    return 0


def _study(settings) -> int:
    from .study import read_study, run_study

    study = read_study(settings.file, settings.families)
    progress = _Units(settings.quiet)
    try:
        counts = run_study(study, settings.out, settings.scheduler, settings.workers, progress)
    finally:
        progress.end()
    if not settings.quiet:
        units = counts.done + counts.refused + counts.failed
        print(
            f"{study.name}: {units} units: {counts.done} done, {counts.refused} refused, {counts.failed} failed"
            + (f"; {counts.before} of them needed no run" if counts.before else "")
        )
        for name in ("table.parquet", "table.csv", "sensitivity.csv", "sensitivity.png"):
            if (counts.folder / name).exists():
                print(f"  {counts.folder / name}")
    return 0


class _Units:
    """A study's progress on standard error: in place on a terminal, a line every ten seconds elsewhere."""

    def __init__(self, quiet: bool) -> None:
        self.quiet, self.terminal, self.told = quiet, sys.stderr.isatty(), 0.0

    def __call__(self, progress) -> None:
        if self.quiet or not self.terminal and progress.seconds < self.told + 10.0:
            return
        self.told = progress.seconds
        left = f"{_clock(progress.left)} left" if progress.rate else "starting"
        text = f"  {progress.finished} of {progress.units} units, {progress.rate:.2f}/s, {left}"
        print(
            f"\r\033[K{text}" if self.terminal else text, end="" if self.terminal else "\n", file=sys.stderr, flush=True
        )

    def end(self) -> None:
        if self.terminal and not self.quiet:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"


def _count(text: str) -> int:
    if not (text.isdigit() and int(text)):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number above 0")
    return int(text)


def _wif(settings) -> int:
    from .wif import wif_row

    row = wif_row(settings.draft, settings.name)
    if not settings.quiet:
        print(row, end="")
    return 0


def shipped_families() -> Path:
    """Folder of the family tables that come with the package."""
    inside = Path(__file__).parent / "families"
    return inside if inside.is_dir() else Path(__file__).parents[1] / "families"


def _init(settings) -> int:
    target = Path("families")
    try:
        target.mkdir(exist_ok=True)
        for table in sorted([*shipped_families().glob("*.csv"), *shipped_families().glob("*.toml")]):
            place = target / table.name
            if place.exists():
                message = f"{place}: kept, it is there already"
            else:
                shutil.copyfile(table, place)
                message = f"{place}: written"
            if not settings.quiet:
                print(message)
    except OSError as error:
        raise OutputError(f"{error.filename or target}: cannot be written: {error.strerror}") from error
    return 0


if __name__ == "__main__":
    sys.exit(main())
