"""Workers on this machine: child processes at the ends of pipes.

Nothing listens anywhere, so that no other user can reach a worker, and none outlives the study,
however that ends.
"""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing import connection, resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of Linux's prctl
_FIRST_TO_GO = "500"  # of 1000; a machine that runs out of memory ends a worker, not the study


class LocalWorkers:
    """So many child processes, each of which takes one task at a time; they end with the ``with`` block.

    A process is started when its first task comes, and anew after it has died.
    """

    def __init__(self, count: int) -> None:
        self.count = count
        self.processes: dict[int, tuple[BaseProcess, Connection]] = {}
        self.busy: set[int] = set()

    def __enter__(self) -> LocalWorkers:
        return self

    def __exit__(self, *_: object) -> None:
        for process, _pipe in self.processes.values():
            process.kill()
        for worker in list(self.processes):
            self._bury(worker)

    def free(self) -> list[int]:
        """Workers that have no task."""
        return [worker for worker in range(self.count) if worker not in self.busy]

    def start(self, worker: int, work: Callable, arguments: tuple) -> None:
        """Send a task to a free worker."""
        self.busy.add(worker)
        if worker not in self.processes:
            self.processes[worker] = _new_process()

        with contextlib.suppress(
            BrokenPipeError, ConnectionResetError
        ):  # it died while free: told as ended
            self.processes[worker][1].send((work, arguments))

    def ended(self, seconds: float) -> list[tuple[int, object]]:
        """(worker, result) of the tasks that ended, waited for at most so long.

        The result is an exception where the task raised one, ChildProcessError where its worker
        died.
        """
        pipes = {self.processes[worker][1]: worker for worker in self.busy}
        results: list[tuple[int, object]] = []

        ready = set(connection.wait(list(pipes), seconds))
        for pipe, worker in pipes.items():
            if pipe not in ready:
                continue
            self.busy.discard(worker)
            try:
                results.append((worker, pipe.recv()))
            except (EOFError, OSError):
                self._bury(worker)
                results.append((worker, ChildProcessError("its worker died")))

        return results

    def _bury(self, worker: int) -> None:
        process, pipe = self.processes.pop(worker)
        pipe.close()
        process.kill()
        process.join()
        process.close()


def _new_process() -> tuple[BaseProcess, Connection]:
    spawning = multiprocessing.get_context("spawn")
    ours, theirs = spawning.Pipe()
    process = spawning.Process(target=_serve, args=(theirs, os.getpid()), daemon=True)

    with _interrupts_left_to_the_study():
        process.start()
    theirs.close()  # so that the pipe ends with the process
    return process, ours


@contextmanager
def _interrupts_left_to_the_study() -> Iterator[None]:
    """Keep Ctrl-C from processes started meanwhile: it is the study that stops, and ends them."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # would lift the mask when it is started with the first worker
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(pipe: Connection, parent: int) -> None:
    """What a worker does: tasks from the pipe, their results into it, until the study is gone."""
    _end_with(parent)
    with contextlib.suppress(OSError):
        with open("/proc/self/oom_score_adj", "w", encoding="ascii") as score:
            score.write(_FIRST_TO_GO)

    while True:
        try:
            work, arguments = pipe.recv()
            result = work(*arguments)
        except EOFError:
            return
        except Exception as error:
            result = error

        try:
            pipe.send(result)
        except BrokenPipeError:
            return
        except Exception as error:  # a result that cannot be sent
            pipe.send(RuntimeError(f"{type(error).__name__}: {error}"))


def _end_with(parent: int) -> None:
    """End this process as soon as its parent is gone, whatever it is doing then.

    On Linux the system sees to that, elsewhere a thread, which has to wait for code that holds
    Python's lock.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_DEATH_SIGNAL, signal.SIGKILL)
        if os.getppid() != parent:  # gone before
            os._exit(1)
        return

    watched = multiprocessing.parent_process()

    def wait() -> None:
        connection.wait([watched.sentinel])
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
