"""Finished units on disk: lines that are only ever added, so that a run may be killed at any moment.

Every run adds to a file of its own, one line of JSON a unit, and a line that a kill left unfinished is
passed over. A unit is known by a digest of all that its figures depend on, so that a study that was
changed finds those of its units that are still the same.
"""

from __future__ import annotations

import hashlib
import json
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict
from pathlib import Path

from .. import __version__, locks
from ..errors import OutputError
from ..tables import Family
from .units import Outcome, Work


def unit_key(row: Family, work: Work, keep: bool) -> str:
    """Digest of a table of one row and of what is done with it."""
    numbers = {name: float(values[0]).hex() for name, values in row.measured.items()}
    inputs = [__version__, work.depth, sorted(work.mesh.items()), repr(work.settings), keep]
    inputs += [row.family, repr(row.weaves[0]), row.sections[0], row.float_gaps[0], row.thicker[0]]
    inputs.append(sorted(numbers.items()))
    return hashlib.sha256(json.dumps(inputs).encode()).hexdigest()[:32]


class Store:
    """Outcomes by unit key, in a folder ``units`` of the study's own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "units"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.outcomes: dict[str, Outcome] = {}
        for path in sorted(self.folder.glob("*.jsonl")):
            for key, outcome in _lines(path):
                self.outcomes.setdefault(key, outcome)
        self.file = None

    def add(self, key: str, outcome: Outcome) -> None:
        """Record a unit; it is on the disk when this returns."""
        if self.file is None:
            self.file = open(self.folder / f"{os.getpid()}-{secrets.token_hex(4)}.jsonl", "x", encoding="utf-8")
        self.file.write(json.dumps({"key": key, **asdict(outcome)}) + "\n")
        self.file.flush()
        os.fsync(self.file.fileno())
        self.outcomes[key] = outcome

    def close(self) -> None:
        if self.file is not None:
            self.file.close()


def _lines(path: Path) -> Iterator[tuple[str, Outcome]]:
    for line in path.read_bytes().split(b"\n"):
        with suppress(ValueError, KeyError, TypeError):  # a line cut short by a kill
            record = json.loads(line)
            key = record.pop("key")
            yield key, Outcome(**record)


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Keep other runs out of a study's folder; the system lets go when this process ends, however it does.

    Raises :class:`OutputError` where a run is under way, or the folder or its lock is a link. On a file
    system without locks two runs only do their units twice.
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
