"""Locks on files: the system lets go of one when its last holder ends, however it does.

``flock`` rather than ``lockf``: a child can hold it along with its parent (ccx does), and it is not
lost when the process closes another descriptor of the same file. Linux hands it on to an NFS server
as a lock of the whole file, so that it holds between machines too. Windows has ``msvcrt.locking``.
"""

from __future__ import annotations

import errno
import os
import socket
from pathlib import Path

_FAR = 1 << 30  # Windows locks bytes against reading: one that no holder's name reaches


def open_lock(path: Path) -> int:
    """A descriptor of a lock file, made where there is none.

    Raises OSError, also where ``path`` is a link: no lock is taken elsewhere.
    """
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_CLOEXEC", 0)
    if path.is_symlink():
        raise OSError(errno.ELOOP, "is a link", str(path))
    return os.open(path, flags, 0o666)


def take(descriptor: int) -> bool:
    """Take a lock, without waiting.

    False where another holds it. Raises OSError where there are no locks.
    """
    try:
        import fcntl
    except ImportError:
        return _take_on_windows(descriptor)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _take_on_windows(descriptor: int) -> bool:
    try:
        import msvcrt
    except ImportError as error:
        raise OSError(errno.ENOLCK, "this system has no locks on files") from error
    os.lseek(descriptor, _FAR, os.SEEK_SET)
    try:
        getattr(msvcrt, "locking")(descriptor, getattr(msvcrt, "LK_NBLCK"), 1)  # noqa: B009 (known on Windows alone)
    except OSError as error:
        if error.errno in (errno.EACCES, errno.EDEADLK):
            return False
        raise
    return True


def is_in_place(descriptor: int, path: Path) -> bool:
    """Whether a descriptor still is that of the file at ``path``, which a holder may have removed meanwhile."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(path, follow_symlinks=False))
    except FileNotFoundError:
        return False


def sign(descriptor: int) -> None:
    """Write into a lock that is held by whom."""
    os.ftruncate(descriptor, 0)
    os.lseek(descriptor, 0, os.SEEK_SET)
    os.write(descriptor, f"process {os.getpid()} on {socket.gethostname()}".encode())


def holder(descriptor: int) -> str:
    """Who holds a lock, as :func:`sign` wrote it; for people, nothing is decided by it."""
    os.lseek(descriptor, 0, os.SEEK_SET)
    text = os.read(descriptor, 200).decode("utf-8", "replace").strip()
    return text if text.isprintable() and text else "process unknown"
