"""How much memory there is for this process."""

from __future__ import annotations

import os
from pathlib import Path

from .errors import InputError, Problem

_CGROUPS = (
    (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory.current")),
    (
        Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
        Path("/sys/fs/cgroup/memory/memory.usage_in_bytes"),
    ),
)
"""Files of a container's limit and use, of both versions of control groups."""


def available_memory() -> int | None:
    """Bytes this process may still take, None where the system does not say.

    The least of what the system can give without swapping, what the container's limit leaves
    and what the process's own limit of address space leaves.
    """
    known = [_system(), _container(), _own_limit()]
    return min((each for each in known if each is not None), default=None)


def refuse_beyond_memory(hexahedra: int, needed: int) -> None:
    """Raise :class:`InputError` where ``needed`` bytes for so many hexahedra are more than there are."""
    available = available_memory()
    if available is not None and needed > available:
        sizes = f"need some {needed / 1e9:.1f} GB, {available / 1e9:.1f} GB are there"
        raise InputError(Problem(f"{hexahedra} hexahedra {sizes}", column="across"))


def _system() -> int | None:
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return 1024 * int(line.split()[1])
    except (OSError, ValueError, IndexError):
        pass
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):  # not on Windows
        return None


def _container() -> int | None:
    for limit, used in _CGROUPS:
        try:
            return max(0, int(limit.read_text()) - int(used.read_text()))
        except (OSError, ValueError):  # no such group, or no limit ("max")
            continue
    return None


def _own_limit() -> int | None:
    try:
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit == resource.RLIM_INFINITY:
            return None
        return max(
            0, limit - resource.getpagesize() * int(Path("/proc/self/statm").read_text().split()[0])
        )
    except (ImportError, OSError, ValueError):  # not on Windows; no /proc
        return None
