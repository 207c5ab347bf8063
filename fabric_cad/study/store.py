"""Finished units on disk: lines that are only ever added, so that a run may be killed at any moment.

Every run adds to a file of its own, one line a unit, and lines that a kill or a disk has damaged
are passed over. A unit is known by a digest of all that its figures depend on, so that a study that
was changed finds those of its units that are still the same.
"""

from __future__ import annotations

import hashlib
import json
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

from .. import __version__
from ..measured.tables import Family
from ..support import locks
from ..support.errors import OutputError
from .lines import read_line, written_line
from .units import Outcome, Work


def unit_key(row: Family, work: Work, keep: bool) -> str:
    """Digest of a table of one row and of what is done with it."""
    numbers = {name: float(values[0]).hex() for name, values in row.measured.items()}
    inputs = [__version__, work.depth, sorted(work.mesh.items()), repr(work.settings), keep]
    inputs += [
        *work.made_of,
        row.family,
        repr(row.weaves[0]),
        row.sections[0],
        row.float_gaps[0],
        row.thicker[0],
    ]
    inputs.append(sorted(numbers.items()))
    return hashlib.sha256(json.dumps(inputs).encode()).hexdigest()[:32]


class Store:
    """Outcomes by unit key, in a folder ``units`` of the study's own.

    ``outcomes`` holds what is kept: units that are done or refused. A unit that failed may do so no
    longer (a full disk, a limit since raised), and is to be run again. ``damaged`` are the places
    of lines that are not as they were written, whose units are run again too. Raises
    :class:`OutputError` where the folder cannot be read or written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "units"
        self.file: TextIO | None = None
        self.outcomes: dict[str, Outcome] = {}
        self.damaged: list[str] = []

        with _output_errors(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)
            for path in sorted(self.folder.glob("*.jsonl")):
                self._read(path)

    def _read(self, path: Path) -> None:
        for number, line in enumerate(path.read_bytes().split(b"\n"), 1):
            if not line:
                continue
            try:
                key, outcome = read_line(line)
            except ValueError:
                self.damaged.append(f"{path}:{number}")
                continue
            if outcome.status != "failed":
                self.outcomes.setdefault(key, outcome)

    def add(self, key: str, outcome: Outcome) -> None:
        """Record a unit; it is on the disk when this returns."""
        with _output_errors(self.folder):
            if self.file is None:
                path = self.folder / f"{os.getpid()}-{secrets.token_hex(4)}.jsonl"
                self.file = open(path, "x", encoding="utf-8")
            self.file.write(written_line(key, outcome))
            self.file.flush()
            os.fsync(self.file.fileno())
        self.outcomes[key] = outcome

    def close(self) -> None:
        """Close the file of this run."""
        if self.file is not None:
            with suppress(OSError):  # a line that a full disk did not take: add has told so
                self.file.close()


@contextmanager
def _output_errors(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OutputError(
            f"{error.filename or folder}: {error.strerror}; what is finished stays"
        ) from error


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Keep other runs out of a study's folder; the system lets go when this process ends, however it does.

    Raises :class:`OutputError` where a run is under way, or the folder or its lock is a link. On a
    file system without locks two runs only do their units twice.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if folder.is_symlink():
        raise OutputError(f"{folder}: is in the way, it is a link to {os.readlink(folder)}")
    try:
        descriptor = locks.open_lock(folder / ".lock")
    except OSError as error:
        raise OutputError(f"{folder / '.lock'}: cannot be opened: {error.strerror}") from error

    try:
        if not _taken(descriptor):
            raise OutputError(
                f"{folder}: another run of this study is under way ({locks.holder(descriptor)}); its table will be here"
            )

        locks.sign(descriptor)
        yield
    finally:
        os.close(descriptor)


def _taken(descriptor: int) -> bool:
    try:
        return locks.take(descriptor)
    except OSError:  # no locks here
        return True
