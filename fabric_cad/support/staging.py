"""Results are written aside and put in place in one step, when all of them are there.

A reader who opens a row's folder at any moment finds one complete result; so does who looks after a
kill.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from . import folders
from .errors import BuildError, FabricCadError, OutputError
from .interrupts import uninterrupted
from .working import NEW, OLD, clear_leftovers, working_folder

_commits: list[Path] | None = None


@contextmanager
def staged(
    target: Path, seal: Callable[[Path], None] | None = None, last: str | None = None
) -> Iterator[Path]:
    """A folder to write in, which on success becomes ``target``, with the other files that are there.

    A folder in it replaces its like as a whole. ``seal`` is called with the complete folder, files
    that stay included, before it is put in place; it may write and remove, but not change files
    that stay. On any error, Ctrl-C included, ``target`` is untouched and the folder is gone.
    Another run with the same target is waited for.

    With ``last``, the name of a file, ``target`` stays the folder it is and takes the files one by
    one, that one at the end: it says that the others are complete (a study's folder, at work in
    other files meanwhile).

    Raises :class:`OutputError` where ``target`` cannot be written, or is a link: a row's files are
    not written out of the output folder.
    """
    with output_errors(target):
        _check(target)
        target.parent.mkdir(parents=True, exist_ok=True)
        clear_leftovers(target.parent)
        with working_folder(target.parent, target.name) as work:
            aside = work / NEW
            aside.mkdir()
            yield aside
            _check(target)
            if last is None:
                _replace(aside, target, work / OLD, seal)
            else:
                _move(aside, target, last)


@contextmanager
def commits() -> Iterator[list[Path]]:
    """The folders whose results this process has put in place, from here on."""
    global _commits
    before, _commits = _commits, []
    try:
        yield _commits
    finally:
        _commits = before


def standing(done: Sequence[Path]) -> str:
    """How the results stand where a run ended early that had put ``done`` in place."""
    if not done:
        return "earlier results are as they were"
    names = ", ".join(str(path) for path in dict.fromkeys(done))
    return f"the new results in {names} are complete, all others are as they were"


def _check(target: Path) -> None:
    """Raise :class:`OutputError` where something else is at a folder's place."""
    for folder in (target, *target.parents):
        if folder.exists() and not folder.is_dir():
            raise OutputError(f"{folder}: is in the way, it is not a folder")
    if target.is_symlink():
        raise OutputError(f"{target}: is in the way, it is a link to {os.readlink(target)}")


def _replace(aside: Path, target: Path, spare: Path, seal: Callable[[Path], None] | None) -> None:
    """Make ``aside`` the new ``target``, with all that is there beside its like."""
    written = _check_names(aside, target)
    seen: folders.Seen = {}
    if target.exists():
        folders.carry_over(target, aside, seen)
        shutil.copystat(target, aside)

    if seal is not None:
        seal(aside)
    folders.to_disk(aside, {inode for inode, *_ in seen.values()})
    with uninterrupted():
        former = folders.put_in_place(aside, target, spare)
        if _commits is not None:
            _commits.append(target)
        if former is not None:
            folders.rescue(former, target, seen, written)
        folders.names_to_disk(target.parent)


def _check_names(aside: Path, target: Path) -> set[str]:
    """Names of what was written. Raises :class:`OutputError` where one is a file here and a folder there."""
    names = set()
    for path in aside.iterdir():
        names.add(path.name)
        if (target / path.name).is_dir() and not path.is_dir():
            raise OutputError(f"{target / path.name}: is in the way, it is a folder")
        if path.is_dir() and (target / path.name).exists() and not (target / path.name).is_dir():
            raise OutputError(f"{target / path.name}: is in the way, it is not a folder")
    return names


def _move(aside: Path, target: Path, last: str) -> None:
    """Move files into ``target`` one by one, ``last`` at the end."""
    names = sorted(_check_names(aside, target), key=lambda name: (name == last, name))
    folders.to_disk(aside)
    target.mkdir(exist_ok=True)
    with uninterrupted():
        for name in names:
            if name == last:
                folders.names_to_disk(target)
            os.replace(aside / name, target / name)
        folders.names_to_disk(target)
        if _commits is not None:
            _commits.append(target)


@contextmanager
def output_errors(target: Path) -> Iterator[None]:
    """Turn what the operating system refuses into a message about a folder that is written to."""
    try:
        yield
    except (FabricCadError, OSError) as error:
        if _is_full(target, error):
            raise OutputError(f"{target}: no space left on the device") from error
        if isinstance(error, BuildError) and (free := _free(target)) < _LITTLE:
            # a library that fails to write may take away what it wrote, and leaves room again
            raise OutputError(
                f"{error}; the device of {target} has only {free / 1e6:.2g} MB left"
            ) from error
        if isinstance(error, FabricCadError):
            raise
        raise OutputError(f"{target}: cannot be written: {error.strerror or error}") from error


def _is_full(target: Path, error: Exception) -> bool:
    """True where an error is one of a full device; libraries do not say so themselves."""
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return True
    return _free(target) < 1 << 16


def _free(target: Path) -> int:
    """Bytes free on the device of a folder, which need not be there yet."""
    existing = next(folder for folder in (target, *target.absolute().parents) if folder.is_dir())
    return shutil.disk_usage(existing).free


_LITTLE = 1 << 25
"""Bytes free below which a stage that fails is told with what is left: files of a cell take that much."""
