"""Ctrl-C, SIGTERM and SIGHUP: told as exceptions, and held back where they would do harm."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")
_SIGNALS = tuple(getattr(signal, name) for name in _NAMES if hasattr(signal, name))


class Stopped(KeyboardInterrupt):
    """SIGTERM or SIGHUP, so that what ends well on Ctrl-C ends well on these."""


@contextmanager
def stoppable() -> Iterator[None]:
    """Turn the first SIGTERM or SIGHUP in the block into :class:`Stopped`.

    Left alone where a signal is ignored (nohup) or has a handler, and off the main thread.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    ours = [number for number in _SIGNALS if signal.getsignal(number) is signal.SIG_DFL]

    def stop(number, frame) -> None:
        for other in ours:
            signal.signal(other, signal.SIG_IGN)  # nothing cuts short what is cleared away now
        raise Stopped

    for number in ours:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Hold these signals back until the block is done: while files move into place, and while libraries load.

    CadQuery and VTK, interrupted halfway through their import, crash, or report a part of
    themselves as missing; and where a module was just making a dataclass, which takes exec, Python
    ends with the signal in place of our exit status. Does nothing off the main thread, which
    signals do not reach.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    sent: list[int] = []
    before = {number: signal.getsignal(number) for number in _SIGNALS}
    held = [number for number, handler in before.items() if handler not in (None, signal.SIG_IGN)]
    for number in held:
        signal.signal(number, lambda number, _frame: sent.append(number))
    try:
        yield
    finally:
        for number in held:
            signal.signal(number, before[number])

    if sent:
        signal.raise_signal(sent[0])
