"""The door to dask.distributed: tasks to the workers of a cluster, results as they come."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager

from ..errors import FabricCadError, InputError

_MISSING = "a study of cells needs dask.distributed: pip install 'fabric-cad[study]'"
_TICK = 0.5  # s between two looks at the clock


def run_tasks(
    tasks: Iterable[tuple[str, tuple]],
    work: Callable,
    scheduler: str | None = None,
    workers: int | None = None,
) -> Iterator[tuple[str, object] | None]:
    """(name, result) of ``work(*arguments)`` for every task (name, arguments), in the order in which they end.

    A result is an exception where the task ended so, or its worker, twice. None is yielded every
    now and then while nothing ends. Runs on the cluster at ``scheduler``, or on ``workers`` (default:
    one a core) processes of this machine. No more tasks are sent than there are threads to run them,
    so that a worker that dies takes no other task with it. Raises :class:`FabricCadError` where the
    scheduler cannot be reached or is lost.
    """
    try:
        from distributed import wait
    except ImportError as error:
        raise FabricCadError(_MISSING) from error
    waiting, tries = iter(tasks), {}
    with _client(scheduler, workers) as client:
        running: dict = {}

        def send(name: str, arguments: tuple) -> None:
            tries[name] = tries.get(name, 0) + 1
            key = f"fabric-cad-{os.urandom(8).hex()}"
            running[client.submit(work, *arguments, key=key, pure=False)] = name, arguments

        more = True
        while more or running:
            while more and len(running) < max(1, sum(client.nthreads().values())):
                task = next(waiting, None)
                if more := task is not None:
                    send(*task)
            if not running:
                break
            try:
                wait(list(running), timeout=_TICK, return_when="FIRST_COMPLETED")
            except TimeoutError:
                if client.status != "running":
                    raise FabricCadError(f"the scheduler at {scheduler} is lost") from None
                yield None
            for future in [each for each in running if each.done()]:
                name, arguments = running.pop(future)
                if future.status == "finished":
                    yield name, future.result()
                elif _died(future) or tries[name] > 1:
                    yield name, _error(future)
                else:
                    send(name, arguments)


def _died(future) -> bool:
    """True where the scheduler gave a task up: its workers died, as often as the cluster allows."""
    from distributed import KilledWorker

    return future.status == "error" and isinstance(future.exception(), KilledWorker)


def _error(future) -> BaseException:
    from distributed import KilledWorker

    if future.status != "error":
        return RuntimeError(f"the cluster has {future.status} the unit")
    error = future.exception()
    return ChildProcessError("its worker died") if isinstance(error, KilledWorker) else error


@contextmanager
def _client(scheduler: str | None, workers: int | None) -> Iterator:
    import dask
    from distributed import Client, LocalCluster

    with ExitStack() as stack:
        if scheduler is not None:
            try:
                client = Client(scheduler, timeout="10s")
            except (OSError, ValueError) as error:
                raise InputError(f"--scheduler {scheduler}: no scheduler answers there") from error
        else:
            stack.enter_context(
                dask.config.set({"distributed.scheduler.allowed-failures": 1, "logging.distributed": "critical"})
            )
            cluster = LocalCluster(
                n_workers=workers or _cores(),
                threads_per_worker=1,
                host="127.0.0.1",
                dashboard_address=None,
                silence_logs=logging.CRITICAL,
            )
            stack.enter_context(cluster)
            client = Client(cluster)
        yield stack.enter_context(client)


def _cores() -> int:
    """Cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
