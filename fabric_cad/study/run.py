"""A study from its definition to its table, sensitivities and picture."""

from __future__ import annotations

import csv
import hashlib
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..measured.tables import Family
from ..model.identification import identify_rows
from ..support.errors import FabricCadError, InputError, Problem
from ..support.staging import staged
from .definition import Study
from .design import DESIGNS, Samples
from .engine import run_tasks
from .places import check_places
from .rows import base_value, study_rows
from .sensitivity import left_out, read_sensitivities, sensitivities
from .store import Store, held, unit_key
from .table import write_table, written_digest
from .table_figures import identified_figures
from .units import Outcome, reason_of, run_unit


@dataclass(frozen=True)
class Progress:
    """How far a run is: units of the study, finished, finished in earlier runs, and s since this one began."""

    units: int
    finished: int
    before: int
    seconds: float

    @property
    def rate(self) -> float:
        """Units a second of this run."""
        return (self.finished - self.before) / self.seconds if self.seconds else 0.0

    @property
    def left(self) -> float:
        """Seconds left at this rate; infinite before the first unit."""
        return (self.units - self.finished) / self.rate if self.rate else float("inf")


@dataclass(frozen=True)
class Counts:
    """What became of a study's units; ``before`` were finished by earlier runs.

    ``reasons`` are (status, reason) of every refused or failed unit, ``notes`` what else is to be
    told.
    """

    folder: Path
    done: int
    refused: int
    failed: int
    before: int
    reasons: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = ()


def run_study(
    study: Study,
    out: str | Path = "build",
    scheduler: str | None = None,
    workers: int | None = None,
    listen: Callable[[Progress], None] = lambda _progress: None,
) -> Counts:
    """Run a study into the folder ``out/<study>``; units that an earlier run has finished are not run again.

    Leaves ``table.parquet`` and ``table.csv`` (one row a unit: factors, status, reason, figures),
    ``sensitivity.csv``, ``.png`` and ``.pdf`` where something varies, ``costs.csv`` (times and
    memory of every unit, not at depth identify) and, where the study keeps them, the units' files
    in ``cells``. Units that failed in an earlier run are tried again. Raises
    :class:`FabricCadError`; what is finished stays.
    """
    folder = Path(out) / study.name
    check_places(folder, study.keep)

    with held(folder):
        digest = _digest(study)
        written = written_digest(folder)  # and a lack of pyarrow is told before any work
        fabrics = _fabrics(study)
        _check_figures(study, fabrics.figures)

        if study.work.depth == "identify":
            ended = _identified(fabrics, is_written=written == digest)
        else:
            store = Store(folder)
            damage = _damage(store)
            outcomes, before = _run_units(study, store, folder, fabrics, scheduler, workers, listen)
            ended = _ended(fabrics, outcomes, before, damage)

        if not ended.is_written:
            _write(study, folder, fabrics.samples, ended, digest)
        notes = [*ended.notes, *left_out(study.figures, ended.figures, read_sensitivities(folder))]
        counts = {name: ended.status.count(name) for name in ("done", "refused", "failed")}
        why = tuple((ended.status[unit], ended.reasons[unit]) for unit in sorted(ended.reasons))
        return Counts(folder, **counts, before=ended.before, reasons=why, notes=tuple(notes))


@dataclass(frozen=True, eq=False)
class _Fabrics:
    """The units of a study as far as a whole table of them is identified at once.

    ``rows`` are the units that are fabrics; ``reasons`` say why the others are none; ``figures`` of
    the fabrics are there where they are asked for.
    """

    samples: Samples
    table: Family
    rows: np.ndarray
    reasons: Mapping[int, str]
    figures: Mapping[str, Sequence]


@dataclass(frozen=True, eq=False)
class _Ended:
    """What became of every unit.

    ``before`` were there before, with ``is_written`` the whole table too.
    """

    status: Sequence[str]
    reasons: Mapping[int, str]
    figures: Mapping[str, Sequence]
    costs: Mapping[str, Sequence]
    before: int
    is_written: bool = False
    notes: Sequence[str] = ()


def _fabrics(study: Study) -> _Fabrics:
    """Sample a study and identify all of its units."""
    values = {name: base_value(study.base, name) for name in study.factors}
    samples = DESIGNS[study.design](study.factors, values, study.samples, study.seed)
    table, refused = study_rows(study.base, samples)
    reasons = {unit: reason_of(InputError(problem)) for unit, problem in refused.items()}

    good = np.delete(np.arange(len(table)), list(refused))
    part = table.take(good.tolist()) if refused else table
    found = identify_rows(part)
    reasons |= {
        int(good[row]): reason_of(InputError(problem)) for row, problem in found.refused.items()
    }

    is_asked = study.figures or study.work.depth == "identify"
    figures = identified_figures(part, found) if is_asked else {}
    return _Fabrics(samples, table, good[found.rows], reasons, figures)


def _identified(fabrics: _Fabrics, is_written: bool) -> _Ended:
    """A study that ends with identification."""
    units = len(fabrics.table)
    status = ["refused" if unit in fabrics.reasons else "done" for unit in range(units)]
    figures = _spread(fabrics.figures, fabrics.rows, units)
    return _Ended(status, fabrics.reasons, figures, {}, units if is_written else 0, is_written)


def _ended(
    fabrics: _Fabrics, outcomes: Mapping[int, Outcome], before: int, notes: Sequence[str]
) -> _Ended:
    """A study whose fabrics were each run."""
    units, reasons = len(fabrics.table), dict(fabrics.reasons)
    reasons |= {unit: outcome.reason for unit, outcome in outcomes.items() if outcome.reason}
    status = [outcomes[unit].status if unit in outcomes else "refused" for unit in range(units)]
    figures = _gathered({unit: outcome.figures for unit, outcome in outcomes.items()}, units)
    costs = _gathered({unit: outcome.costs for unit, outcome in outcomes.items()}, units)
    return _Ended(status, reasons, figures, costs, before, notes=notes)


def _check_figures(study: Study, identified: Mapping[str, Sequence]) -> None:
    """Raise :class:`InputError` where no fabric of a study can have a figure that is asked for."""
    known_by_now = ("weave.", "identified.", "measured_vs_model.", "volumes.")
    missing = [
        name for name in study.figures if name.startswith(known_by_now) and name not in identified
    ]
    if missing:
        message = (
            f"{', '.join(missing)}: no fabric of this study has it; its rows lack what that needs"
        )
        raise InputError(Problem(message, f"{study.name}.toml", column="figures"))


def _damage(store: Store) -> list[str]:
    """What to say of a store's damaged lines."""
    if not store.damaged:
        return []
    count = len(store.damaged)
    what = "1 line is" if count == 1 else f"{count} lines are"
    return [
        f"{what} not as written by a study ({store.damaged[0]}): passed over, their units are run again"
    ]


def _digest(study: Study) -> str:
    """Digest of all that a study's table depends on."""
    from .. import __version__

    measured = {
        name: float(values[0]).hex() for name, values in sorted(study.base.measured.items())
    }
    parts: list[object] = [
        __version__,
        study.base.family,
        repr(study.base.weaves),
        study.base.sections,
    ]
    parts += [study.base.float_gaps, study.base.thicker, measured]
    parts += [
        study.factors,
        study.design,
        study.samples,
        study.seed,
        study.work,
        *study.work.made_of,
        study.figures,
    ]

    return hashlib.sha256(repr(parts).encode()).hexdigest()


def _spread(figures: Mapping[str, Sequence], rows: np.ndarray, units: int) -> dict[str, Sequence]:
    """Columns of fabrics as columns of units, empty where a unit is none."""
    if len(rows) == units:
        return dict(figures)
    spread: dict[str, Sequence] = {}
    for name, values in figures.items():
        if isinstance(values, np.ndarray) and values.dtype.kind == "f":
            spread[name] = np.full(units, np.nan)
            spread[name][rows] = values
        else:
            column = [None] * units
            for at, value in zip(
                rows.tolist(), values.tolist() if isinstance(values, np.ndarray) else values
            ):
                column[at] = value

            spread[name] = column

    return spread


def _gathered(cells: Mapping[int, Mapping], units: int) -> dict[str, list]:
    """Columns of the units' cells by unit number, in the order in which the units name them."""
    names = dict.fromkeys(name for at in sorted(cells) for name in cells[at])
    return {name: [cells.get(at, {}).get(name) for at in range(units)] for name in names}


def _run_units(
    study: Study,
    store: Store,
    folder: Path,
    fabrics: _Fabrics,
    scheduler: str | None,
    workers: int | None,
    listen: Callable[[Progress], None],
) -> tuple[dict[int, Outcome], int]:
    """Outcome of every fabric by unit number, and how many were there before."""
    table = fabrics.table
    units = {at: table.take([at]) for at in fabrics.rows.tolist()}
    keys = {at: unit_key(unit, study.work, study.keep) for at, unit in units.items()}
    cells = str((folder / "cells").absolute()) if study.keep else None
    copies = Counter(keys.values())
    missing = {
        key: at for at, key in reversed(keys.items()) if key not in store.outcomes
    }  # equal units once
    missing = dict(reversed(missing.items()))
    before = len(fabrics.reasons) + sum(key in store.outcomes for key in keys.values())
    start, ended = time.perf_counter(), 0

    def tell() -> None:
        finished = before + ended
        listen(Progress(len(table), finished, before, time.perf_counter() - start))

    def tasks() -> Iterator[tuple[str, tuple]]:
        for key, at in missing.items():
            yield key, (units[at], study.work, cells)

    tell()
    try:
        for result in run_tasks(tasks(), run_unit, scheduler, workers) if missing else ():
            if result is not None:
                key, outcome = result
                store.add(key, _outcome(outcome, study))
                ended += copies[key]

            tell()
    except KeyboardInterrupt as error:
        done = before + ended
        message = f"stopped; {done} of {len(table)} units are finished, the same command goes on from there"
        raise FabricCadError(message) from error
    finally:
        store.close()

    return {at: store.outcomes[key] for at, key in keys.items()}, before


def _outcome(result: object, study: Study) -> Outcome:
    if isinstance(result, Outcome):
        return result
    if isinstance(result, ChildProcessError):
        return Outcome(
            "failed",
            f"twice its worker died or took longer than limit_seconds = {study.work.limit_seconds:g}",
        )
    return Outcome("failed", f"{type(result).__name__}: {result}")


def _write(study: Study, folder: Path, samples: Samples, ended: _Ended, digest: str) -> None:
    units, figures, costs = len(samples), ended.figures, ended.costs
    columns: dict[str, Any] = {"unit": np.arange(units), **samples.labels, **samples.values}
    columns |= {
        "status": ended.status,
        "reason": [ended.reasons.get(at) for at in range(units)],
        **figures,
    }
    found = sensitivities(study.design, samples, figures, study.figures)

    with staged(folder, last="table.parquet") as aside:  # its digest says that the others are there
        write_table(columns, aside, digest)
        if found:
            _write_csv(aside / "sensitivity.csv", found)
            from .picture import draw_sensitivities

            draw_sensitivities(study.name, study.design, found, aside / "sensitivity.png")

        if costs:
            rows = [dict(zip(costs, values)) for values in zip(*costs.values())]
            _write_csv(aside / "costs.csv", [{"unit": at, **row} for at, row in enumerate(rows)])

    if not found:  # there may be those of what the study was before
        for name in ("sensitivity.csv", "sensitivity.png", "sensitivity.pdf"):
            (folder / name).unlink(missing_ok=True)


def _write_csv(path: Path, rows: Sequence[dict]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(
            {key: "" if value != value else value for key, value in row.items()} for row in rows
        )
