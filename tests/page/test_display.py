"""A fabric in a notebook: a page in a frame that may run its own script only, and a picture where it is shown."""

import html
import re
import subprocess
import sys

import pytest

import fabric_cad
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_family
from fabric_cad.page.document import fabric_page
from fabric_cad.page.edited import solution_of
from fabric_cad.support.errors import ArgumentError

ROW = read_family(shipped_families() / "twill.csv")["twill22"]


def test_a_row_is_shown_as_its_page_in_a_frame_without_rights():
    text = fabric_cad.show(ROW)._repr_html_()
    frame = re.fullmatch(
        r'<iframe sandbox="([^"]*)" srcdoc="([^"]*)" style="[^"]*" title="twill22"></iframe>', text
    )
    assert frame[1] == "allow-scripts"
    assert html.unescape(frame[2]) == fabric_page(solution_of(ROW)).text


def test_what_is_no_row_is_not_shown():
    with pytest.raises(ArgumentError):
        fabric_cad.show("twill22")


def test_a_solved_fabric_is_a_picture_and_a_table_in_a_notebook_and_as_before_outside():
    code = (
        "from IPython.core.interactiveshell import InteractiveShell\n"
        "shell = InteractiveShell.instance()\n"
        "import fabric_cad\n"
        f"table = fabric_cad.identify(fabric_cad.read_family({str(shipped_families() / 'twill.csv')!r}))\n"
        "print(shell.display_formatter.format(table['twill22'])[0]['text/html'])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "<svg" in done.stdout and "twill 2*2" in done.stdout and "<td>0.3171</td>" in done.stdout
    assert not hasattr(fabric_cad.identify(ROW)["twill22"], "_repr_html_")
