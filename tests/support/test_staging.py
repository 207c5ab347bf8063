"""A folder of results is replaced as a whole, by one run at a time, whatever happens to the run."""

import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
import types
from pathlib import Path

import pytest

from fabric_cad.support import folders, locks, staging, working
from fabric_cad.support.errors import OutputError
from fabric_cad.support.interrupts import Stopped, stoppable, uninterrupted

ROOT = Path(__file__).parents[2]
posix = pytest.mark.skipif(os.name != "posix", reason="POSIX signals and links")


def content(folder):
    return {
        str(p.relative_to(folder)): p.read_text() for p in sorted(folder.rglob("*")) if p.is_file()
    }


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def row(tmp_path):
    """A row's folder with a complete result and something of its owner's."""
    target = tmp_path / "build" / "row"
    write_result(target, "first")
    (target / "my notes.txt").write_text("mine")
    (target / "tension").mkdir()
    (target / "tension" / "tension.csv").write_text("k")
    return target


def write_result(target, word, files=4):
    """A result of several files, told complete by the digests in its report, as ``cell`` writes one."""
    with staging.staged(target) as aside:
        for number in range(files):
            (aside / f"{number}.txt").write_text(f"{word} {number}" * 1000)
        digests = {
            path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in aside.iterdir()
        }
        (aside / "report.json").write_text(json.dumps({"files": digests}))


def is_complete(folder):
    files = json.loads((folder / "report.json").read_text())["files"]
    return all(
        hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest
        for name, digest in files.items()
    )


def run(code, **options):
    """A process that has this module at hand and runs some code."""
    start = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); from test_staging import *\n"
    return subprocess.Popen([sys.executable, "-c", start + code], cwd=ROOT, text=True, **options)


def wait_for(condition, seconds=30.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.005)


def test_everything_else_in_the_folder_stays(row):
    inode = (row / "my notes.txt").stat().st_ino
    write_result(row, "second")
    assert is_complete(row) and (row / "0.txt").read_text().startswith("second")
    assert (row / "my notes.txt").stat().st_ino == inode and (
        row / "tension" / "tension.csv"
    ).read_text() == "k"
    assert names(row.parent) == ["row"]


def test_what_is_put_into_the_folder_meanwhile_is_kept(row, monkeypatch):
    exchange = folders.put_in_place

    def at_the_last_moment(new, target, spare):
        (target / "saved by its owner.txt").write_text("saved")
        (target / "my notes.txt").unlink()
        (target / "my notes.txt").write_text("mine, changed")
        return exchange(new, target, spare)

    monkeypatch.setattr(folders, "put_in_place", at_the_last_moment)
    write_result(row, "second")
    assert (row / "saved by its owner.txt").read_text() == "saved"
    assert (row / "my notes.txt").read_text() == "mine, changed" and is_complete(row)


def test_a_folder_replaces_its_like_as_a_whole(row):
    with staging.staged(row) as aside:
        (aside / "tension").mkdir()
        (aside / "tension" / "new.csv").write_text("")
    assert names(row / "tension") == ["new.csv"]


def test_a_seal_sees_the_whole_folder_and_may_remove(row):
    def seal(folder):
        assert names(folder) == [
            "0.txt",
            "1.txt",
            "2.txt",
            "3.txt",
            "my notes.txt",
            "new",
            "report.json",
            "tension",
        ]
        (folder / "3.txt").unlink()

    with staging.staged(row, seal) as aside:
        (aside / "new").write_text("")
    assert "3.txt" not in names(row) and "new" in names(row)


@posix
def test_a_reader_sees_one_complete_result_at_any_moment(row):
    """Files opened in one folder are of one result, while forty others are put in place."""
    done, seen, files = threading.Event(), [], [f"{number}.txt" for number in range(4)]

    def read():
        while not done.is_set():
            folder = os.open(row, os.O_RDONLY)
            try:
                report = os.open("report.json", os.O_RDONLY, dir_fd=folder)
                opened = {name: os.open(name, os.O_RDONLY, dir_fd=folder) for name in files}
            except FileNotFoundError:
                seen.append(
                    os.fstat(folder).st_ino != row.stat().st_ino
                )  # it has just been replaced
                continue
            finally:
                os.close(folder)
            digests = {}
            for name, descriptor in opened.items():
                with open(descriptor, "rb") as file:
                    digests[name] = hashlib.sha256(file.read()).hexdigest()
            with open(report) as file:
                seen.append(json.load(file)["files"] == digests)

    readers = [threading.Thread(target=read) for _ in range(2)]
    for reader in readers:
        reader.start()
    for number in range(40):
        write_result(row, str(number))
    done.set()
    for reader in readers:
        reader.join()
    assert len(seen) > 10 and all(seen)


@posix
@pytest.mark.parametrize("exchange", [True, False], ids=["in one step", "in two"])
def test_kills_at_any_moment_leave_one_complete_result(row, exchange):
    chance = random.Random(3)
    code = "" if exchange else "folders._exchange = lambda *_: False\n"
    code += f"for k in range(10**9): print(k, flush=True); write_result(Path({str(row)!r}), str(k))"
    for _ in range(12):
        process = run(code, stdout=subprocess.PIPE)
        process.stdout.readline()
        time.sleep(chance.uniform(0.0, 0.05))
        process.kill()
        process.communicate()
        if exchange:
            assert is_complete(row)
        write_result(row.with_name("other"), "any")  # the next run, of another row, clears up
        assert is_complete(row) and (row / "my notes.txt").read_text() == "mine"
        assert names(row.parent) == ["other", "row"]


def test_a_kill_between_the_two_steps_is_completed_by_the_next_run(row, monkeypatch):
    """Where two folders cannot be exchanged in one step."""
    code = f"""
folders._exchange = lambda *_: False
rename = os.rename
def stop_before_the_second(source, place):
    if Path(place) == Path({str(row)!r}):
        os._exit(9)
    rename(source, place)
os.rename = stop_before_the_second
write_result(Path({str(row)!r}), "second")
"""
    assert run(code).wait() == 9
    assert not row.exists()
    write_result(row.with_name("other"), "any")
    assert is_complete(row) and (row / "0.txt").read_text().startswith("second")
    assert (row / "my notes.txt").read_text() == "mine" and names(row.parent) == ["other", "row"]


def test_a_folder_that_cannot_be_put_in_place_leaves_the_former_one(row, monkeypatch):
    before, rename = content(row), os.rename

    def refuse(source, place):
        if Path(source).name == working.NEW:
            raise PermissionError(13, "in use")
        rename(source, place)

    monkeypatch.setattr(folders, "_exchange", lambda *_: False)
    monkeypatch.setattr(os, "rename", refuse)
    with pytest.raises(OutputError, match="cannot be written: in use"):
        write_result(row, "second")
    assert content(row) == before and names(row.parent) == ["row"]


def test_hard_links_are_not_needed(row, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", refuse)
    write_result(row, "second")
    assert is_complete(row) and (row / "my notes.txt").read_text() == "mine"


HOLD = """
os.getpid = lambda: 2**22 + 1  # as in a container: no such process here
with staging.staged(Path({target!r})) as aside:
    (aside / "half.txt").write_text("half")
    print("there", flush=True)
    time.sleep(60)
"""


def test_a_working_folder_is_judged_by_its_lock_and_not_by_a_number(row):
    other = row.with_name("other")
    process = run(HOLD.format(target=str(other)), stdout=subprocess.PIPE)
    try:
        process.stdout.readline()
        write_result(row, "second")
        assert [path.name for path in row.parent.rglob("half.txt")] == ["half.txt"]
    finally:
        process.kill()
        process.communicate()
    write_result(row, "third")
    assert names(row.parent) == ["row"]


def test_a_working_folder_that_cannot_be_judged_stays(row, monkeypatch):
    left = row.parent / ".fabric-cad-other"
    left.mkdir()
    (left / "half.txt").write_text("half")

    def no_locks(descriptor):
        raise OSError(37, "No locks available")

    monkeypatch.setattr(locks, "take", no_locks)
    write_result(row, "second")  # and one's own work goes on
    assert is_complete(row) and (left / "half.txt").exists()


def test_locks_of_windows(row, monkeypatch):
    """By its module's calls, since there is no Windows here: one holder at a time, others are told from no locks."""
    held = []

    def locking(descriptor, mode, count):
        place = os.fstat(descriptor).st_ino, os.lseek(descriptor, 0, os.SEEK_CUR)
        if place in held:
            raise PermissionError(13, "Permission denied")
        held.append(place)

    monkeypatch.setitem(sys.modules, "fcntl", None)
    monkeypatch.setitem(sys.modules, "msvcrt", types.SimpleNamespace(locking=locking, LK_NBLCK=2))
    with working.working_folder(row.parent, "row") as folder:
        other = locks.open_lock(folder / "lock")
        assert (
            held
            and not locks.take(other)
            and locks.holder(other).startswith(f"process {os.getpid()} on ")
        )
        os.close(other)
    held.clear()
    write_result(row, "second")
    assert is_complete(row) and names(row.parent) == ["row"]


def test_a_second_run_of_a_row_waits_and_says_so(row):
    process = run(HOLD.format(target=str(row)), stdout=subprocess.PIPE)
    process.stdout.readline()
    code = f"write_result(Path({str(row)!r}), 'second')"
    second = run(code, stderr=subprocess.PIPE)
    try:
        said = second.stderr.readline()
        assert (
            said.startswith(f"{row}: another run is at work on it (process ") and "waiting" in said
        )
        assert (row / "0.txt").read_text().startswith("first")
    finally:
        process.kill()
        process.communicate()
    assert second.wait(timeout=30) == 0
    second.communicate()
    assert (row / "0.txt").read_text().startswith("second") and is_complete(row)


def test_runs_at_once_leave_the_result_of_one(row):
    code = f"for k in range(15): write_result(Path({str(row)!r}), f'{{os.getpid()}} {{k}}')"
    processes = [run(code, stderr=subprocess.PIPE) for _ in range(3)]
    while any(process.poll() is None for process in processes):
        time.sleep(0.01)
    assert [process.communicate()[1].count("Traceback") for process in processes] == [0, 0, 0]
    assert is_complete(row) and names(row.parent) == ["row"]


@posix
def test_nothing_is_written_through_links_out_of_the_folder(tmp_path, row):
    outside = tmp_path / "outside"
    outside.mkdir()
    linked = row.with_name("linked")
    linked.symlink_to(outside)
    with pytest.raises(OutputError, match="it is a link to"):
        write_result(linked, "any")
    (row.parent / ".fabric-cad-other").symlink_to(outside)
    with pytest.raises(OutputError, match="it is a link"):
        write_result(row.with_name("other"), "any")
    (row.parent / ".fabric-cad-third").mkdir()
    (row.parent / ".fabric-cad-third" / "lock").symlink_to(outside / "lock")
    with pytest.raises(OutputError, match="cannot be written"):
        write_result(row.with_name("third"), "any")
    (row / "0.txt").unlink()
    (row / "0.txt").symlink_to(outside / "file")
    write_result(row, "second")
    assert names(outside) == [] and not (row / "0.txt").is_symlink()


def test_files_one_by_one_end_with_the_one_that_says_they_are_complete(row, monkeypatch):
    inode, moved, replace = row.stat().st_ino, [], os.replace
    monkeypatch.setattr(
        os,
        "replace",
        lambda source, place: (moved.append(Path(place).name), replace(source, place)),
    )
    with staging.staged(row, last="1.txt") as aside:
        for number in range(3):
            (aside / f"{number}.txt").write_text("new")
    assert moved == ["0.txt", "2.txt", "1.txt"] and row.stat().st_ino == inode
    assert (row / "1.txt").read_text() == "new" and names(row.parent) == ["row"]


def test_what_is_said_to_who_stops_a_run_is_true(row, monkeypatch):
    with staging.commits() as done:
        with pytest.raises(KeyboardInterrupt), staging.staged(row):
            raise KeyboardInterrupt
        assert staging.standing(done) == "earlier results are as they were"
        exchange = folders.put_in_place

        def interrupted(*paths):
            former = exchange(*paths)
            signal.raise_signal(signal.SIGINT)
            return former

        monkeypatch.setattr(folders, "put_in_place", interrupted)
        with pytest.raises(KeyboardInterrupt):
            write_result(row, "second")
        assert staging.standing(done).startswith(f"the new results in {row} are complete")
    assert (
        is_complete(row)
        and (row / "0.txt").read_text().startswith("second")
        and names(row.parent) == ["row"]
    )


@posix
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_polite_end_is_an_exception_that_waits_where_it_must(number):
    steps = []
    with pytest.raises(Stopped), stoppable():
        with uninterrupted():
            signal.raise_signal(number)
            steps.append("held back")
        steps.append("never")
    assert steps == ["held back"] and signal.getsignal(number) is signal.SIG_DFL


@posix
def test_nohup_is_respected():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stoppable(), uninterrupted():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_scratch_folders_of_killed_runs_go_with_the_next(tmp_path):
    code = f"""
with working.scratch_folder(Path({str(tmp_path)!r})) as folder:
    (folder / "half").write_text("")
    os.kill(os.getpid(), 9)
"""
    run(code).wait()
    assert len(names(tmp_path)) == 1
    with working.scratch_folder(tmp_path) as folder:
        assert len(names(tmp_path)) == 1 and names(folder) == []
    assert names(tmp_path) == []
