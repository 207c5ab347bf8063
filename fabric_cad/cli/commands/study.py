"""``fabric-cad study``: many fabrics, and what matters among them."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from ...support.errors import quoted
from ..options import Command, Options
from ..voice import Voice

_FILES = ("table.parquet", "table.csv", "sensitivity.csv", "sensitivity.png", "sensitivity.pdf")


@dataclass(frozen=True, kw_only=True)
class StudyOptions(Options):
    """The study's file and where its units run."""

    file: str
    scheduler: str | None = None
    workers: int | None = None


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``study``."""
    parser.add_argument(
        "file",
        metavar="STUDY.toml",
        help="base row, factors, design and depth (docs/studies.md)",
    )
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="a running Dask cluster, e.g. tls://host:8786; whoever controls it can run code as you",
    )
    parser.add_argument(
        "--workers",
        type=_count,
        metavar="N",
        help="processes on this machine (default: one a core)",
    )


def _count(text: str) -> int:
    """An option's reader: a whole number above 0."""
    if not (text.isascii() and text.isdigit() and int(text)):
        raise argparse.ArgumentTypeError(f"{quoted(text)} is not a whole number above 0")
    return int(text)


def run(options: StudyOptions, voice: Voice) -> int:
    """Run a study, or what is left of it, into OUT/<study>."""
    from ...study import read_study, run_study
    from ...study.answer import answer_lines, reasons_lines
    from ...study.sensitivity import read_sensitivities

    study = read_study(options.file, options.families)
    try:
        counts = run_study(study, options.out, options.scheduler, options.workers, voice.units)
    finally:
        voice.end_units()

    for note in counts.notes:
        voice.alert(f"note: {note}")
    if voice.quiet:
        return 0

    units = counts.done + counts.refused + counts.failed
    outcomes = f"{counts.done} done, {counts.refused} refused, {counts.failed} failed"
    before = f"; {counts.before} of them needed no run" if counts.before else ""
    voice.summary(f"{study.name}: {units} units: {outcomes}{before}")

    answer = answer_lines(study.design, read_sensitivities(counts.folder))
    for line in (*reasons_lines(counts.reasons), *answer):
        voice.summary(line)

    paths = (counts.folder / name for name in _FILES)
    voice.files(path for path in paths if path.exists())
    return 0


COMMAND = Command(
    name="study",
    text="run a study of many fabrics into OUT/<study>; the same command again goes on",
    options=StudyOptions,
    run=run,
    declare=declare,
)
