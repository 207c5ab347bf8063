"""The door to dask.distributed: tasks to the workers of a cluster, results as they come."""

from __future__ import annotations

import logging
import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from multiprocessing import resource_tracker

from ..cores import cores
from ..errors import FabricCadError, InputError

_MISSING = "a study of cells needs dask.distributed: pip install 'fabric-cad[study]'"
_TICK = 0.5  # s between two looks at the workers
_GATHER = 60.0  # s within which a finished result must arrive


def run_tasks(
    tasks: Iterable[tuple[str, tuple]],
    work: Callable,
    scheduler: str | None = None,
    workers: int | None = None,
) -> Iterator[tuple[str, object] | None]:
    """(name, result) of ``work(*arguments)`` for every task (name, arguments), in the order in which they end.

    A result is an exception where the task ended so twice; ChildProcessError says that its workers
    died. None is yielded every now and then while nothing ends. Runs on the cluster at ``scheduler``,
    or on ``workers`` (default: one a core) processes of this machine. A worker is sent one task at a
    time, so that one that dies takes no other task with it, whatever the cluster does about its
    failures. Raises :class:`FabricCadError` where the scheduler cannot be reached or is lost.
    """
    try:
        import distributed  # noqa: F401
    except ImportError as error:
        raise FabricCadError(_MISSING) from error
    waiting, again, tries = iter(tasks), [], {}
    with _client(scheduler, workers) as client:
        running: dict[str, tuple] = {}  # worker: (future, name, arguments)
        more = True
        while True:
            there = client.nthreads()
            for worker in there:
                if worker in running:
                    continue
                task = again.pop() if again else next(waiting, None)
                more = task is not None
                if not more:
                    break
                name, arguments = task
                tries[name] = tries.get(name, 0) + 1
                key = f"fabric-cad-{os.urandom(8).hex()}"
                running[worker] = client.submit(work, *arguments, key=key, pure=False, workers=[worker]), *task
            if not (running or again or more):
                return
            if not _wait([future for future, *_ in running.values()], client):
                yield None
            for worker, (future, name, arguments) in list(running.items()):
                if future.done() or worker not in there:
                    del running[worker]
                    result = _result(future)
                    if isinstance(result, Exception) and tries[name] < 2:
                        again.append((name, arguments))
                    else:
                        yield name, result


def _wait(futures: list, client) -> bool:
    """Wait for one of the futures, or for a moment. Raises :class:`FabricCadError` where the scheduler is gone."""
    from distributed import wait

    if client.status != "running":
        raise FabricCadError("the scheduler is lost; the same command goes on once it is back")
    if not futures:
        time.sleep(_TICK)
        return False
    try:
        wait(futures, timeout=_TICK, return_when="FIRST_COMPLETED")
    except TimeoutError:
        return False
    return True


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


@contextmanager
def _client(scheduler: str | None, workers: int | None) -> Iterator:
    import dask
    from distributed import Client, LocalCluster

    with ExitStack() as stack:
        if scheduler is not None:
            try:
                client = Client(scheduler, timeout="5s")
            except (OSError, ValueError) as error:
                raise InputError(f"--scheduler {scheduler}: no scheduler answers there") from error
        else:
            stack.enter_context(
                dask.config.set({"distributed.scheduler.allowed-failures": 0, "logging.distributed": "critical"})
            )
            cluster = LocalCluster(
                n_workers=0,
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",  # any port that is free
                silence_logs=logging.CRITICAL,
            )
            stack.enter_context(cluster)
            cluster.sync(_leave_interrupts_alone)
            cluster.scale(workers or cores())
            client = Client(cluster)
        yield stack.enter_context(client)


async def _leave_interrupts_alone() -> None:
    """Keep Ctrl-C from this thread and all that it starts, the workers: it is the study that stops, and ends them."""
    if hasattr(signal, "pthread_sigmask"):
        resource_tracker.ensure_running()  # would lift the mask when it is started with the first worker
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
