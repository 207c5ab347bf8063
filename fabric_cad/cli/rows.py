"""The rows a command works on: one, several, or all of all tables."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..support.errors import InputError
from .failures import told
from .options import Options, RowOptions, UsageError
from .voice import Voice

if TYPE_CHECKING:
    from ..measured.tables import Family
    from ..model.solved import SolvedTable


@dataclass(frozen=True)
class Tables:
    """Measured and solved tables by family, and the errors of those that have none."""

    solved: dict[str, tuple[Family, SolvedTable]]
    errors: tuple[InputError, ...]

    @property
    def names(self) -> list[str]:
        """Names of all rows that were solved."""
        return [name for measured, _ in self.solved.values() for name in measured.names]

    def warn(self, voice: Voice) -> None:
        """Warn of what is seldom true of a fabric, in all rows."""
        from ..model.plausibility import implausible

        for measured, table in self.solved.values():
            voice.warn(map(str, implausible(measured, table.columns)))


def read_tables(options: Options, voice: Voice, partial: bool = False) -> Tables:
    """Read and solve every family table.

    With ``partial`` a table that can be read is there without its wrong rows, whose errors are
    among the errors.
    """
    from ..measured.table_files import stray_tables
    from ..measured.tables import read_families

    solved: dict[str, tuple[Family, SolvedTable]] = {}
    errors: list[InputError] = []
    for family, table in read_families(options.families, partial).items():
        if isinstance(table, InputError):
            errors.append(table)
            continue

        try:
            solved[family] = _solved(table, errors, partial)
        except InputError as error:
            errors.append(error)

    for stray in stray_tables(Path(options.families)):
        voice.remark(f"note: {stray}")

    return Tables(solved, tuple(errors))


def _solved(table: Family, errors: list[InputError], partial: bool) -> tuple[Family, SolvedTable]:
    """A table, with ``partial`` its right rows alone, and what it is solved to."""
    from ..model.identification import identify, identify_rows

    if partial:
        identified = identify_rows(table)
        refused = [*table.refused, *identified.refused.values()]
        if refused:
            errors.append(InputError(sorted(refused, key=lambda problem: problem.line or 0)))
        table = table.take(identified.rows.tolist())

    return table, identify(table)


def raise_together(errors: Iterable[InputError]) -> None:
    """Raise one :class:`InputError` with the problems of several, where there are any."""
    problems = [problem for error in errors for problem in error.problems]
    if problems:
        raise InputError(problems)


def find_row(name: str, options: RowOptions, voice: Voice) -> Family:
    """The table of one row, warned of; what is wrong with other rows and tables is told once."""
    from ..cell import pipeline
    from ..model.identification import identify
    from ..model.plausibility import implausible

    row, others = pipeline.find_row(options.families, name)
    for error in () if options.every else others:
        is_own = error.problems[0].path == row.path
        place = "another row of its table" if is_own else "in a table this row is not of"
        voice.remark_once(str(error), f"note, {place}: {error}")

    voice.warn(map(str, implausible(row, identify(row).columns)))
    return row


def work_on_rows(options: RowOptions, voice: Voice, work: Callable[[str], None]) -> int:
    """Do ``work`` for every row asked for, whatever becomes of the others; the worst exit status.

    Raises :class:`UsageError` where no rows are asked for, or both some and all.
    """
    if options.every == bool(options.rows):
        raise UsageError("give the names of rows or --all" + ", not both" * bool(options.rows))

    names = list(dict.fromkeys(options.rows))
    errors: tuple[InputError, ...] = ()
    if options.every:
        tables = read_tables(options, voice, partial=True)
        names, errors = tables.names, tables.errors
    elif len(names) == 1:
        work(names[0])
        return 0

    failed = _work_on_all(names, voice, work)
    for error in errors:
        voice.alert(str(error))

    done, others = len(names) - len(failed), f"; not: {', '.join(failed)}" if failed else ""
    wrong = f"; {len(errors)} tables have errors" if errors else ""
    voice.summary(f"{len(names)} rows: {done} done{others}{wrong}")

    return max([0, *failed.values(), *(error.exit_status for error in errors)])


def _work_on_all(names: list[str], voice: Voice, work: Callable[[str], None]) -> dict[str, int]:
    """Do ``work`` for rows one after the other; the exit statuses of those that failed."""
    failed: dict[str, int] = {}
    for name in names:
        voice.remark(f"{name}:")
        try:
            work(name)
        except BrokenPipeError:
            raise
        except Exception as error:
            failed[name], sentence = told(error)
            voice.alert(sentence if name in sentence else f"{name}: {sentence}")

    return failed
