"""What test units do in the workers of a cluster."""

import ctypes
import os
import signal
import time
from pathlib import Path

from fabric_cad.study.units import _ended_after


def _attempt(folder: str, name: str) -> None:
    with open(Path(folder) / name, "a") as file:
        file.write("x")


def hold(folder: str, name: str) -> None:
    """Note which process this is, then stay in C code that lets no thread of Python run."""
    Path(folder, name).write_text(str(os.getpid()))
    ctypes.PyDLL(None).sleep(600)


def work(folder: str, name: str) -> str:
    """Do what the name says, after noting the attempt in a file of that name."""
    _attempt(folder, name)
    if name == "dies":
        os.kill(os.getpid(), signal.SIGKILL)
    if name == "hangs":
        with _ended_after(1.0):
            ctypes.PyDLL(None).sleep(600)  # in C, and never lets another thread of Python run
    if name == "raises":
        raise MemoryError("too large")
    if name == "stumbles" and (Path(folder) / name).read_text() == "x":
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.05)
    return f"{name} done"
