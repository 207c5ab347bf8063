"""Working folders beside the results: each one's own by a lock, and cleared away by the next run when its run is gone.

OUT/.fabric-cad-<row>/lock     held while a run, or its ccx, is at work on the row
                      new/     what it writes, later the row's folder
                      old/     for a moment, where two folders cannot be exchanged in one step
"""

from __future__ import annotations

import errno
import logging
import os
import secrets
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from . import folders, locks
from .errors import OutputError
from .interrupts import uninterrupted

NEW, OLD = "new", "old"
_PREFIX, _LOCK = ".fabric-cad-", "lock"
_POLL = 0.1  # s between two looks at a lock that another run holds
_PATIENCE = 4  # looks before it is told: a run that clears away holds a lock for a moment only
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP)
_log = logging.getLogger("fabric_cad")
_held: dict[Path, int] = {}
"""The locks of this process: working folder, absolute, to descriptor."""


@contextmanager
def working_folder(parent: Path, name: str) -> Iterator[Path]:
    """The folder to make ``parent/name`` in, empty, which is this run's alone; gone afterwards.

    Waits, and says so, while another run is at work on the same name. On a file system without
    locks every run gets a folder of its own, which nobody clears away after it.
    """
    work = _Work(parent, name)
    try:
        work.enter()
        yield work.folder
    finally:
        with uninterrupted():
            work.leave()


@contextmanager
def scratch_folder(parent: Path) -> Iterator[Path]:
    """A folder for what nobody keeps.

    Gone afterwards, and with the next one where this run is killed.
    """
    clear_leftovers(parent)
    with working_folder(parent, f".{secrets.token_hex(8)}") as folder:
        inside = folder / NEW
        inside.mkdir()
        yield inside


def lock_of(folder: Path) -> int | None:
    """Descriptor of the lock on the working folder that holds ``folder``, for a child to hold along with us."""
    places = (folder.absolute(), folder.resolve())
    return next(
        (_held[place] for path in places for place in (path, *path.parents) if place in _held), None
    )


def clear_leftovers(parent: Path) -> None:
    """Remove the working folders that runs which were killed left in a folder: those whose locks nobody holds.

    One that cannot be judged (no locks on this file system, another user's) stays.
    """
    for folder in parent.glob(f"{_PREFIX}*"):
        if folder.is_symlink() or not _own(folder):
            continue
        work = _Work(parent, folder.name[len(_PREFIX) :])
        with suppress(OSError):
            work.owned = work.try_lock()
        work.leave()


def _own(folder: Path) -> bool:
    """Whether it is a folder of this user's; in a shared temp folder others put theirs."""
    with suppress(OSError):
        return folder.is_dir() and (
            not hasattr(os, "geteuid") or folder.stat().st_uid == os.geteuid()
        )
    return False


class _Work:
    """A working folder: ``descriptor`` its open lock, ``owned`` whether that is held and the folder ours to remove."""

    def __init__(self, parent: Path, name: str) -> None:
        self.folder, self.target = parent / f"{_PREFIX}{name}", parent / name
        self.descriptor: int | None = None
        self.owned = False

    def enter(self) -> None:
        """Make the folder and wait for its lock; without locks, make one of another name."""
        looks = 0
        while not self.owned:
            self.folder.mkdir(exist_ok=True)
            if self.folder.is_symlink():
                raise OutputError(f"{self.folder}: is in the way, it is a link")
            try:
                self.owned = self.try_lock()
            except OSError as error:
                if error.errno not in _NO_LOCKS:
                    raise
                self.leave()
                self.folder = self.folder.with_name(f"{self.folder.name}.{secrets.token_hex(8)}")
                self.folder.mkdir()
                self.owned = True
                return

            if not self.owned:
                looks += 1
                if looks == _PATIENCE and self.descriptor is not None:
                    who = locks.holder(self.descriptor)
                    _log.warning(
                        "%s: another run is at work on it (%s); waiting for its end",
                        self.target,
                        who,
                    )

                self.leave()
                time.sleep(_POLL)

        if self.descriptor is None:
            raise RuntimeError(f"{self.folder}: owned without a lock")
        locks.sign(self.descriptor)
        _held[self.folder.absolute()] = self.descriptor
        _empty(self.folder)

    def try_lock(self) -> bool:
        """Whether the folder's lock is ours now; then what a kill has cut in two is completed."""
        try:
            self.descriptor = locks.open_lock(self.folder / _LOCK)
        except FileNotFoundError:
            return False  # the run before has just removed it
        if not (
            locks.take(self.descriptor) and locks.is_in_place(self.descriptor, self.folder / _LOCK)
        ):
            return False
        if not self.target.name.startswith("."):  # not that of a scratch folder
            folders.complete(self.folder / NEW, self.target, self.folder / OLD)
        return True

    def leave(self) -> None:
        """Remove the folder where it is ours, its lock last: nobody enters before all else is gone. Give the lock back.

        NFS and Windows keep a file that is open: there the folder is empty only after that.
        """
        if self.owned:
            self.owned = False
            _held.pop(self.folder.absolute(), None)
            with suppress(OSError):
                _empty(self.folder)
                (self.folder / _LOCK).unlink(missing_ok=True)

        if self.descriptor is not None:
            os.close(self.descriptor)
            self.descriptor = None

        with suppress(OSError):
            if os.name != "posix":
                (self.folder / _LOCK).unlink()  # fails where another run has it
            self.folder.rmdir()  # fails where it is not empty


def _empty(folder: Path) -> None:
    for inside in folder.iterdir():
        if inside.is_dir() and not inside.is_symlink():
            shutil.rmtree(inside)
        elif inside.name != _LOCK:
            inside.unlink()
