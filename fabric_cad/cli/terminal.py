"""Standard output and error as they may be: closed, full, or unable to print a name."""

from __future__ import annotations

import io
import os
import sys

from ..support.errors import OutputError


def prepare() -> None:
    """Make both streams safe to print to; to be called once, before anything is opened.

    A stream that was closed gets its descriptor back, so that no file opened later takes its
    place: one that refuses what is written to standard output, since that is lost, and one that
    takes all for standard error. Characters a stream cannot encode are escaped.
    """
    if sys.stdin is None:
        _take_descriptor(0, os.O_RDONLY)
    if sys.stdout is None:
        _take_descriptor(1, os.O_RDONLY)
        sys.stdout = io.TextIOWrapper(io.FileIO(1, "w", closefd=False), encoding="utf-8")

    if sys.stderr is None:
        _take_descriptor(2, os.O_WRONLY)
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115 (lives as long as the process)

    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _take_descriptor(number: int, flags: int) -> None:
    opened = os.open(os.devnull, flags)
    if opened != number:
        os.dup2(opened, number)
        os.close(opened)


def say(text: str = "", end: str = "\n") -> None:
    """Print to standard output. Raises :class:`OutputError` where it cannot be written to."""
    try:
        print(text, end=end)
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OutputError(_lost(error)) from error


def _lost(error: OSError) -> str:
    return f"standard output: cannot be written: {error.strerror}"


def complain(text: str, end: str = "\n") -> None:
    """Print to standard error; what it cannot take is lost, never an error of its own."""
    try:
        print(text, end=end, file=sys.stderr, flush=True)
    except OSError:
        _discard(sys.stderr, 2)


def finish() -> str | None:
    """Write out what standard output still holds; why it could not be written, where so."""
    try:
        sys.stdout.flush()
    except OSError as error:
        _discard(sys.stdout, 1)
        return "" if isinstance(error, BrokenPipeError) else _lost(error)
    return None


def _discard(stream: object, number: int) -> None:
    """Send what a stream still holds nowhere: the interpreter writes it out once more at its end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, stream.fileno() if hasattr(stream, "fileno") else number)
    except (OSError, ValueError):  # not a file, as under a test
        pass
    finally:
        os.close(nowhere)
