"""One command in a folder of its own, and what must hold of it whatever its input.

Exit status 0 or 2; refusals that name a place; no traceback; nothing left behind; an end in time;
no character on the terminal that moves its cursor or changes its colours.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unicodedata
from collections.abc import Callable, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import fabric_cad

TIME_LIMIT = 20.0  # s a command
MOST_PRINTED = 40_000  # characters a refusal may have


@dataclass(frozen=True)
class Trial:
    """A command to run in a folder that holds ``files`` (bytes; None: a folder of that name).

    ``leaves`` matches the paths that a success may leave, ``leaves_refused`` those of a refusal; ``place`` is
    found in every refusal; ``prepare`` does to the child, in its folder, what no file can (a closed output);
    ``fresh``: in a new Python, not in a fork of this one.
    """

    name: str
    arguments: tuple[str, ...]
    files: Mapping[str, bytes | None]
    place: str
    leaves: str = r"(?!)"
    leaves_refused: str = r"(?!)"
    statuses: tuple[int, ...] = (0, 2)
    prepare: Callable[[], None] | None = None
    fresh: bool = False


@dataclass(frozen=True)
class Ended:
    """How a command ended: ``status`` None where it took too long, negative where a signal ended it."""

    status: int | None
    out: str
    err: str
    seconds: float
    left: tuple[str, ...] = field(default=())


class Begun(BaseException):
    """The input was taken and CAD would begin: as far as a trial goes."""


def run_trial(trial: Trial) -> Ended:
    """Run a trial in a new folder and a temp folder of its own, both gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as scratch:
        place, temporary = Path(scratch, "here"), Path(scratch, "temporary")
        place.mkdir()
        temporary.mkdir()
        for name, content in trial.files.items():
            path = place / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.mkdir() if content is None else path.write_bytes(content)
        before = _tree(place)
        start = time.perf_counter()
        with open(Path(scratch, "out"), "w+b") as out, open(Path(scratch, "err"), "w+b") as err:
            run = _new_python if trial.fresh else _forked
            status = run(trial, place, temporary, out.fileno(), err.fileno())
            seconds = time.perf_counter() - start
            texts = []
            for stream in (out, err):
                stream.seek(0)
                texts.append(stream.read().decode("utf-8", errors="replace"))
        left = sorted(_tree(place) - before) + [
            f"(temp folder) {path}" for path in sorted(_tree(temporary))
        ]
        return Ended(status, texts[0], texts[1], seconds, tuple(left))


def _tree(folder: Path) -> set[str]:
    """Every file of a folder, and every folder that holds none, as paths in it."""
    paths = [path for path in folder.rglob("*") if not path.is_dir() or not any(path.iterdir())]
    return {
        os.fsencode(path.relative_to(folder)).decode(errors="backslashreplace") for path in paths
    }


def faults(trial: Trial, ended: Ended) -> list[str]:
    """What is wrong with how a command ended; empty where nothing is."""
    if ended.status is None:
        return [f"takes more than {TIME_LIMIT:g} s"]
    wrong = []
    if ended.status not in trial.statuses:
        wrong.append(f"exit status {ended.status}")
    wrong += tracebacks(ended.err)
    if ended.status != 0 and not re.search(trial.place, ended.err):
        wrong.append("a refusal without its place")
    allowed = trial.leaves_refused if ended.status else trial.leaves
    stray = [path for path in ended.left if not re.fullmatch(allowed, path)]
    if stray := [path for path in stray if path != "build"]:  # an empty folder of results is none
        wrong.append(f"left behind: {', '.join(stray[:5])}")
    if strange := _strange(ended.out + ended.err):
        wrong.append(f"printed {', '.join(strange)}")
    if ended.status and len(ended.err) > MOST_PRINTED:
        wrong.append(f"a refusal of {len(ended.err)} characters")
    return wrong


def tracebacks(text: str) -> list[str]:
    """The last lines of what Python says of an error nobody has caught, also where it goes on; empty without one."""
    if not re.search("Traceback|Error ignored|Exception ignored", text):
        return []
    places = re.findall(r'File "(?:[^"]*/)?([^"/]+)", line (\d+)', text)[-3:]
    last = next(line for line in reversed(text.splitlines()) if line.strip())
    return [f"a traceback ({', '.join(':'.join(place) for place in places)}): {last[:200]}"]


def _strange(text: str) -> list[str]:
    """Characters that a terminal obeys: controls but line breaks and tabs, and marks that turn its direction."""
    strange = {mark for mark in text if unicodedata.category(mark) == "Cc" and mark not in "\n\t"}
    strange |= {
        mark
        for mark in text
        if unicodedata.bidirectional(mark) in ("LRO", "RLO", "LRE", "RLE", "LRI", "RLI")
    }
    return sorted(f"U+{ord(mark):04X}" for mark in strange)


def _forked(trial: Trial, place: Path, temporary: Path, out: int, err: int) -> int | None:
    process = fork_command(
        trial.arguments, place, temporary, out, err, trial.prepare, stop_before_cad
    )
    return wait(process, TIME_LIMIT)


def fork_command(
    arguments: tuple[str, ...],
    place: Path,
    temporary: Path,
    out: int,
    err: int,
    prepare: Callable[[], None] | None = None,
    around: Callable | None = None,
) -> int:
    """Start the command in a fork of this process, with what it has loaded, in a session of its own; its number."""
    sys.stdout.flush()
    sys.stderr.flush()
    process = os.fork()
    if process:
        return process
    status = 70
    try:
        os.setsid()
        os.chdir(place)
        os.environ["TMPDIR"], tempfile.tempdir = str(temporary), None
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(out, 1)
        os.dup2(err, 2)
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)
        sys.stderr = open(
            2, "w", encoding="utf-8", errors="backslashreplace", buffering=1, closefd=False
        )
        if prepare is not None:
            prepare()
        status = _status(arguments, around)
    finally:
        os._exit(status)


def _status(arguments: tuple[str, ...], around: Callable | None) -> int:
    """Exit status of the command as the interpreter would have it, tracebacks printed."""
    import traceback

    from fabric_cad.cli import main

    try:
        with around() if around else _nothing():
            status = main(list(arguments))
        sys.stdout.flush()
    except Begun:
        status = 0
    except SystemExit as stopped:
        status = stopped.code if isinstance(stopped.code, int) else 0 if stopped.code is None else 1
    except BaseException:
        traceback.print_exc()
        status = 1
    return status


@contextmanager
def _nothing():
    yield


@contextmanager
def stop_before_cad():
    """Let a command that would load CadQuery, or run the units of a study, end there with status 0."""
    from fabric_cad import study
    from fabric_cad.cell import pipeline

    stage, run_study = pipeline.Stages.__call__, study.run_study

    @contextmanager
    def stopping_stage(self, name):
        if name == "load CadQuery":
            raise Begun
        with stage(self, name):
            yield

    def stopping_study(defined, *arguments, **options):
        if defined.work.depth != "identify":
            raise Begun
        return run_study(defined, *arguments, **options)

    pipeline.Stages.__call__, study.run_study = stopping_stage, stopping_study
    try:
        yield
    finally:
        pipeline.Stages.__call__, study.run_study = stage, run_study


def wait(process: int, seconds: float) -> int | None:
    """Exit status of a child (negative: the signal that ended it); None where it had to be killed after ``seconds``."""
    end, pause = time.perf_counter() + seconds, 0.001
    while True:
        ended, status = os.waitpid(process, os.WNOHANG)
        if ended:
            return os.waitstatus_to_exitcode(status)
        if time.perf_counter() > end:
            os.killpg(process, signal.SIGKILL)
            os.waitpid(process, 0)
            return None
        time.sleep(pause)
        pause = min(2 * pause, 0.02)


def _new_python(trial: Trial, place: Path, temporary: Path, out: int, err: int) -> int | None:
    package = str(Path(fabric_cad.__file__).parents[1])
    environment = os.environ | {"TMPDIR": str(temporary), "PYTHONPATH": package}
    command = [sys.executable, "-m", "fabric_cad", *trial.arguments]
    options = {
        "cwd": place,
        "env": environment,
        "stdin": subprocess.DEVNULL,
        "stdout": out,
        "stderr": err,
    }
    try:
        return subprocess.run(
            command, timeout=TIME_LIMIT, preexec_fn=trial.prepare, **options
        ).returncode
    except subprocess.TimeoutExpired:
        return None
