"""Tasks to workers, results as they come; the door to dask.distributed.

Workers are processes of this machine (:mod:`fabric_cad.study.processes`, without Dask) or those of
a Dask cluster that someone else has started.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import Any, Protocol

from ..support.cores import cores
from ..support.errors import FabricCadError, InputError
from .processes import LocalWorkers

_MISSING = "a study on a Dask cluster needs dask.distributed: pip install 'fabric-cad[study]'"
_TICK = 0.5  # s between two looks at the workers
_GATHER = 60.0  # s within which a finished result must arrive


class Workers(AbstractContextManager, Protocol):
    """Workers, each with a name, of which each takes one task at a time."""

    def free(self) -> Iterable[Any]:
        """Workers that have no task."""

    def start(self, worker: Any, work: Callable, arguments: tuple) -> None:
        """Send a task to a free worker."""

    def ended(self, seconds: float) -> Sequence[tuple[Any, object]]:
        """(worker, result) of tasks that ended, waited for at most so long; errors as results."""


def run_tasks(
    tasks: Iterable[tuple[str, tuple]],
    work: Callable,
    scheduler: str | None = None,
    workers: int | None = None,
) -> Iterator[tuple[str, object] | None]:
    """(name, result) of ``work(*arguments)`` for every task (name, arguments), in the order in which they end.

    A result is an exception where the task ended so twice; ChildProcessError says that its workers
    died. None is yielded every now and then while nothing ends. Runs on the cluster at
    ``scheduler``, or on ``workers`` (default: one a core) processes of this machine. A worker is
    sent one task at a time, so that one that dies takes no other task with it, whatever the cluster
    does about its failures. Raises :class:`FabricCadError` where the scheduler cannot be reached or
    is lost.
    """
    waiting = iter(tasks)
    again: list[tuple[str, tuple]] = []
    tries: dict[str, int] = {}
    crew: Workers = (
        LocalWorkers(workers or cores()) if scheduler is None else ClusterWorkers(scheduler)
    )

    with crew:
        running: dict[Hashable, tuple[str, tuple]] = {}
        more = True
        while True:
            for worker in crew.free():
                task = again.pop() if again else next(waiting, None)
                more = task is not None
                if task is None:
                    break
                running[worker] = task
                name, arguments = task
                tries[name] = tries.get(name, 0) + 1
                crew.start(worker, work, arguments)

            if not (running or again or more):
                return

            ended = crew.ended(_TICK)
            if not ended:
                yield None
            for worker, result in ended:
                name, arguments = running.pop(worker)
                if isinstance(result, Exception) and tries[name] < 2:
                    again.append((name, arguments))
                else:
                    yield name, result


class ClusterWorkers:
    """The workers of the Dask cluster at an address, as many as there are at any moment.

    Who controls the scheduler, or can reach one without TLS, runs code in this process and in the
    workers: results and tasks are pickles. ``tls://`` addresses take the certificates of Dask's own
    configuration (``distributed.comm.tls``). Raises :class:`InputError` where no scheduler answers.
    """

    def __init__(self, scheduler: str) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            raise FabricCadError(_MISSING) from error
        try:
            self.client = Client(scheduler, timeout="5s")
        except TypeError as error:
            raise InputError(
                f"--scheduler {scheduler}: no certificates for TLS; Dask's configuration names them "
                "(distributed.comm.tls: ca-file, client.cert, client.key)"
            ) from error
        except (OSError, ValueError) as error:
            raise InputError(f"--scheduler {scheduler}: no scheduler answers there") from error
        self.futures: dict[str, Any] = {}

    def __enter__(self) -> ClusterWorkers:
        return self

    def __exit__(self, *problem: object) -> None:
        self.client.__exit__(*problem)

    def free(self) -> list[str]:
        """Workers that have no task."""
        return [worker for worker in self.client.nthreads() if worker not in self.futures]

    def start(self, worker: str, work: Callable, arguments: tuple) -> None:
        """Send a task to a free worker."""
        key = f"fabric-cad-{os.urandom(8).hex()}"
        self.futures[worker] = self.client.submit(
            work, *arguments, key=key, pure=False, workers=[worker]
        )

    def ended(self, seconds: float) -> list[tuple[str, object]]:
        """(worker, result) of tasks that ended or whose worker went, waited for at most so long.

        Raises :class:`FabricCadError` where the scheduler is gone.
        """
        self._wait(seconds)
        there = self.client.nthreads()
        over = [
            worker
            for worker, future in self.futures.items()
            if future.done() or worker not in there
        ]
        return [(worker, _result(self.futures.pop(worker))) for worker in over]

    def _wait(self, seconds: float) -> None:
        from distributed import wait

        if self.client.status != "running":
            raise FabricCadError("the scheduler is lost; the same command goes on once it is back")
        if not self.futures:
            time.sleep(seconds)
            return
        try:
            wait(list(self.futures.values()), timeout=seconds, return_when="FIRST_COMPLETED")
        except TimeoutError:
            pass


def _result(future) -> object:
    """What a task gave, or the exception it ended in."""
    from distributed import KilledWorker

    if future.status == "error":
        error = future.exception()
        return ChildProcessError("its worker died") if isinstance(error, KilledWorker) else error
    try:
        if future.status == "finished":
            return future.result(timeout=_GATHER)
    except (TimeoutError, RuntimeError):
        pass  # the worker died with the result
    future.cancel()
    return ChildProcessError("its worker died")
