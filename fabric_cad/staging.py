"""Results are written aside and moved into place only when all of them are there."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import FabricCadError, OutputError
from .interrupts import uninterrupted

_LEFTOVER = ".fabric-cad-"


@contextmanager
def staged(target: Path) -> Iterator[Path]:
    """A folder to write in; on success every file of it moves into ``target``, replacing its like.

    Other files in ``target`` stay. On any error, Ctrl-C included, ``target`` is untouched
    and the folder is gone. Raises :class:`OutputError` where ``target`` cannot be written.
    """
    with _output_errors(target):
        for folder in (target, *target.parents):
            if folder.exists() and not folder.is_dir():
                raise OutputError(f"{folder}: is in the way, it is not a folder")
        target.parent.mkdir(parents=True, exist_ok=True)
        _clear_leftovers(target.parent)
        aside = Path(tempfile.mkdtemp(prefix=f"{_LEFTOVER}{os.getpid()}-", dir=target.parent))
    try:
        with _output_errors(target):
            yield aside
            with uninterrupted():
                _move(aside, target)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _move(aside: Path, target: Path) -> None:
    files = sorted(aside.iterdir())
    for file in files:
        if (target / file.name).is_dir():
            raise OutputError(f"{target / file.name}: is in the way, it is a folder")
    target.mkdir(exist_ok=True)
    os.chmod(aside, 0o755)
    for file in files:
        os.replace(file, target / file.name)


@contextmanager
def _output_errors(target: Path) -> Iterator[None]:
    """Turn what the operating system refuses into a message about the output folder."""
    try:
        yield
    except (FabricCadError, OSError) as error:
        if _is_full(target, error):
            raise OutputError(f"{target}: no space left on the device") from error
        if isinstance(error, FabricCadError):
            raise
        raise OutputError(f"{target}: cannot be written: {error.strerror or error}") from error


def _is_full(target: Path, error: Exception) -> bool:
    """True where an error is one of a full device; libraries do not say so themselves."""
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return True
    existing = next(folder for folder in (target, *target.absolute().parents) if folder.is_dir())
    return shutil.disk_usage(existing).free < 1 << 16


def _clear_leftovers(folder: Path) -> None:
    """Remove what runs that were killed outright have left aside."""
    for aside in folder.glob(f"{_LEFTOVER}*-*"):
        owner = aside.name[len(_LEFTOVER) :].split("-")[0]
        if owner.isdigit() and not _alive(int(owner)):
            shutil.rmtree(aside, ignore_errors=True)


def _alive(process: int) -> bool:
    if os.name != "posix":
        return True  # no harmless way to ask
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
