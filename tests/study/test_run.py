"""Whole studies: tables, what is never run again, and what a kill leaves behind."""

import csv
import json
import os
import random
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from jobs import needs_ccx

from fabric_cad.cell.pipeline import find_row, make_cell
from fabric_cad.cli import main
from fabric_cad.model.identification import identify_rows
from fabric_cad.study import read_study, run_study
from fabric_cad.study.names import figure_names
from fabric_cad.study.sensitivity import read_sensitivities
from fabric_cad.study.store import held, unit_key
from fabric_cad.study.table import read_table
from fabric_cad.study.table_figures import identified_figures
from fabric_cad.support.errors import OutputError

SOBOL = """
base = "plain_measured"
design = "sobol"
samples = 64
seed = 3
[factors]
weft_density_per_mm = "normal"
weft_width_mm = { from = 3.0, to = 4.7 }
weft_crimp = "normal"
"""
CELLS = """
base = "plain"
design = "grid"
depth = "{depth}"
{more}
[factors]
weft_width_mm = {widths}
"""
COARSE = "mesh = { across = 6, gap = 2 }"


def cells(depth="mesh", more=COARSE, widths=(2.8, 3.6, 4.4)):
    return CELLS.format(depth=depth, more=more, widths=list(widths))


def study(text, name="study.toml"):
    Path(name).write_text(text, encoding="utf-8")
    return read_study(name)


def lines(name="study"):
    return sum(
        path.read_bytes().count(b"\n") for path in Path("build", name, "units").glob("*.jsonl")
    )


@pytest.fixture(scope="module")
def cluster():
    """A scheduler and two workers on the loopback, as someone else would have started them."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    ) as found:
        yield found


def test_an_identify_study_keeps_refused_fabrics_and_finds_what_matters(here, capsys):
    Path("study.toml").write_text(SOBOL)
    assert main(["study", "study.toml"]) == 0
    said = capsys.readouterr().out
    found = read_table("build/study")
    assert len(found["unit"]) == 64 * 5
    refused = found["status"] == "refused"
    assert 0 < refused.sum() < 100 and f"{refused.sum()} refused" in said
    assert all("is not below the weft spacing" in each for each in found["reason"][refused])
    fraction = found["volumes.yarn_volume_fraction"]
    np.testing.assert_array_equal(np.isnan(fraction), refused)
    text = Path("build/study/table.csv").read_text().splitlines()
    assert (
        len(text) == 64 * 5 + 1 and float(text[1].split(",")[3]) == found["weft_density_per_mm"][0]
    )
    sensitivity = Path("build/study/sensitivity.csv").read_text()
    assert "volumes.yarn_volume_fraction,weft_width_mm," in sensitivity
    assert Path("build/study/sensitivity.png").stat().st_size > 10_000


def test_a_study_of_no_fabric_at_all_says_why(here, capsys):
    Path("none.toml").write_text(
        'base = "plain"\ndesign = "grid"\n[factors]\nweft_width_mm = [5, 6]\n'
    )
    assert main(["study", "none.toml"]) == 0
    assert "none: 2 units: 0 done, 2 refused, 0 failed" in capsys.readouterr().out
    table = read_table("build/none")
    assert list(table["status"]) == ["refused"] * 2
    assert all("is not below" in reason for reason in table["reason"])


def test_a_finished_identify_study_is_left_alone(here):
    one = run_study(study(SOBOL))
    stamp = Path("build/study/table.parquet").stat().st_mtime_ns
    two = run_study(study(SOBOL))
    assert (one.before, two.before) == (0, 320) and one.done == two.done
    assert Path("build/study/table.parquet").stat().st_mtime_ns == stamp
    assert run_study(study(SOBOL.replace("seed = 3", "seed = 4"))).before == 0
    assert Path("build/study/table.parquet").stat().st_mtime_ns > stamp


@pytest.mark.parametrize(
    ("depth", "figure", "told"),
    [
        (
            "cell",
            "volumes.yarn",
            "'volumes.yarn' is no figure of depth cell; did you mean volumes.yarn_mm3?",
        ),
        ("mesh", "bogus", "'bogus' is no figure of depth mesh; there are "),
        (
            "cell",
            "mesh.nodes",
            "'mesh.nodes' is a figure of depth mesh, this study is of depth cell",
        ),
        ("identify", "tension.k=1.E11", "'tension.k=1.E11' is a figure of depth tension, "),
        (
            "tension",
            "tension.k=3.E11",
            "'tension.k=3.E11' is no figure of depth tension; did you mean tension.k=",
        ),
        ("cell", "section", "'section' is no figure of depth cell"),
        (
            "cell",
            "stiffness.Ex",
            "'stiffness.Ex' is a figure of depth stiffness, this study is of depth cell",
        ),
        (
            "stiffness",
            "mesh.nodes",
            "'mesh.nodes' is a figure of depth mesh, this study is of depth stiffness",
        ),
    ],
)
def test_a_figure_that_is_none_is_refused_before_any_unit_runs(here, capsys, depth, figure, told):
    text = f"base = 'plain'\ndesign = 'one-at-a-time'\ndepth = '{depth}'\nfigures = ['{figure}']\n"
    Path("a.toml").write_text(text + "factors = { weft_width_mm = [2.8] }\n")
    assert main(["study", "a.toml"]) == 2
    assert capsys.readouterr().err.startswith(f"a.toml:4: figures: {told}")
    assert not Path("build/a").exists()


def test_a_figure_that_no_row_can_have_is_refused_before_any_unit_runs(here, capsys):
    Path("study.toml").write_text(cells("cell", "figures = ['volumes.areal_density_g_m2']"))
    assert main(["study", "study.toml"]) == 2
    told = "study.toml: figures: volumes.areal_density_g_m2: no fabric of this study has it"
    assert capsys.readouterr().err.startswith(told) and not lines()


def test_every_figure_of_an_identify_study_is_known_by_name(here):
    for name in ("plain_measured", "twill22_measured", "satin5", "basket22"):
        row = find_row("families", name)[0]
        figures = identified_figures(row, identify_rows(row))
        numbers = {
            figure for figure, values in figures.items() if np.array(values).dtype.kind in "if"
        }
        assert numbers <= set(figure_names("identify"))


def test_a_constant_figure_is_said_to_be_one_and_has_no_row(here, capsys):
    figures = "figures = ['identified.weft.spacing_mm', 'identified.weft.thickness_mm']\n"
    text = "base = 'plain_unbalanced'\ndesign = '{}'\n{}" + figures
    text += "factors = {{ weft_crimp = {{ from = 0.003, to = 0.004, steps = 5 }} }}\n"
    for design, more in (
        ("sobol", "samples = 8\n"),
        ("grid", ""),
        ("latin-hypercube", "samples = 9\n"),
    ):
        Path("study.toml").write_text(text.format(design, more))
        assert main(["study", "study.toml"]) == 0
        told = capsys.readouterr().err
        assert (
            "note: identified.weft.spacing_mm has no sensitivities: it is " in told
            and told.count("note") == 1
        )
        content = Path("build/study/sensitivity.csv").read_text()
        assert (
            "nan" not in content
            and "spacing" not in content
            and "identified.weft.thickness_mm," in content
        )


def test_no_sensitivities_of_an_earlier_study_stay(here):
    text = "base = 'plain'\ndesign = 'one-at-a-time'\nfigures = ['{}']\nfactors = {{ weft_crimp = [0.003] }}\n"
    run_study(study(text.format("identified.weft.crimp")))
    names = {f"sensitivity.{kind}" for kind in ("csv", "png", "pdf")}
    assert {path.name for path in Path("build/study").glob("sensitivity*")} == names
    run_study(study(text.format("identified.weft.spacing_mm")))
    assert not list(Path("build/study").glob("sensitivity*"))


def test_the_answer_is_printed_the_factor_that_matters_most_first(here, capsys):
    Path("study.toml").write_text(SOBOL)
    for _ in range(2):  # also of a study that is finished
        assert main(["study", "study.toml"]) == 0
        said = capsys.readouterr().out.splitlines()
        at = said.index("identified.fabric_thickness_mm depends on")
        printed = [line.split()[:2] for line in said[at + 1 : at + 4]]
        rows = [
            row
            for row in read_sensitivities("build/study")
            if row["figure"] == "identified.fabric_thickness_mm"
        ]
        ranked = sorted(rows, key=lambda row: -abs(row["total"]))
        assert printed == [[row["factor"], f"{row['total']:.2f}"] for row in ranked]
    refused = [line for line in said if " refused, such as: " in line]
    assert len(refused) == 1 and "is not below the weft spacing" in refused[0]


@pytest.mark.parametrize("name", ["", "units", "cells", "table.parquet", "sensitivity.png"])
def test_what_stands_in_the_way_is_told_before_any_unit_runs(here, capsys, name):
    path, is_file = Path("build/study", name), "." not in name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("mine") if is_file else path.mkdir()
    Path("study.toml").write_text(cells("cell", "keep = true"))
    assert main(["study", "study.toml"]) == 1
    assert capsys.readouterr().err == f"{path}: is in the way, it is {'not ' * is_file}a folder\n"
    assert path.is_file() == is_file and not (name and name != "units" and lines())


def test_a_mesh_study_on_a_cluster(here, cluster):
    address = cluster.scheduler_address
    told = []
    first = run_study(study(cells()), scheduler=address, listen=told.append)
    assert (first.done, first.refused, first.failed, first.before, lines()) == (3, 0, 0, 0, 3)
    assert told[-1].finished == told[-1].units == 3 and told[-1].rate > 0 and told[-1].left == 0
    found = read_table("build/study")
    row = find_row("families", "plain")[0]
    report = make_cell(row, "build", {"across": 6, "gap": 2})
    assert (found["mesh.hexahedra"] == report["mesh"]["hexahedra"]).all()
    assert (found["mesh.min_scaled_jacobian"] > 0.2).all()
    numbers = {name for name in found if "." in name and found[name].dtype.kind in "if"}
    assert {
        name for name in numbers if name.startswith(("mesh.", "consistency."))
    } and numbers <= set(figure_names("mesh"))
    assert (found["consistency.max_penetration_mm"] < 1e-12).all()
    with open("build/study/costs.csv", newline="") as file:
        costs = list(csv.DictReader(file))
    assert [row["unit"] for row in costs] == ["0", "1", "2"]
    assert all(float(row["total"]) > float(row["mesh"]) > 0 for row in costs)
    assert all(100 < float(row["process_megabytes"]) < 1500 for row in costs)
    table = Path("build/study/table.parquet").read_bytes()

    again = run_study(study(cells()), scheduler=address)  # nothing is run again
    assert (again.before, lines()) == (3, 3) and Path(
        "build/study/table.parquet"
    ).read_bytes() == table
    wider = run_study(study(cells(widths=(2.8, 3.6, 4.4, 5.2, 6.0))), scheduler=address)
    assert (wider.done, wider.refused, wider.before) == (3, 2, 5)
    assert read_table("build/study")["status"].tolist() == [
        "done",
        "done",
        "done",
        "refused",
        "refused",
    ]
    assert lines() == 3


def test_a_stiffness_study_homogenises_every_fabric_and_knows_its_constituents(here):
    more = "mesh = { across = 4, crossing = 4, gap = 2 }\nfigures = ['stiffness.Ex']"
    text = cells("stiffness", more, (2.8, 3.4))
    assert run_study(study(text), workers=1).done == 2
    table = read_table("build/study")
    numbers = {name for name, values in table.items() if name.startswith("stiffness.")}
    assert numbers == {name for name in figure_names("stiffness") if name.startswith("stiffness.")}
    assert table["stiffness.Ex"][1] > table["stiffness.Ex"][0] > 10e3  # wider yarns, more fibre
    assert table["stiffness.Ex"] == pytest.approx(table["stiffness.Ey"], rel=1e-6)
    assert run_study(study(text), workers=1).before == 2

    constituents, before = Path("families/composite.toml"), study(text)
    constituents.write_text(constituents.read_text().replace("E_MPa = 3500.0", "E_MPa = 4500.0"))
    assert unit_key(before.base, before.work, False) != unit_key(
        before.base, study(text).work, False
    )


@needs_ccx
def test_a_tension_study_has_the_figures_that_are_known_by_name(here):
    settings = Path("families/simulation.toml")
    few = (
        settings.read_text()
        .replace("ratios = [0, 0.5, 1, 2, inf]", "ratios = [1]")
        .replace("points = 4", "points = 1")
    )
    settings.write_text(few.replace("grid = 5", "grid = 0"))
    more = "mesh = { across = 4, crossing = 4, gap = 2 }\nfigures = ['tension.k=1.T11_N_per_yarn']"
    tension = study(cells("tension", more, (3.4,)))
    assert run_study(tension, workers=1).done == 1
    found = read_table("build/study")
    numbers = {name for name in found if "." in name and found[name].dtype.kind in "if"}
    known = set(figure_names("tension", tension.work.settings))
    assert "tension.k=1.T11_N_per_yarn" in numbers and numbers <= known
    assert {name for name in known if name.startswith("tension.")} <= set(found)


def test_kept_files_are_in_a_folder_of_the_unit(here, cluster):
    run_study(study(cells("cell", "keep = true", (2.8, 4.4))), scheduler=cluster.scheduler_address)
    kept = sorted(
        path.relative_to("build/study/cells").as_posix()
        for path in Path("build/study/cells").glob("*/*")
    )
    assert kept == [
        f"plain_{k}/{name}"
        for k in (0, 1)
        for name in (f"plain_{k}.step", "report.json", "solved.csv")
    ]
    report = json.loads(Path("build/study/cells/plain_1/report.json").read_text())
    assert report["identified"]["weft"]["width_mm"] == 4.4 and "mesh" not in report


def test_a_unit_that_failed_is_tried_again_and_one_that_is_done_is_not(here):
    told = []
    one = run_study(
        study(cells("cell", "limit_seconds = 0.05", (2.8, 3.6))), workers=2
    )  # CadQuery takes longer to load
    assert (one.done, one.failed, one.before) == (0, 2, 0)
    reason = "twice its worker died or took longer than limit_seconds = 0.05"
    assert (
        one.reasons == (("failed", reason),) * 2
        and read_table("build/study")["reason"].tolist() == [reason] * 2
    )

    two = run_study(
        study(cells("cell", "limit_seconds = 300", (2.8, 3.6))), workers=2, listen=told.append
    )
    assert (two.done, two.failed, two.before) == (2, 0, 0)
    assert (told[0].finished, told[-1].finished, told[-1].units) == (0, 2, 2)
    three = run_study(study(cells("cell", "limit_seconds = 0.05", (2.8, 3.6))), workers=2)
    assert (three.done, three.before) == (2, 2)


def test_another_run_of_the_same_study_is_told_so(here, capsys):
    Path("study.toml").write_text(SOBOL)
    with held(Path("build/study")):
        assert main(["study", "study.toml"]) == 1
        with pytest.raises(OutputError):
            run_study(read_study("study.toml"))
    told = capsys.readouterr().err
    holder = f"process {os.getpid()} on {socket.gethostname()}"
    assert (
        told
        == f"build/study: another run of this study is under way ({holder}); its table will be here\n"
    )
    assert main(["study", "study.toml", "-q"]) == 0


@pytest.mark.skipif(os.name != "posix", reason="makes links")
def test_the_lock_of_a_study_is_taken_nowhere_else(here):
    Path("build/study").mkdir(parents=True)
    Path("build/study/.lock").symlink_to(here / "elsewhere")
    Path("build/linked").symlink_to(here)
    for folder in ("build/study", "build/linked"):
        with pytest.raises(OutputError, match="link"), held(Path(folder)):
            pass
    assert not Path("elsewhere").exists()


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "fabric_cad", "study", "study.toml", "--workers", "2", *arguments],
        start_new_session=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def wait_for(condition, process, seconds=120.0):
    end = time.monotonic() + seconds
    while not condition():
        assert process.poll() is None and time.monotonic() < end, process.communicate()
        time.sleep(0.01)


@pytest.mark.skipif(os.name != "posix", reason="kills a process group")
def test_three_kills_leave_the_same_table(here):
    chance = random.Random(5)
    Path("study.toml").write_text(cells("cell", "", np.linspace(2.8, 4.4, 10).tolist()))
    for _ in range(3):
        before = lines()
        process = start()
        wait_for(lambda before=before: lines() > before, process)
        time.sleep(chance.uniform(0.0, 0.3))
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
    assert 3 <= lines() <= 10
    path = max(Path("build/study/units").glob("*.jsonl"), key=lambda each: each.stat().st_size)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) - 40])  # and one line is torn
    assert start().wait(timeout=120) == 0
    assert lines() == 10
    disturbed = {
        name: Path("build/study", name).read_bytes() for name in ("table.parquet", "table.csv")
    }
    process = start("--out", "undisturbed")
    assert process.wait(timeout=120) == 0
    for name, content in disturbed.items():
        assert Path("undisturbed/study", name).read_bytes() == content


@pytest.mark.skipif(os.name != "posix", reason="sends a POSIX signal")
def test_ctrl_c_leaves_a_study_that_goes_on(here):
    Path("study.toml").write_text(cells("cell", "", np.linspace(2.8, 4.4, 12).tolist()))
    process = start()
    wait_for(lambda: lines() >= 1, process)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    out, told = process.communicate(timeout=60)
    assert process.returncode == 1 and out == ""
    assert told.splitlines()[-1].endswith(
        "of 12 units are finished, the same command goes on from there"
    )
    assert "Traceback" not in told
    assert 1 <= lines() < 12 and not Path("build/study/table.csv").exists()


def test_the_example_of_the_documentation_runs(here):
    page = (Path(__file__).parents[2] / "docs/studies.md").read_text(encoding="utf-8")
    (example,) = (part.split("```")[0] for part in page.split("```toml\n")[1:])
    counts = run_study(study(example))
    assert counts.done + counts.refused == 200 and counts.done > 100
    rows = Path("build/study/sensitivity.csv").read_text().splitlines()
    assert rows[0] == "figure,factor,spearman,p_value" and len(rows) > 9
