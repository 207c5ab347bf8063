"""What went wrong, as an exit status and a sentence."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..support.errors import FabricCadError
from ..support.staging import standing


def told(error: BaseException, done: Sequence[Path] = ()) -> tuple[int, str]:
    """Exit status and sentence for an error; ``done`` are folders that were put in place before.

    Raises the error again where it is a fault of the program.
    """
    if isinstance(error, FabricCadError):
        return error.exit_status, str(error)

    if library := _missing_library(error):
        lack = f"the system lacks the library {library}"
        return 1, f"{lack}; the README lists what a bare container lacks"

    if _is_interrupt(error):
        return 1, f"\nstopped; {standing(done)}"

    if isinstance(error, MemoryError):
        return 1, f"out of memory; {standing(done)}"

    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return 1, f"{place}{error.strerror or error}"

    raise error


def _missing_library(error: BaseException) -> str | None:
    """Name of the shared library that an extension module could not load."""
    text = str(error)
    if isinstance(error, (ImportError, OSError)) and "cannot open shared object file" in text:
        return text.split(":")[0]

    return None


def _is_interrupt(error: BaseException | None) -> bool:
    """True for Ctrl-C, also where an extension module has turned it into an error of its own."""
    while error is not None:
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__cause__ or error.__context__

    return False
