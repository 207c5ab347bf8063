"""The command where its output is closed or full, its folder gone, or a name cannot be printed; quiet; many rows."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from reports import HEADER, small_report

from fabric_cad.cli import main
from fabric_cad.support import staging
from fabric_cad.support.errors import BuildError, InputError, OutputError

FABRIC_CAD = f"'{sys.executable}' -m fabric_cad"
posix = pytest.mark.skipif(os.name != "posix", reason="a POSIX shell's redirections")


def shell(line, **environment):
    return subprocess.run(
        line,
        shell=True,
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | environment,
        executable="/bin/bash",
    )


@pytest.fixture
def made(monkeypatch):
    """Rows that were made, in order; ``twill22`` cannot be."""
    names = []

    def make_cell(row, *rest):
        (name,) = row.names
        if name == "twill22":
            raise BuildError("twill22: its yarns penetrate")
        names.append(name)
        return small_report() | {"row": name}

    monkeypatch.setattr("fabric_cad.cell.pipeline.make_cell", make_cell)
    return names


def test_a_row_that_fails_does_not_stop_the_others(here, capsys, made):
    assert main(["cell", "plain", "twill22", "twill99", "twill32", "plain"]) == 2
    printed = capsys.readouterr()
    assert made == ["plain", "twill32"]
    assert printed.out.splitlines()[-1] == "4 rows: 2 done; not: twill22, twill99"
    assert (
        "twill22: its yarns penetrate" in printed.err
        and "no row is called 'twill99'" in printed.err
    )
    assert main(["cell", "plain", "twill22", "-q"]) == 1  # the highest of the rows'
    assert capsys.readouterr() == ("", "twill22: its yarns penetrate\n")


def test_an_error_that_does_not_name_its_row_gets_it(here, capsys):
    assert main(["cell", "plain", "twill32", "--gap", "3", "-q"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(": 3 is odd")[0] for line in lines] == ["plain: gap", "twill32: gap"]


def test_all_rows_of_all_tables(here, capsys, made):
    Path("families/pattern.csv").write_text("no table")
    assert main(["cell", "--all"]) == 2
    printed = capsys.readouterr()
    assert {"plain", "satin8", "twill43"} <= set(made) and "twill22" not in made
    assert (
        f"{len(made) + 1} rows: {len(made)} done; not: twill22; 1 tables have errors" in printed.out
    )
    assert printed.err.count("families/pattern.csv:1: ") == printed.err.count(
        "families/pattern.csv"
    )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["cell"], "give the names of rows or --all"),
        (["tension", "--all", "plain"], "give the names of rows or --all, not both"),
        (["shw", "plain"], "did you mean show?"),
        (
            ["cell", "plain", "--acros", "4", "--throuhg", "3"],
            "unrecognized arguments: --throuhg 3; did you mean --through?",
        ),
    ],
)
def test_wrong_usage_is_told_with_what_may_be_meant(here, capsys, arguments, words):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2
    assert words in capsys.readouterr().err


def test_quiet_is_no_progress_and_never_no_result(here, capsys):
    Path("draft.wif").write_text(
        "[WIF]\nVersion=1.1\n[WARP]\nThreads=2\n[WEFT]\nThreads=2\n[THREADING]\n1=1\n2=2\n[LIFTPLAN]\n1=1\n2=2\n"
    )
    for command in (["list"], ["validate"], ["wif", "draft.wif", "--name", "mine"]):
        assert main(command) == 0
        loud = capsys.readouterr()
        assert main([*command, "-q"]) == 0
        assert capsys.readouterr() == loud and loud.out  # warnings too: they are no progress


@posix
@pytest.mark.parametrize("command", ["list", "cell --help", "--version"])
@pytest.mark.parametrize("stream", [">&-", ">/dev/full"])
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_output_that_is_lost_is_an_error_and_no_traceback(here, command, stream, unbuffered):
    done = shell(f"{FABRIC_CAD} {command} {stream}", PYTHONUNBUFFERED=unbuffered)
    *warnings, last = done.stderr.splitlines()
    assert done.returncode == 1 and last.startswith("standard output: cannot be written: ")
    assert all(line.startswith("warning: ") for line in warnings)


@posix
@pytest.mark.parametrize("stream", ["2>&-", "2>/dev/full"])
def test_complaints_that_are_lost_change_nothing(here, stream):
    done = shell(f"{FABRIC_CAD} cell none {stream}")
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "")
    done = shell(f"{FABRIC_CAD} solve {stream}")
    assert (
        done.returncode == 0
        and "twill.csv" in done.stdout
        and Path("build/families/twill.csv").exists()
    )


@posix
def test_a_file_never_takes_the_place_of_a_closed_stream(here):
    assert shell(f"{FABRIC_CAD} solve -q >&- 2>&- <&-").returncode == 0
    with_streams = {file.name: file.read_bytes() for file in Path("build/families").iterdir()}
    assert shell(f"{FABRIC_CAD} solve -q").returncode == 0
    assert {
        file.name: file.read_bytes() for file in Path("build/families").iterdir()
    } == with_streams


@posix
def test_a_deleted_current_folder_is_told(here):
    done = shell(
        f"mkdir gone; cd gone; rmdir ../gone; {FABRIC_CAD} list",
        PYTHONPATH=str(Path(staging.__file__).parents[1]),
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert (
        done.stderr
        == "the current folder is gone (deleted, or moved away); change to one that is there\n"
    )


@posix
def test_a_name_that_cannot_be_printed_is_escaped(here):
    Path("families").rename("fämilies")
    Path("fämilies/twill.csv").write_text(f"{HEADER}\nbad,3,2,0.35,2.9,0.004\n")
    done = shell(f"{FABRIC_CAD} solve --families fämilies --out bäu", PYTHONIOENCODING="ascii")
    assert done.returncode == 2 and "b\\xe4u/families/plain.csv" in done.stdout
    assert done.stderr.startswith("f\\xe4milies/twill.csv:2: weft_width_mm")


@pytest.mark.parametrize(
    "place", ["fabric_cad.measured.tables.read_families", "pathlib.Path.mkdir"]
)
def test_a_folder_of_another_user_is_told(here, monkeypatch, capsys, place):
    def denied(path, *rest, **more):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(place, denied)
    assert main(["solve", "--out", "results"]) == 1
    told = capsys.readouterr().err
    assert (
        "Permission denied" in told
        and ("families" in told or "results" in told)
        and told.count("\n") == 1
    )


def test_a_stage_that_fails_on_a_nearly_full_device_says_what_is_left(tmp_path, monkeypatch):
    free = 100_000
    monkeypatch.setattr(
        staging.shutil, "disk_usage", lambda path: shutil._ntuple_diskusage(1, 1, free)
    )
    with pytest.raises(
        OutputError, match=r"OCCT wrote no STEP file; the device of .* has only 0.1 MB left"
    ):
        with staging.output_errors(tmp_path):
            raise BuildError("OCCT wrote no STEP file")
    for error in (InputError("a row"), BuildError("x")):
        free = 10**9 if isinstance(error, BuildError) else free
        with pytest.raises(type(error), match="^(a row|x)$"), staging.output_errors(tmp_path):
            raise error


def test_memory_that_runs_out_is_told_as_such(here, monkeypatch, capsys):
    def make_cell(*_):
        raise MemoryError

    monkeypatch.setattr("fabric_cad.cell.pipeline.make_cell", make_cell)
    assert main(["cell", "plain", "-q"]) == 1
    assert capsys.readouterr().err == "out of memory; earlier results are as they were\n"
