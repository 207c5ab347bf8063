"""The command as people and scripts use it: what it prints, its exit status, what it leaves behind."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from reports import HEADER, small_report

from fabric_cad.cli import main
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.support import staging
from fabric_cad.support.errors import BuildError, OutputError


def run(*arguments, **options):
    return subprocess.run(
        [sys.executable, "-m", "fabric_cad", *arguments],
        capture_output=True,
        text=True,
        timeout=120,
        **options,
    )


def test_list_shows_every_row_with_its_model(here, capsys):
    assert main(["list"]) == 0
    shown = capsys.readouterr().out.splitlines()
    rows = {line.split()[0]: line for line in shown[1:]}
    for name in (
        "plain",
        "twill21",
        "twill22",
        "twill31",
        "twill32",
        "twill43",
        "satin5",
        "satin8",
    ):
        assert "3 parameters" in rows[name]
    assert "7 parameters" in rows["plain_unbalanced"]
    assert "pattern 4 wefts x 8 warps" in rows["herringbone22"]
    assert "satin 8 step 3" in rows["satin8"] and "twill 3*2" in rows["twill32"]


def test_solve_writes_every_table(here, capsys):
    from fabric_cad.model.solved import read_solved

    assert main(["solve", "--out", "results"]) == 0
    assert "plain_unbalanced: two solutions" in capsys.readouterr().out
    written = sorted(p.name for p in (here / "results" / "families").iterdir())
    assert written == ["pattern.csv", "plain.csv", "satin.csv", "twill.csv"]
    fabric = read_solved("results/families/twill.csv", "twill32")
    assert fabric.weft.amplitude == pytest.approx(0.354794, abs=1e-6)


def test_a_wrong_table_is_not_solved_and_the_others_are(here, capsys):
    main(["solve", "-q"])
    assert capsys.readouterr().out == ""
    before = Path("build/families/twill.csv").read_text()
    Path("families/twill.csv").write_text(f"{HEADER}\nbad,3,2,0.35,2.9,0.004\n")
    Path("build/families/plain.csv").unlink()
    assert main(["solve", "-q"]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert (
        printed.err
        == "families/twill.csv:2: weft_width_mm: 2.9 is not below the weft spacing 2.857 mm (row bad)\n"
    )
    assert Path("build/families/plain.csv").exists()
    assert Path("build/families/twill.csv").read_text() == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["cell", "twill23"], "families: no row is called 'twill23'; did you mean twill"),
        (
            ["cell", "plain", "--families", "nowhere"],
            "nowhere: no such folder of family tables; 'fabric-cad init'",
        ),
        (["cell", "plain", "--through", "3"], "through: 3 is odd"),
        (["cell", "plain", "--gap", "3"], "gap: 3 is odd"),
        (["cell", "plain", "--across", "3"], "across: 3 is below 4"),
        (["cell", "plain", "--size", "-1"], "size: -1 is not above 0"),
        (["list", "--families", "families/plain.csv"], "families/plain.csv: no such folder"),
    ],
)
def test_bad_requests(here, capsys, arguments, words):
    assert main([*arguments, "-q"]) == 2
    printed = capsys.readouterr()
    assert printed.err.startswith(words) and printed.err.count("\n") == 1
    assert not Path("build").exists() or not any(Path("build").iterdir())


@pytest.mark.parametrize(
    "arguments", [[], ["cell"], ["knit"], ["cell", "plain", "--through", "two"]]
)
def test_bad_usage(here, capsys, arguments):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2
    assert "usage: fabric-cad" in capsys.readouterr().err


def test_help_is_the_manual(capsys):
    for arguments in (["--help"], ["cell", "--help"]):
        with pytest.raises(SystemExit) as stopped:
            main(arguments)
        assert stopped.value.code == 0
        shown = capsys.readouterr().out
        assert "--families DIR" in shown and "--out DIR" in shown and "exit status" in shown


def test_a_row_of_a_sound_table_is_made_beside_a_wrong_one(here, capsys, monkeypatch):
    Path("families/twill.csv").write_text(f"{HEADER}\nbad,3,2,0.35,2.9,0.004\n")
    made = []
    monkeypatch.setattr(
        "fabric_cad.cell.pipeline.make_cell",
        lambda row, *rest: made.append(row.names) or small_report(),
    )
    assert main(["cell", "plain"]) == 0
    assert made == [("plain",)]
    assert "note, in a table this row is not of: families/twill.csv:2" in capsys.readouterr().err
    assert main(["cell", "bad"]) == 2


def test_cell_prints_a_table_and_paths_and_is_silent_when_asked(here):
    loud = run("cell", "plain", "--size", "1")
    assert loud.returncode == 0
    assert "  mesh  " in loud.stderr and "identify" in loud.stderr  # progress, a line a stage
    assert loud.stdout.startswith("plain: plain 1*1, 2 wefts x 2 warps")
    for path in loud.stdout.splitlines()[-7:]:
        assert Path(path.strip()).is_file()
    quiet = run("cell", "plain", "--size", "1", "-q")
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")
    report = json.loads(Path("build/plain/report.json").read_text())
    assert {
        "row", "family", "weave", "identified", "measured_vs_model", "consistency", "volumes", "mesh", "seconds",
    } <= set(report)  # fmt: skip
    assert list(report["identified"]["weft"]["control_points"]) == [f"M1{k}" for k in range(1, 7)]
    assert list(report["identified"]["warp"]["control_points"]) == [f"M2{k}" for k in range(1, 7)]


def test_a_reader_that_leaves_a_pipe_is_no_crash(here):
    done = subprocess.run(
        f"'{sys.executable}' -m fabric_cad list | head -n 1",
        shell=True,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stdout.startswith("row")
    assert all(line.startswith("warning: ") for line in done.stderr.splitlines())


def test_ctrl_c_when_all_has_been_said_is_no_traceback(here, monkeypatch, capsys):
    def pressed():
        raise KeyboardInterrupt

    monkeypatch.setattr("fabric_cad.cli.terminal.finish", pressed)
    assert main(["list"]) == 1
    assert capsys.readouterr().err.endswith("\nstopped\n")


def test_a_missing_system_library_is_named(here, monkeypatch, capsys):
    def load(*_):
        raise ImportError("libGL.so.1: cannot open shared object file: No such file or directory")

    monkeypatch.setattr("fabric_cad.cell.pipeline.make_cell", load)
    assert main(["cell", "plain", "-q"]) == 1
    assert capsys.readouterr().err.startswith(
        "the system lacks the library libGL.so.1; the README lists"
    )


def test_init_keeps_what_is_there(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("families").mkdir()
    Path("families/plain.csv").write_text("mine")
    assert main(["init"]) == 0
    assert "families/plain.csv: kept" in capsys.readouterr().out
    assert Path("families/plain.csv").read_text() == "mine"
    assert Path("families/satin.csv").read_text() == (shipped_families() / "satin.csv").read_text()


def test_show_without_a_display_says_so(here, monkeypatch, capsys):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("fabric_cad.meshing.read_mesh", lambda path: None)
    Path("build/plain").mkdir(parents=True)
    Path("build/plain/plain.msh").write_text("")
    assert main(["show", "plain"]) == 1
    assert "no display" in capsys.readouterr().err


@pytest.fixture
def result(tmp_path):
    """A result folder with an earlier result and a file of the user's."""
    target = tmp_path / "build" / "row"
    target.mkdir(parents=True)
    (target / "row.step").write_text("earlier")
    (target / "my notes.txt").write_text("mine")
    return target


def content(folder):
    return {
        str(p.relative_to(folder)): p.read_text() for p in sorted(folder.rglob("*")) if p.is_file()
    }


def test_staged_files_replace_theirs_and_leave_others(result):
    with staging.staged(result) as aside:
        (aside / "row.step").write_text("new")
        (aside / "report.json").write_text("{}")
        assert (result / "row.step").read_text() == "earlier"
    assert content(result.parent) == {
        "row/row.step": "new",
        "row/report.json": "{}",
        "row/my notes.txt": "mine",
    }


@pytest.mark.parametrize("error", [KeyboardInterrupt(), BuildError("no"), ValueError("x")])
def test_a_stop_halfway_leaves_the_earlier_result(result, error):
    before = content(result.parent)
    with pytest.raises(type(error)), staging.staged(result) as aside:
        (aside / "row.step").write_text("new")
        raise error
    assert content(result.parent) == before
    assert [p.name for p in result.parent.iterdir()] == ["row"]


def test_outputs_in_the_way(tmp_path, result):
    (tmp_path / "file").write_text("")
    for target in (tmp_path / "file" / "row", tmp_path / "file"):
        with pytest.raises(OutputError, match="file"), staging.staged(target):
            pass
    (result / "report.json").mkdir()
    before = content(result)
    with pytest.raises(OutputError, match="is in the way"), staging.staged(result) as aside:
        (aside / "row.step").write_text("new")
        (aside / "report.json").write_text("{}")
    assert content(result) == before


def test_a_full_device_is_told_as_such(result, monkeypatch):
    monkeypatch.setattr(
        staging.shutil, "disk_usage", lambda path: shutil._ntuple_diskusage(1, 1, 0)
    )
    for error in (OSError(28, "No space left on device"), BuildError("gmsh: could not write")):
        with (
            pytest.raises(OutputError, match="no space left on the device"),
            staging.staged(result),
        ):
            raise error


@pytest.mark.skipif(os.name != "posix", reason="sends a POSIX signal")
@pytest.mark.parametrize(
    ("stage", "after"),
    [("identify", 0.05), ("identify", 0.5), ("identify", 1.0), ("solids", 0.05), ("mesh", 0.05)],
)
def test_ctrl_c_halfway(here, stage, after):
    """Also while CadQuery is loaded, which follows the identification, and VTK, after the mesh."""
    Path("build/plain").mkdir(parents=True)
    Path("build/plain/plain.step").write_text("earlier")
    process = subprocess.Popen(
        [sys.executable, "-m", "fabric_cad", "cell", "plain"],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    for line in process.stderr:
        if line.split()[0] == stage:
            break
    time.sleep(after)
    process.send_signal(signal.SIGINT)
    rest = process.communicate(timeout=60)
    assert process.returncode == 1 and "stopped; earlier results are as they were" in rest[1]
    assert rest[0] == "" and "Traceback" not in rest[1]
    assert content(here / "build") == {"plain/plain.step": "earlier"}
