"""The solver as a child process: found, followed, stopped, and its verdict told."""

import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from jobs import BLOCK, endless, needs_ccx, pulled, pushed, step

from fabric_cad.simulation.results import read_dat, read_frd
from fabric_cad.simulation.solver import find_solver, process, run_solver, step_periods
from fabric_cad.support.errors import FabricCadError, InputError, SolverError
from fabric_cad.support.staging import staged

ROOT = Path(__file__).parents[2]


def job(folder, text, name="job"):
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.inp").write_text(text)
    return folder / f"{name}.inp"


def script(path, body):
    """An executable shell script that stands for the solver."""
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def alive(pid):
    """Whether a process runs (one that ended and waits for its parent does not)."""
    try:
        os.kill(pid, 0)
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except ProcessLookupError:
        return False
    except FileNotFoundError:
        return not Path("/proc/self/stat").exists()


def gone(pid, within=2.0):
    until = time.monotonic() + within
    while alive(pid) and time.monotonic() < until:
        time.sleep(0.02)
    return not alive(pid)


def working_in(folder):
    """Processes whose current folder is this one."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if os.readlink(entry / "cwd") == str(folder):
                found.append(int(entry.name))
        except OSError:
            pass
    return found


def test_no_solver_says_in_one_line_how_to_get_it(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for option in (None, tmp_path / "ccx"):
        with pytest.raises(SolverError) as caught:
            find_solver(option)
        message = str(caught.value)
        assert (
            "apt-get install calculix-ccx" in message and "--ccx" in message and "\n" not in message
        )
        assert isinstance(caught.value, FabricCadError)
    assert str(tmp_path / "ccx") in message


def test_solvers_are_found_by_any_of_their_names(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    for name in ("ccx_static", "ccx_2.9", "ccx_2.21", "ccx_2.21_notes.txt", "ccx"):
        script(tmp_path / name, "")
        assert find_solver(None).name == (name if "notes" not in name else "ccx_2.21")
    assert find_solver("ccx_2.9") == (tmp_path / "ccx_2.9").resolve()
    assert find_solver(tmp_path / "ccx_static").name == "ccx_static"


def test_what_cannot_be_run_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such deck"):
        run_solver(tmp_path / "job.inp", Path("ccx"))
    deck = job(tmp_path, BLOCK)
    for solver in (tmp_path / "nothing", deck):
        with pytest.raises(SolverError, match="cannot be started"):
            run_solver(deck, solver)


def test_periods_of_steps():
    text = (
        "** *STEP\n*STEP, NLGEOM\n* Static, direct\n0.1, 2.5\n*END STEP\n"
        "*step\n*STATIC\n*CLOAD\n1, 1, 1.\n*END STEP\n"
    )
    assert step_periods(text) == (2.5, 1.0)
    assert step_periods(BLOCK) == ()


@pytest.mark.parametrize("how", ["time limit", "request"])
def test_a_stopped_solver_leaves_no_child(tmp_path, how):
    solver = script(tmp_path / "solver", 'sleep 60 & echo $! > child\necho "started"\nwait')
    deck = job(tmp_path, BLOCK + step(pulled(0.02)))
    stop = threading.Event()
    if how == "request":
        threading.Timer(0.3, stop.set).start()
    run = run_solver(deck, solver, time_limit=0.3 if how == "time limit" else 60, stop=stop)
    assert not run.finished and how in run.reason and "in step 1 at 0 % of its load" in run.reason
    assert run.seconds < 5
    assert gone(int((tmp_path / "child").read_text()))
    assert (tmp_path / "job.log").read_text() == "started\n"


WAITS = "echo $$ > started\nmv started child\nexec sleep 60"


def solving(tmp_path, body, prefix=""):
    """A process that runs a solver of this body in a staged folder, and the solver's number once it is there."""
    solver = script(tmp_path / "solver", body)
    code = f"""
import os, sys; from pathlib import Path
from fabric_cad.simulation.solver import run_solver
from fabric_cad.support.staging import staged
with staged(Path({str(tmp_path / "build" / "row")!r})) as folder:
    (folder / "job.inp").write_text("*STEP")
    {prefix}run_solver(folder / "job.inp", Path({str(solver)!r}))
"""
    python = subprocess.Popen(
        [sys.executable, "-c", code], cwd=ROOT, stderr=subprocess.PIPE, text=True
    )
    until = time.monotonic() + 20
    while (
        not (there := list(tmp_path.glob("build/.fabric-cad-*/new/child")))
        and time.monotonic() < until
    ):
        time.sleep(0.02)
    return python, int(there[0].read_text())


def test_an_interrupt_leaves_no_child(tmp_path):
    python, child = solving(tmp_path, "sleep 60 & echo $! > started\nmv started child\nwait")
    python.send_signal(signal.SIGINT)
    _, errors = python.communicate(timeout=10)
    assert "KeyboardInterrupt" in errors
    assert gone(child) and list((tmp_path / "build").iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_polite_end_of_the_command_leaves_no_child_and_no_folder(tmp_path, number):
    """The command turns these signals into exceptions."""
    stoppable = "import fabric_cad.support.interrupts as i; s = i.stoppable(); s.__enter__(); "
    python, child = solving(
        tmp_path, "sleep 60 & echo $! > started\nmv started child\nwait", stoppable
    )
    python.send_signal(number)
    _, errors = python.communicate(timeout=10)
    assert "Stopped" in errors
    assert gone(child) and list((tmp_path / "build").iterdir()) == []


@pytest.mark.skipif(
    sys.platform != "linux", reason="the system ends no children with their parents"
)
def test_a_killed_command_leaves_no_child(tmp_path):
    python, child = solving(tmp_path, WAITS)
    python.kill()
    python.communicate()
    assert gone(child)
    with staged(tmp_path / "build" / "other"):
        pass
    assert [path.name for path in (tmp_path / "build").iterdir()] == ["other"]


def test_a_solver_that_outlives_its_command_keeps_its_folder(tmp_path):
    """As where the system ends no children with their parents: the child holds the lock along."""
    survive = "sys.platform = 'other'; "
    python, child = solving(tmp_path, WAITS, survive)
    try:
        python.kill()
        python.communicate()
        with staged(tmp_path / "build" / "other"):
            pass
        assert alive(child) and list((tmp_path / "build").glob(".fabric-cad-row/new/child"))
    finally:
        os.kill(child, signal.SIGKILL)
    assert gone(child)
    with staged(tmp_path / "build" / "other"):
        pass
    assert [path.name for path in (tmp_path / "build").iterdir()] == ["other"]


@pytest.mark.parametrize("how", ["ends", "is stopped"])
def test_no_call_is_needed_that_windows_lacks(tmp_path, monkeypatch, how):
    for name in ("wait4", "killpg", "WNOHANG"):
        monkeypatch.delattr(os, name)
    monkeypatch.setitem(sys.modules, "fcntl", None)
    monkeypatch.setattr(process, "_ties", lambda folder: {})
    body = "exec sleep 60" if how == "is stopped" else "exit 3"
    reason = (
        "stopped at the time limit of 0.3 s" if how == "is stopped" else "ccx ended with status 3"
    )
    run = run_solver(job(tmp_path, BLOCK), script(tmp_path / "solver", body), time_limit=0.3)
    assert run.reason.startswith(reason)


def test_a_solver_that_dies_is_told_from_one_that_finishes(tmp_path):
    deck = job(tmp_path, BLOCK)
    dies = run_solver(deck, script(tmp_path / "dies", "kill -SEGV $$"))
    assert not dies.finished and "SIGSEGV" in dies.reason
    fails = run_solver(deck, script(tmp_path / "fails", "exit 3"))
    assert not fails.finished and "status 3" in fails.reason
    silent = run_solver(deck, script(tmp_path / "silent", "exit 0"))
    assert not silent.finished and "status 0" in silent.reason


def test_the_solver_gets_its_deck_its_folder_and_its_threads(tmp_path):
    body = 'echo "$@" $OMP_NUM_THREADS $CCX_NPROC_STIFFNESS $CCX_NPROC_RESULTS $CCX_NPROC_EQUATION_SOLVER; pwd'
    deck = job(tmp_path / "a folder", BLOCK, "a.job")
    run_solver(deck, script(tmp_path / "solver", body), threads=3)
    assert deck.with_suffix(".log").read_text() == f"-i a.job 3 3 3 3\n{deck.parent}\n"


@needs_ccx
def test_a_job_that_finishes(tmp_path):
    steps = ((0.02, "0.5, 1."), (0.04, "1., 4."))
    deck = job(
        tmp_path, BLOCK + "".join(step(pulled(u), static, direct=True) for u, static in steps)
    )
    for suffix in ("frd", "sta"):
        (tmp_path / f"job.{suffix}").write_text("of an earlier run")
    heard = []
    run = run_solver(deck, find_solver(None), threads=2, time_limit=60, listen=heard.append)
    assert run.finished and run.reason == "finished" and run.warnings == () and run.cutbacks == 0
    assert run.version.startswith("2.")
    assert 1e6 < run.peak_memory < 200e6
    assert [(at.step, at.increment) for at in run.increments] == [
        (at.step, at.increment) for at in heard
    ]
    assert [at.load for at in heard] == pytest.approx([0.5, 1, 0.25, 0.5, 0.75, 1])
    assert [at.total_time for at in heard] == pytest.approx([0.5, 1, 2, 3, 4, 5])
    assert {at.steps for at in heard} == {2}
    assert "Job finished" in (tmp_path / "job.log").read_text()


@needs_ccx
@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("left, 1, 1\n", "nowhere, 1, 1\n", "node set NOWHERE has not yet been defined"),
        (f"*ELASTIC\n{1000.0}, 0.3", "*ELASTIC\n1000.", "not enough constants"),
        (
            "1, 1, 2, 3, 4, 5, 6, 7, 8",
            "1, 5, 6, 7, 8, 1, 2, 3, 4",
            "nonpositive jacobian determinant in element 1",
        ),
    ],
)
def test_a_broken_deck_gives_the_words_of_ccx(tmp_path, old, new, said):
    assert old in BLOCK
    run = run_solver(job(tmp_path, BLOCK.replace(old, new) + step(pulled(0.02))), find_solver(None))
    assert not run.finished and run.increments == ()
    assert run.reason.startswith("*ERROR") and said in run.reason and "\n" not in run.reason


@needs_ccx
def test_a_deck_without_a_step_computes_nothing(tmp_path):
    run = run_solver(job(tmp_path, BLOCK), find_solver(None))
    assert not run.finished and "no step" in run.reason


@needs_ccx
def test_warnings_are_collected_once(tmp_path):
    steps = "".join(step(pulled(u), "1., 1.") for u in (0.01, 0.02))
    run = run_solver(job(tmp_path, BLOCK + steps), find_solver(None))
    assert run.finished
    assert len(run.warnings) == 1 and "the minimum increment" in run.warnings[0]


@needs_ccx
def test_a_job_that_cannot_converge_names_the_step_and_the_load(tmp_path):
    """ccx's elastic law bears at most E A / (3 sqrt 3) of compression: at a stretch of 1 / sqrt 3 it gives way."""
    bearing = 1000 / (3 * 3**0.5)
    last = 40 + (bearing - 40) / 0.4  # passed at 40 % of the third step
    loads = ((20, "0.5, 1."), (40, "0.5, 1."), (last, "0.1, 1., 1e-3"))
    deck = job(tmp_path, BLOCK + "".join(step(pushed(load), static) for load, static in loads))
    run = run_solver(deck, find_solver(None), time_limit=60)
    assert not run.finished
    told = re.fullmatch(r"did not converge in step 3 at ([\d.]+) % of its load", run.reason)
    assert 37 < float(told[1]) < 40.01
    assert run.cutbacks >= 1
    states, printed = read_frd(tmp_path / "job.frd"), read_dat(tmp_path / "job.dat")
    reached = [(at.step, at.increment) for at in run.increments]
    assert [
        (state.step, state.increment) for state in states
    ] == reached  # without the last, diverged iterate
    forces = [p.values[0] for p in printed if p.quantity == "RF"]
    assert len(forces) == len(reached)
    load = float(told[1]) / 100
    assert forces[-1] == pytest.approx(-40 - load * (last - 40), rel=2e-3)


@needs_ccx
def test_too_few_increments_are_told_with_the_place(tmp_path):
    text = BLOCK + step(pulled(0.02), "0.25, 1.", direct=True).replace("INC=1000000", "INC=2")
    run = run_solver(job(tmp_path, text), find_solver(None))
    assert (
        not run.finished
        and "max. # of increments reached, in step 1 at 50 % of its load" in run.reason
    )


@needs_ccx
@pytest.mark.skipif(not Path("/proc/self/cwd").exists(), reason="no /proc to look for processes in")
def test_past_its_time_ccx_is_gone_and_what_it_computed_is_kept(tmp_path):
    deck = job(tmp_path, endless())
    seen = []

    def listen(progress):
        seen.extend(working_in(tmp_path) if not seen else ())

    run = run_solver(deck, find_solver(None), time_limit=1.0, listen=listen)
    assert seen, "never seen running"
    assert working_in(tmp_path) == [] and all(gone(pid) for pid in seen)
    assert not run.finished and "time limit of 1 s in step 1" in run.reason
    assert 1.0 <= run.seconds < 3.0
    states = read_frd(tmp_path / "job.frd")
    assert 0 <= len(run.increments) - len(states) <= 1 and len(states) > 3
    assert states[-1].fields["DISP"][1, 0] == pytest.approx(0.02 * states[-1].time, rel=1e-4)


@needs_ccx
def test_jobs_run_side_by_side(tmp_path):
    strains = (0.001, 0.002, 0.003, 0.004)
    decks = [job(tmp_path / f"at_{e}", BLOCK + step(pulled(2 * e))) for e in strains]
    with ThreadPoolExecutor(4) as pool:
        runs = list(
            pool.map(lambda deck: run_solver(deck, find_solver(None), time_limit=60), decks)
        )
    assert all(run.finished for run in runs)
    for strain, deck in zip(strains, decks):
        force = read_dat(deck.with_suffix(".dat"))[0].values[0]
        assert force == pytest.approx(1000 * (strain + strain**2 / 2) * (1 + strain), rel=1e-5)


@needs_ccx
def test_a_listener_that_raises_ends_the_job(tmp_path):
    def listen(progress):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        run_solver(job(tmp_path, endless()), find_solver(None), listen=listen)
    if Path("/proc").exists():
        assert working_in(tmp_path) == []


@needs_ccx
def test_the_solver_is_the_one_named():
    assert find_solver(shutil.which("ccx")) == find_solver(None)
