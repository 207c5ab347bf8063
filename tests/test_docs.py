"""The documentation builds without a warning, its links lead somewhere, and what it says of the program is true."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from links import broken_links

import fabric_cad
from fabric_cad import identify, read_family
from fabric_cad.measured.columns import MEASURED, OTHER_UNITS, TEXTS, WEAVE_COLUMNS

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "CHANGELOG.md",
    *sorted(DOCS.glob("*.md")),
]
READ = {page: page.read_text(encoding="utf-8") for page in PAGES}
EVERYTHING = "\n".join(READ.values())


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    trees, html = folder / "trees", folder / "html"
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-b",
        "html",
        "-d",
        str(trees),
        str(DOCS),
    ]
    done = subprocess.run([*command, str(html)], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    gallery = [
        "page",
        "--gallery",
        "--quiet",
        "--out",
        str(html),
        "--families",
        str(ROOT / "families"),
    ]
    subprocess.run(
        [sys.executable, "-m", "fabric_cad", *gallery], cwd=ROOT, check=True, capture_output=True
    )
    return html


def test_every_link_within_the_site_leads_somewhere(site):
    assert len(list(site.glob("*.html"))) > 10
    assert broken_links(site) == []


def test_a_broken_link_is_found(tmp_path):
    (tmp_path / "one.html").write_text(
        '<a href="two.html#there">a</a> <a href="two.html#not">b</a> <img src="no.png">'
    )
    (tmp_path / "two.html").write_text('<h1 id="there">x</h1> <a href="https://example.org/">c</a>')
    assert broken_links(tmp_path) == [
        "one.html: two.html#not: no such place",
        "one.html: no.png: no such file",
    ]


def test_the_reference_has_every_public_name():
    told = re.findall(
        r"^\.\. auto(?:function|class|exception):: (\w+)$",
        READ[DOCS / "reference.md"],
        re.MULTILINE,
    )
    assert sorted(told) == sorted(set(fabric_cad.__all__) - {"__version__"})


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.parent == ROOT], ids=lambda page: page.name
)
def test_files_a_top_page_links_to_exist(page):
    for address in re.findall(r"\]\(([^)#:]+)\)", READ[page]):
        assert (ROOT / address).exists(), address


def test_the_readme_is_short():
    assert len(READ[ROOT / "README.md"].splitlines()) <= 110


def test_make_targets_that_are_named_exist():
    targets = set(re.findall(r"^([a-z-]+):.*## ", (ROOT / "Makefile").read_text(), re.MULTILINE))
    named = set(re.findall(r"^make ([a-z-]+)|`make ([a-z-]+)", EVERYTHING, re.MULTILINE))
    assert {"cell", "test"} <= {one or other for one, other in named} <= targets


def test_commands_and_options_that_are_named_exist():
    def manual(*command):
        return subprocess.run(
            [sys.executable, "-m", "fabric_cad", *command, "--help"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout

    commands = set(re.findall(r"^    ([a-z]+) ", manual(), re.MULTILINE))
    named = set(re.findall(r"(?:`|^)fabric-cad ([a-z]+)", EVERYTHING, re.MULTILINE))
    assert named and named <= commands

    known = "".join(manual(command) for command in commands)
    options = set(
        re.findall(r"`(--[a-z]+)", "".join(READ[page] for page in PAGES if page.parent == DOCS))
    )
    assert "--through" in options and all(option in known for option in options)


def test_every_column_is_told():
    page = READ[DOCS / "tables.md"]
    alike = re.compile("^(weft|warp)_")
    for column in (
        *MEASURED,
        *TEXTS,
        *(name for names in WEAVE_COLUMNS.values() for name in names),
    ):
        assert alike.sub("weft_", column) in page, column
    assert {name.rpartition("_")[2] for name in OTHER_UNITS} - {"std"} == {"cm", "inch", "percent"}


def test_the_readmes_row_is_a_fabric(tmp_path):
    (table,) = re.findall(r"```text\n(name,.*?)```", READ[ROOT / "README.md"], re.DOTALL)
    (tmp_path / "twill.csv").write_text(table)
    assert identify(read_family(tmp_path / "twill.csv"))[
        "twill32"
    ].fabric_thickness == pytest.approx(0.7096, abs=5e-5)


def test_names_that_examples_import_are_public():
    blocks = re.findall(r"```python\n(.*?)```", EVERYTHING, re.DOTALL)
    names = {
        name
        for block in blocks
        for line in re.findall(r"^from fabric_cad import (.*)$", block, re.MULTILINE)
        for name in line.split(", ")
    }
    assert {"identify", "measured_fabric"} <= names <= set(fabric_cad.__all__)
