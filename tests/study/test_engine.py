"""Work in worker processes: one that dies or hangs costs its own unit, and nobody else may reach or outlive them."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
import workloads

from fabric_cad.study.engine import run_tasks
from fabric_cad.support.errors import FabricCadError, InputError


def test_a_dead_or_hanging_worker_costs_its_own_unit(tmp_path):
    names = ["a", "dies", "b", "hangs", "c", "raises", "stumbles", "d", "e"]
    tasks = [(name, (str(tmp_path), name)) for name in names]
    found = dict(each for each in run_tasks(tasks, workloads.work, workers=2) if each is not None)
    assert set(found) == set(names)
    for name in ("a", "b", "c", "d", "e", "stumbles"):
        assert found[name] == f"{name} done"
    assert type(found["dies"]) is type(found["hangs"]) is ChildProcessError
    assert type(found["raises"]) is MemoryError and str(found["raises"]) == "too large"
    attempts = {name: len((tmp_path / name).read_text()) for name in names}
    assert attempts == dict.fromkeys(names, 1) | dict.fromkeys(
        ("dies", "hangs", "raises", "stumbles"), 2
    )


def test_no_scheduler_is_one_line():
    with pytest.raises(
        InputError, match="^--scheduler tcp://127.0.0.1:9: no scheduler answers there$"
    ):
        list(run_tasks([("a", ())], print, scheduler="tcp://127.0.0.1:9"))


def test_without_dask_a_study_runs_here_and_a_cluster_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    ended = list(run_tasks([("a", (-3,))], abs, workers=1))
    assert ended[-1] == ("a", 3)
    with pytest.raises(FabricCadError, match=r"pip install 'fabric-cad\[study\]'"):
        list(run_tasks([("a", ())], print, scheduler="tcp://127.0.0.1:9"))


def processes_of(study):
    return [study, *study.children(recursive=True)]


HOLD = """
import sys
import workloads
from fabric_cad.study.engine import run_tasks
if __name__ == "__main__":
    names = [f"unit_{number}" for number in range(2)]
    list(run_tasks([(name, (sys.argv[1], name)) for name in names], workloads.hold, workers=2))
"""


@pytest.fixture
def holding(tmp_path):
    """A study whose two workers are held up in C code, and the process numbers of those."""
    script = tmp_path / "hold.py"
    script.write_text(HOLD)
    places = {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])}
    study = subprocess.Popen(
        [sys.executable, script, tmp_path], env=os.environ | places, start_new_session=True
    )
    noted = [tmp_path / f"unit_{number}" for number in range(2)]
    end = time.monotonic() + 60
    while not all(note.exists() and note.read_text() for note in noted):
        assert study.poll() is None and time.monotonic() < end
        time.sleep(0.05)
    yield study, [int(note.read_text()) for note in noted]
    for process in processes_of(psutil.Process(study.pid)) if study.poll() is None else []:
        process.kill()
    study.wait()


def test_nobody_can_connect_to_a_running_study(holding):
    study, workers = holding
    running = processes_of(psutil.Process(study.pid))
    assert set(workers) <= {process.pid for process in running}
    for process in running:
        assert process.net_connections(kind="inet") == []
        assert [socket for socket in process.net_connections(kind="unix") if socket.laddr] == []


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a worker first leaves its C code")
def test_a_killed_study_leaves_no_worker_behind(holding):
    study, workers = holding
    left = [
        process for process in processes_of(psutil.Process(study.pid)) if process.pid != study.pid
    ]
    os.kill(study.pid, signal.SIGKILL)
    study.wait()
    _, alive = psutil.wait_procs(left, timeout=10)
    assert alive == [] and not any(map(psutil.pid_exists, workers))


def test_tls_without_certificates_is_one_line():
    told = (
        "^--scheduler tls://127.0.0.1:9: no certificates for TLS; Dask's configuration names them "
    )
    with pytest.raises(InputError, match=told):
        list(run_tasks([("a", ())], print, scheduler="tls://127.0.0.1:9"))
