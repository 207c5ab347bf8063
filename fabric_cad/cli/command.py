"""The command ``fabric-cad``."""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from .. import __version__
from ..support.errors import FabricCadError, InputError, OutputError, did_you_mean, quoted
from ..support.interrupts import stoppable
from ..support.numerals import number, whole
from ..support.staging import commits, staged, standing
from . import terminal
from .terminal import complain, say

_DESCRIPTION = """\
From a few numbers measured on a woven fabric to a CAD model and a hexahedral mesh of its
elementary cell, in which the yarns touch exactly where they should and never run into each other.

Fabrics are rows of the family tables plain.csv, twill.csv, satin.csv and, for any other weave,
pattern.csv (lengths in mm): yarn density and width, and crimps or thicknesses. 'fabric-cad init'
puts tables to start from into ./families.
"""
_EPILOG = "exit status: 0 done, 2 bad input or usage, 1 anything else; of several rows the highest of theirs"

_MESH = (
    ("size", number, "MM", "target element size in mm; numbers given below win over it"),
    ("across", whole, "N", "elements across a weft, and along a warp's crossings (default 12)"),
    ("crossing", whole, "N", "elements along a weft's crossings, and across a warp (default: as --across)"),
    (
        "through",
        whole,
        "N",
        "layers through the thickness, even for lenticular sections (default 2), from 4 for round ones (default 4)",
    ),
    ("gap", whole, "N", "elements along the gap between crossings, even (default 4)"),
)


class _Parser(argparse.ArgumentParser):
    """A parser that names the nearest known word where it does not know one."""

    options: set[str] = set()
    """Every option of every command."""

    def add_argument(self, *names, **more):
        self.options.update(name for name in names if name.startswith("--"))
        return super().add_argument(*names, **more)

    def _print_message(self, message: str, file=None) -> None:
        """As the one of argparse, which takes a help that is lost for one that was read."""
        if message:
            say(message, end="") if file is sys.stdout else complain(message, end="")

    def error(self, message: str):
        if wrong := re.search(r"invalid choice: '([^']*)' \(choose from (.*)\)", message):
            message += did_you_mean(wrong[1], re.findall(r"[\w-]+", wrong[2]))
        elif wrong := re.match(r"unrecognized arguments: (--[^\s=]+)", message):
            message += did_you_mean(wrong[1], self.options)
        super().error(message)


def _parser() -> argparse.ArgumentParser:
    common = _Parser(add_help=False)
    common.add_argument(
        "--families", metavar="DIR", default=argparse.SUPPRESS, help="folder of the family tables (default: families)"
    )
    common.add_argument("--out", metavar="DIR", default=argparse.SUPPRESS, help="folder for results (default: build)")
    common.add_argument(
        "-q",
        "--quiet",
        action="store_true",
        default=argparse.SUPPRESS,
        help="no progress, notes and summaries of what files hold: only what list, validate and wif exist "
        "to print, warnings and errors",
    )
    parser = _Parser(
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
        added.set_defaults(run=run, usage_error=added.error)
        return added

    def rows(added: argparse.ArgumentParser, every: bool = True) -> None:
        """Arguments for the rows a command works on, one after the other."""
        added.add_argument("rows", metavar="ROW", nargs="*", help="names of rows of any family table")
        if every:
            added.add_argument("--all", action="store_true", help="every row of every family table")
        else:
            added.set_defaults(all=False)

    command("list", _list, "list every row with its weave, its model and what identifies it")
    command("solve", _solve, "solve every row of every table into OUT/families/<family>.csv")
    command(
        "validate", _validate, "compare what rows measure beyond need with the model; propagate their *_std columns"
    )
    cell = command("cell", _cell, "make the STEP, mesh, deck, picture and report of rows, each in OUT/<row>")
    rows(cell)
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
        rows(case)
        for option, kind, metavar, explained in _MESH:
            coarser = explained.split(" (default")[0] + (
                " (default: simulation.toml)" if "(default" in explained else ""
            )
            case.add_argument(f"--{option}", type=kind, metavar=metavar, help=coarser)
        case.add_argument("--ccx", metavar="PATH", help="the CalculiX solver (default: ccx on the PATH)")
        case.add_argument(
            "--threads", type=_positive(whole), metavar="N", help="threads of the solver (default: all cores)"
        )
        case.add_argument(
            "--time-limit",
            type=_positive(number),
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
    study.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="a running Dask cluster, e.g. tls://host:8786; whoever controls it can run code as you",
    )
    study.add_argument("--workers", type=_count, metavar="N", help="processes on this machine (default: one a core)")
    show = command("show", _show, "show a row's cell in a window; makes it first if it is not there")
    rows(show, every=False)
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
    try:
        return _main(arguments)
    except KeyboardInterrupt:  # once more while the first was told, or when all had been said
        complain("\nstopped")
        return 1


def _main(arguments: list[str] | None) -> int:
    terminal.prepare()
    with stoppable(), commits() as done:
        try:
            status = _run(arguments)
        except SystemExit as end:  # --help, --version and wrong usage
            if lost := terminal.finish():
                complain(lost)
                raise SystemExit(1) from end
            raise
        except BrokenPipeError:
            status = 1
        except BaseException as error:
            status, sentence = _told(error, done)
            complain(sentence)
    lost = terminal.finish()
    if lost:
        complain(lost)
    return status if lost is None else status or 1


def _run(arguments: list[str] | None) -> int:
    parsed = _parser().parse_args(arguments)
    settings = vars(parsed)
    settings.setdefault("families", "families")
    settings.setdefault("out", "build")
    settings.setdefault("quiet", False)
    try:
        os.getcwd()
    except OSError as error:
        raise OutputError("the current folder is gone (deleted, or moved away); change to one that is there") from error
    return parsed.run(parsed)


def _told(error: BaseException, done: Sequence[Path] = ()) -> tuple[int, str]:
    """Exit status and sentence for what went wrong; ``done`` are the folders that were put in place before.

    Raises the error again where it is a fault of the program.
    """
    if isinstance(error, FabricCadError):
        return error.exit_status, str(error)
    if library := _missing_library(error):
        return 1, f"the system lacks the library {library}; the README lists what a bare container lacks"
    if _is_interrupt(error):
        return 1, f"\nstopped; {standing(done)}"
    if isinstance(error, MemoryError):
        return 1, f"out of memory; {standing(done)}"
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return 1, f"{place}{error.strerror or error}"
    raise error


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
            complain(f"\r\033[K  {name} ...", end="")
        else:
            start = "\r\033[K" if self.terminal else ""
            complain(f"{start}  {name:14}{seconds:6.2f} s")

    def solver(self, at) -> None:
        """A case before its first state, or an increment, as :class:`fabric_cad.simulation.progress.CaseProgress`."""
        from ..simulation.progress import announced, told

        if self.quiet:
            return
        start, end = ("\r\033[K", "") if self.terminal else ("", "\n")
        if at.state:
            complain(f"{start}  {told(at)}", end=end)
        else:
            complain(f"{start}  {announced(at)}")


def _tables(settings, partial: bool = False) -> tuple[dict, list[InputError]]:
    """Measured and solved tables by family, and the errors of those that have none.

    With ``partial`` a table that can be read is there without its wrong rows, whose errors are told.
    """
    from ..measured.table_files import stray_tables
    from ..measured.tables import read_families
    from ..model.identification import identify, identify_rows

    solved, errors = {}, []
    for family, table in read_families(settings.families, partial).items():
        if isinstance(table, InputError):
            errors.append(table)
            continue
        try:
            if partial:
                found = identify_rows(table)
                refused = [*table.refused, *found.refused.values()]
                if refused:
                    errors.append(InputError(sorted(refused, key=lambda problem: problem.line)))
                table = table.take(found.rows.tolist())
            solved[family] = table, identify(table)
        except InputError as error:
            errors.append(error)
    if not settings.quiet:
        for stray in stray_tables(Path(settings.families)):
            complain(f"note: {stray}")
    return solved, errors


def _raise(errors: list[InputError]) -> None:
    if errors:
        raise InputError([problem for error in errors for problem in error.problems])


def _list(settings) -> int:
    solved, errors = _tables(settings, partial=True)
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
    _print_table(lines)
    _warn_of(settings, solved)
    _raise(errors)
    return 0


def _print_table(lines: list[tuple[str, ...]]) -> None:
    widths = [max(map(len, column)) for column in zip(*lines)]
    for line in lines:
        say("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())


def _solve(settings) -> int:
    solved, errors = _tables(settings)
    target = Path(settings.out) / "families"
    with staged(target) as aside:
        for family, (_, table) in solved.items():
            table.write(aside / f"{family}.csv")
    if not settings.quiet:
        for family, (_, table) in solved.items():
            say(f"{target / family}.csv: {len(table)} rows")
            _print_notes(table)
    _warn_of(settings, solved)
    _raise(errors)
    return 0


def _warn_of(settings, solved: dict) -> None:
    """Warn of what is seldom true of a fabric, in all rows of solved tables."""
    from ..model.plausibility import implausible

    for measured, table in solved.values():
        _warn(settings, map(str, implausible(measured, table.columns)))


def _warn(settings, sentences: Iterable[str]) -> None:
    """Print warnings to standard error, each once a command."""
    told = vars(settings).setdefault("told", set())
    for sentence in sentences:
        if sentence not in told:
            complain(f"warning: {sentence}")
            told.add(sentence)


def _print_notes(table) -> None:
    """What a solved table has to say beyond its numbers."""
    columns = table.columns
    for at, name in enumerate(columns["name"]):
        if columns["other_weft_thickness_mm"][at] != "":
            say(
                f"  {name}: two solutions, yarns of {columns['weft_thickness_mm'][at]:.4g} (weft) and "
                f"{columns['warp_thickness_mm'][at]:.4g} mm (warp), taken, "
                f"or {columns['other_weft_thickness_mm'][at]:.4g} and {columns['other_warp_thickness_mm'][at]:.4g} mm; "
                "column thicker = weft or warp chooses"
            )
        for quantity, measured, model in table.comparisons[at]:
            difference = 100 * (model - measured) / measured
            say(f"  {name}: {quantity} measured {measured:.4g}, model {model:.4g} ({difference:+.2f} %)")


def _validate(settings) -> int:
    from ..model.scatter import doubts, propagate
    from ..model.validation import compared, spread_out

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
    if comparisons:
        _print_table([("row", "quantity", "measured", "model", "difference %"), *comparisons])
        say(f"{len(worst)} comparisons, the largest difference {max(worst):.2f} %")
    else:
        say("no row measures more than what identifies it: nothing to compare with the model")
    say()
    if spreads:
        _print_table([("row", "identified", "weft", "warp"), *spreads])
    else:
        say("no row gives a standard deviation (columns *_std): none to propagate")
    for note in notes:
        say(f"note: {note}")
    _warn_of(settings, solved)
    _raise(errors)
    return 0


def _each_row(settings, work: Callable[[str], None]) -> int:
    """Do ``work`` for every row asked for, whatever becomes of the others; the worst exit status."""
    if settings.all == bool(settings.rows):
        settings.usage_error("give the names of rows or --all" + ", not both" * bool(settings.rows))
    names, errors = list(dict.fromkeys(settings.rows)), []
    if settings.all:
        solved, errors = _tables(settings, partial=True)
        names = [name for measured, _ in solved.values() for name in measured.names]
    elif len(names) == 1:
        work(names[0])
        return 0
    wrong: dict[str, int] = {}
    for name in names:
        if not settings.quiet:
            complain(f"{name}:")
        try:
            work(name)
        except BrokenPipeError:
            raise
        except Exception as error:
            wrong[name], sentence = _told(error)
            complain(sentence if name in sentence else f"{name}: {sentence}")
    for error in errors:
        complain(str(error))
    if not settings.quiet:
        done, failed = len(names) - len(wrong), f"; not: {', '.join(wrong)}" if wrong else ""
        tables = f"; {len(errors)} tables have errors" if errors else ""
        say(f"{len(names)} rows: {done} done{failed}{tables}")
    return max([0, *wrong.values(), *(error.exit_status for error in errors)])


def _row(settings, name: str):
    """The table of one row, warned of; what is wrong with other rows and tables is told once."""
    from ..cell.pipeline import find_row
    from ..model.identification import identify
    from ..model.plausibility import implausible

    row, others = find_row(settings.families, name)
    told = vars(settings).setdefault("told", set())
    for error in others:
        own = error.problems[0].path == row.path
        place = "another row of its table" if own else "in a table this row is not of"
        if not (settings.quiet or getattr(settings, "all", False) or str(error) in told):
            complain(f"note, {place}: {error}")
            told.add(str(error))
    _warn(settings, map(str, implausible(row, identify(row).columns)))
    return row


def _mesh_options(settings) -> dict[str, float]:
    """What the command line says of the mesh, as keywords of :func:`fabric_cad.mesh_options`."""
    asked = {name: getattr(settings, name, None) for name, *_ in _MESH}
    return {name: value for name, value in asked.items() if value is not None}


def _cell(settings) -> int:
    return _each_row(settings, lambda name: _make_cell(settings, name))


def _make_cell(settings, name: str) -> None:
    from ..cell.pipeline import Stages, make_cell
    from ..cell.report import summary
    from ..meshing.count import hexahedra
    from ..meshing.options import mesh_options
    from ..model.identification import identify

    row = _row(settings, name)
    if not settings.quiet:
        fabric = identify(row)[name]
        complain(f"  {hexahedra(fabric, mesh_options(fabric, **_mesh_options(settings)))} hexahedra to make")
    stages = Stages(_Progress(settings.quiet))
    report = make_cell(row, settings.out, _mesh_options(settings), settings.deck, stages)
    _warn(settings, report["warnings"])
    if settings.quiet:
        return
    say(summary(report))
    folder = Path(settings.out) / name
    kinds = ("step", "msh", "inp", "vtu", "png")
    for file in (*(f"{name}.{kind}" for kind in kinds), "solved.csv", "report.json"):
        say(f"  {folder / file}")
    sys.stdout.flush()


def _positive(kind):
    """An option's reader: what ``kind`` reads, above 0."""

    def read(text: str):
        value = kind(text)
        if not value > 0:
            raise ValueError
        return value

    read.__name__ = f"{kind.__name__} above 0"
    return read


def _tension(settings) -> int:
    from ..simulation.run import make_tension

    return _each_row(settings, lambda name: _simulate(settings, name, "tension", make_tension))


def _shear(settings) -> int:
    from ..simulation.run import make_shear

    return _each_row(settings, lambda name: _simulate(settings, name, "shear", make_shear))


def _simulate(settings, name: str, kind: str, make) -> None:
    """Run a case of one row, or write its deck alone."""
    from ..cell.pipeline import Stages
    from ..simulation.job import Solver
    from ..simulation.report import summary
    from ..simulation.run import write_case
    from ..simulation.solver import find_solver
    from ..support.cores import cores

    row = _row(settings, name)
    progress = _Progress(settings.quiet)
    options = {"mesh": _mesh_options(settings), "stages": Stages(progress)}
    if settings.deck:
        for deck in write_case(kind, row, settings.families, settings.out, settings.deck, **options):
            if not settings.quiet:
                say(f"  {deck}")
        return
    solver = Solver(find_solver(settings.ccx), settings.threads or cores(), settings.time_limit, progress.solver)
    report = make(row, settings.families, settings.out, solver, **options)
    _warn(settings, report["warnings"])
    if not settings.quiet:
        say(summary(report))
        for file in sorted([*report["files"], f"{kind}.json"]):
            say(f"  {Path(settings.out) / name / file}")
        sys.stdout.flush()


def _show(settings) -> int:
    return _each_row(settings, lambda name: _show_row(settings, name))


def _show_row(settings, name: str) -> None:
    mesh_file = Path(settings.out) / name / f"{name}.msh"
    if not mesh_file.exists():
        settings.deck = "calculix"
        _make_cell(settings, name)
    from ..meshing.mesher import read_mesh
    from ..pictures import show_cell

    show_cell(read_mesh(mesh_file), name)


def _study(settings) -> int:
    from ..study import read_study, run_study
    from ..study.answer import answer_lines, reasons_lines
    from ..study.sensitivity import read_sensitivities

    study = read_study(settings.file, settings.families)
    progress = _Units(settings.quiet)
    try:
        counts = run_study(study, settings.out, settings.scheduler, settings.workers, progress)
    finally:
        progress.end()
    for note in counts.notes:
        complain(f"note: {note}")
    if not settings.quiet:
        units = counts.done + counts.refused + counts.failed
        say(
            f"{study.name}: {units} units: {counts.done} done, {counts.refused} refused, {counts.failed} failed"
            + (f"; {counts.before} of them needed no run" if counts.before else "")
        )
        for line in [*reasons_lines(counts.reasons), *answer_lines(study.design, read_sensitivities(counts.folder))]:
            say(line)
        for name in ("table.parquet", "table.csv", "sensitivity.csv", "sensitivity.png"):
            if (counts.folder / name).exists():
                say(f"  {counts.folder / name}")
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
        complain(f"\r\033[K{text}" if self.terminal else text, end="" if self.terminal else "\n")

    def end(self) -> None:
        if self.terminal and not self.quiet:
            complain("\r\033[K", end="")


def _clock(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"


def _count(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text)):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a whole number above 0")
    return int(text)


def _wif(settings) -> int:
    from ..measured.wif import wif_row

    say(wif_row(settings.draft, settings.name), end="")
    return 0


def _other_form(table: Path) -> Path:
    """The file, or the workbook that holds the same table."""
    from ..measured.table_files import WORKBOOKS

    forms = [table.with_suffix(suffix) for suffix in WORKBOOKS] if table.suffix == ".csv" else []
    return next((form for form in forms if form.exists()), table)


def _init(settings) -> int:
    from ..measured.shipped import shipped_families

    target = Path("families")
    try:
        target.mkdir(exist_ok=True)
        for table in sorted([*shipped_families().glob("*.csv"), *shipped_families().glob("*.toml")]):
            place = _other_form(target / table.name)
            if place.exists():
                message = f"{place}: kept, it is there already"
            else:
                shutil.copyfile(table, place)
                message = f"{place}: written"
            if not settings.quiet:
                say(message)
    except OSError as error:
        raise OutputError(f"{error.filename or target}: cannot be written: {error.strerror}") from error
    return 0


if __name__ == "__main__":
    sys.exit(main())
