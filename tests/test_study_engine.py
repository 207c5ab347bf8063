"""Work on a real cluster: a worker that dies or hangs costs its own unit, which is tried twice."""

import importlib.util

import pytest
import workloads

from fabric_cad.errors import FabricCadError, InputError
from fabric_cad.study.engine import run_tasks


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
    assert attempts == dict.fromkeys(names, 1) | dict.fromkeys(("dies", "hangs", "raises", "stumbles"), 2)


def test_no_scheduler_is_one_line():
    with pytest.raises(InputError, match="^--scheduler tcp://127.0.0.1:9: no scheduler answers there$"):
        list(run_tasks([("a", ())], print, scheduler="tcp://127.0.0.1:9"))


def test_without_dask_the_command_says_how_to_get_it(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(FabricCadError, match=r"pip install 'fabric-cad\[study\]'"):
        list(run_tasks([("a", ())], print))
    assert importlib.util.find_spec("dask") is not None
