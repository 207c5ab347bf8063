"""A folder replaced by another in one step, with what else it holds."""

from __future__ import annotations

import ctypes
import errno
import os
import shutil
from collections.abc import Collection, Iterator
from contextlib import suppress
from pathlib import Path

_HERE, _EXCHANGE = -100, 2  # AT_FDCWD, RENAME_EXCHANGE of Linux
_UNSUPPORTED = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EOPNOTSUPP)

Seen = dict[str, tuple[int, int, int]]
"""Files by their place in a folder: inode, time of change (ns), bytes."""


def carry_over(old: Path, new: Path, seen: Seen, inside: str = "") -> None:
    """Give ``new`` all that ``old`` holds and ``new`` does not, in hard links: the same files, at no cost.

    Copies where the file system has no hard links; folders are made anew. ``seen`` takes the files.
    """
    for entry in sorted(os.scandir(old), key=lambda entry: entry.name):
        place, name = new / entry.name, f"{inside}{entry.name}"
        with suppress(FileNotFoundError):  # removed by its owner meanwhile
            if entry.is_dir(follow_symlinks=False):
                if not inside and os.path.lexists(place):
                    continue  # written anew, as a whole
                place.mkdir()
                carry_over(old / entry.name, place, seen, f"{name}/")
                shutil.copystat(entry.path, place)
                continue

            seen[name] = _state(entry.path)
            if not os.path.lexists(place):
                _link(entry.path, place)


def _state(path: str | Path) -> tuple[int, int, int]:
    state = os.lstat(path)
    return state.st_ino, state.st_mtime_ns, state.st_size


def _link(source: str, place: Path) -> None:
    if os.path.islink(source):
        os.symlink(os.readlink(source), place)
        return
    try:
        os.link(source, place)
    except FileNotFoundError:
        raise
    except OSError:
        shutil.copy2(source, place)


def rescue(old: Path, new: Path, seen: Seen, written: set[str]) -> None:
    """Bring over what others put into ``old`` after it was carried over.

    What this run wrote wins.
    """
    for path in _files(old):
        name = path.relative_to(old).as_posix()
        with suppress(OSError):
            if name.split("/")[0] not in written and seen.get(name) != _state(path):
                (new / name).parent.mkdir(parents=True, exist_ok=True)
                os.replace(path, new / name)


def _files(folder: Path) -> Iterator[Path]:
    for root, _, names in os.walk(folder):
        yield from (Path(root, name) for name in names)


def to_disk(path: Path, there: Collection[int] = ()) -> None:
    """Return when a file, or a folder with all in it, is on the disk.

    Files with inodes in ``there`` are already.
    """
    if path.is_symlink():
        return
    if path.is_dir():
        for inside in path.iterdir():
            to_disk(inside, there)
        names_to_disk(path)
    elif path.stat().st_ino not in there:
        _flush(path, os.O_RDONLY if os.name == "posix" else os.O_RDWR)


def names_to_disk(folder: Path) -> None:
    """Return when the names of a folder's files are on the disk, where the system knows of such a thing."""
    if os.name != "posix":
        return
    try:
        _flush(folder, os.O_RDONLY)
    except OSError as error:
        if error.errno not in _UNSUPPORTED:
            raise


def _flush(path: Path, flags: int) -> None:
    descriptor = os.open(path, flags)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def put_in_place(new: Path, target: Path, spare: Path) -> Path | None:
    """Make the folder ``new`` the one at ``target``; where the former one is now, None where there was none.

    One step on Linux, where the file system can exchange two folders (ext4, XFS, Btrfs, tmpfs can;
    NFS cannot). Elsewhere two: the former one goes to ``spare``, and a run killed between the two
    is completed by :func:`complete`. Raises OSError; the former one then is at ``target``.
    """
    if not os.path.lexists(target):
        os.rename(new, target)
        return None

    if _exchange(new, target):
        return new
    os.rename(target, spare)
    try:
        os.rename(new, target)
    except OSError:
        os.rename(spare, target)
        raise

    return spare


def complete(new: Path, target: Path, spare: Path) -> None:
    """Take the second of the two steps that :func:`put_in_place` makes where it cannot make one."""
    if spare.is_dir() and not os.path.lexists(target):
        os.rename(new if new.is_dir() else spare, target)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two folders; False where the system or the file system cannot. Raises OSError."""
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError, TypeError):  # another C library, another system
        return False
    if renameat2(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    if number in _UNSUPPORTED:
        return False
    raise OSError(number, os.strerror(number), str(other))
