"""What the page asks and is answered, without a server: any argument a browser may send gets an answer."""

import json
import time
from pathlib import Path

import pytest
from wifs import WIF

from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.page.datasheet import datasheet, write_datasheet
from fabric_cad.page.desk import MOST_TABS, Desk, Places
from fabric_cad.page.edited import edited, solution_of
from fabric_cad.page.jobs import Job
from fabric_cad.page.server import Address, inside_here, open_browser
from fabric_cad.support.errors import OutputError

ROWS = {
    row.names[0]: row for measured in read_families(shipped_families()).values() for row in measured
}


@pytest.fixture
def desk(here):
    return Desk(edited(ROWS["twill22"]), Places(here / "families", here / "build"))


def test_answers_are_json_and_a_scene_comes_with_another_fabric_only(desk):
    first = desk.ask("a", "open", "")
    assert json.loads(json.dumps(first))["row"]["name"] == "twill22" and "scene" in first

    refused = desk.ask("a", "change", "weft_width_mm", "3", True)
    assert refused["row"]["refused"] and "scene" not in refused
    assert "not below" in next(
        q["refusal"] for q in refused["row"]["quantities"] if q["column"] == "weft_width_mm"
    )
    assert "scene" in desk.ask("a", "change", "weft_width_mm", "2.2", True)
    assert desk.ask("a", "undo")["row"]["quantities"][1]["text"] == "2.4"


def test_tabs_do_not_mix(desk):
    for tab in ("a", "b"):
        desk.ask(tab, "open", "")
    desk.ask("a", "flip", [[0, 0]])
    desk.ask("a", "change", "weft_width_mm", "2.2", False)
    assert desk.row("b") == edited(ROWS["twill22"])
    assert desk.row("a").cells["weft_width_mm"] == "2.2" and desk.row("a").family == "pattern"

    for number in range(MOST_TABS):
        desk.ask(f"tab{number}", "open", "")
    assert "no answer" in desk.ask("a", "undo")["problem"]  # forgotten


def test_a_link_opens_its_row_and_a_wrong_one_is_told(desk):
    link = desk.ask(
        "a", "open", "plain?name=p&weft_density_per_mm=0.2&weft_width_mm=3&weft_crimp=0.004"
    )["row"]["link"]
    assert desk.ask("b", "open", link)["row"]["link"] == link
    wrong = desk.ask("c", "open", "plain?weft_width_mm=3")
    assert "weft_density_per_mm" in wrong["problem"] and wrong["row"]["name"] == "twill22"


@pytest.mark.parametrize(
    "asked",
    [
        ("nothing",),
        ("change",),
        ("change", 3, 4, True),
        ("change", "no_such_column", "1", False),
        ("change", "weft_width_mm", "9" * 5000, False),
        ("flip", [[99, 0]]),
        ("flip", "all"),
        ("flip", [["a", "b"]]),
        ("resize", "x", 3),
        ("weave", "knit", {}),
        ("weave", "twill", {}),
        ("draft", "a.wif", 5),
        ("draft", "a.wif", "no draft"),
        ("cut", "sideways", 0.5),
        ("cut", "weft", "half"),
        ("save", "../../etc/passwd", False),
        ("save", "", True),
        ("_answer",),
        ("row",),
    ],
)
def test_what_has_no_answer_is_told_and_changes_nothing(desk, asked):
    desk.ask("a", "open", "")
    before, files = desk.row("a"), sorted(desk.places.families.iterdir())
    assert desk.ask("a", *asked).get("problem")
    assert desk.row("a") == before
    assert sorted(desk.places.families.iterdir()) == files


def test_a_dropped_draft_is_read_strictly_and_told_of_by_its_own_name(desk):
    desk.ask("a", "open", "")
    assert desk.ask("a", "draft", "/home/x/mine.wif", WIF)["row"]["grid"] == ["01", "10"]
    told = desk.ask("a", "draft", "/home/x/mine.wif", WIF.replace("Threads=4", "Threads=many", 1))[
        "problem"
    ]
    assert told.startswith("mine.wif:7: [WARP] Threads") and "/tmp" not in told


def test_a_row_is_saved_but_never_over_one_without_asking(desk):
    desk.ask("a", "open", "")
    desk.ask("a", "change", "weft_width_mm", "2.2", False)
    asked = desk.ask("a", "save", "twill22", False)
    assert asked["exists"] and "there already" in asked["problem"]
    assert "changed in" in desk.ask("a", "save", "twill22", True)["done"]
    assert "added to" in desk.ask("a", "save", "another", False)["done"]


def test_figures_cuts_and_the_page_are_of_the_fabric_in_view(desk):
    desk.ask("a", "open", "")
    desk.ask("a", "change", "weft_width_mm", "3", False)  # refused: the last good one stays
    told = {figure["label"]: figure["text"] for figure in desk.ask("a", "figures")["figures"]}
    assert told["fabric thickness"] == "0.6341 mm"
    assert desk.ask("a", "cut", "weft", 0.125)["caption"].startswith("y = 1.429 mm")
    assert desk.ask("a", "page")["name"] == "twill22.html"


@pytest.mark.parametrize("folder", ["..", "/tmp", "build/../../x", "link"])
def test_no_other_folder_is_written(here, folder):
    (here / "link").symlink_to("/tmp")
    with pytest.raises(OutputError, match="is not in the folder"):
        inside_here(folder)
    assert inside_here("build/x") == (here / "build" / "x").resolve()


@pytest.mark.parametrize("name", ["plain_measured", "twill22_round", "twintex_tpeet44"])
def test_a_datasheet_is_one_page_of_a4(here, name):
    solution = solution_of(ROWS[name])
    assert datasheet(solution).get_size_inches() * 25.4 == pytest.approx([210, 297])
    write_datasheet(solution, here / "build" / name)
    pdf = (here / "build" / name / "datasheet.pdf").read_bytes()
    assert pdf.startswith(b"%PDF") and pdf.count(b"/Type /Page ") == 1
    write_datasheet(solution, here / "build" / "again")
    assert (here / "build" / "again" / "datasheet.pdf").read_bytes() == pdf


def test_a_browser_is_opened_without_the_token_in_its_arguments(monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    open_browser(Address(1234, "secret-token"))
    (address,) = opened
    file = Path(address.removeprefix("file://"))
    assert "secret-token" not in address and "secret=secret-token" in file.read_text()
    assert file.stat().st_mode & 0o077 == 0  # of its user alone
    file.unlink()


def test_a_cancelled_run_leaves_nothing(here):
    job = Job(edited(ROWS["plain"]), here / "build")
    job.start()
    deadline = time.monotonic() + 60
    while not job.stages and time.monotonic() < deadline:
        time.sleep(0.05)
    job.cancel()
    assert job.told()["state"] == "cancelled"
    assert [path.name for path in (here / "build").glob("*") if not path.name.startswith(".")] == []


def test_a_run_that_fails_says_why(here):
    (here / "build").write_text("in the way")
    job = Job(edited(ROWS["plain"]), here / "build")
    job.start()
    deadline = time.monotonic() + 60
    while job.state == "running" and time.monotonic() < deadline:
        time.sleep(0.05)
    assert job.told()["state"] == "failed" and "in the way" in job.told()["problem"]
