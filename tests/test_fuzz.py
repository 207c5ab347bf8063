"""A few of the trials of ``make fuzz``, and that its judgement sees what is wrong."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from fuzzing.results import deck_elements, mixed, row_files
from fuzzing.trial import Ended, Trial, faults

pytestmark = pytest.mark.skipif(
    not hasattr(os, "waitid"), reason="forks a process a trial, and waits as Linux does"
)


@pytest.mark.parametrize(
    ("part", "seeds"),
    [
        ("tables", "0-30"),
        ("toml", "0-12"),
        ("drafts", "0-30"),
        ("commands", "0-12"),
        ("kills", "3-5"),
        ("twice", "0"),
    ],
)
def test_no_input_and_no_kill_harms(part, seeds):
    script = Path(__file__).with_name("fuzz.py")
    done = subprocess.run(
        [sys.executable, script, "--part", part, "--seeds", seeds],
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stdout + done.stderr


TRIAL = Trial(
    "a wrong table", ("solve",), {}, r"families/plain\.csv:\d+: ", leaves="build/families/plain.csv"
)
REFUSAL = "families/plain.csv:3: weft_crimp: 'x' is not a number (row plain)\n"

CRASH = 'Traceback (most recent call last):\n  File "/a/b.py", line 3, in c\nKeyError\n'


@pytest.mark.parametrize(
    ("ended", "wrong"),
    [
        (Ended(0, "", "", 0.1, ("build/families/plain.csv",)), []),
        (Ended(2, "", REFUSAL, 0.1), []),
        (Ended(None, "", "", 20.0), ["takes more than 20 s"]),
        (Ended(1, "", REFUSAL, 0.1), ["exit status 1"]),
        (Ended(2, "", "wrong\n", 0.1), ["a refusal without its place"]),
        (
            Ended(2, "", REFUSAL, 0.1, ("build/families/plain.csv",)),
            ["left behind: build/families/plain.csv"],
        ),
        (Ended(2, "", REFUSAL, 0.1, ("(temp folder) x",)), ["left behind: (temp folder) x"]),
        (Ended(0, "\x1b[31mred \u202etext", "", 0.1), ["printed U+001B, U+202E"]),
        (
            Ended(2, "", f'{REFUSAL}Traceback\n  File "/a/b.py", line 3\nKeyError', 0.1),
            ["a traceback (b.py:3): KeyError"],
        ),
    ],
)
def test_what_is_wrong_with_an_ending_is_seen(ended, wrong):
    assert faults(TRIAL, ended) == wrong


def test_a_folder_of_two_results_is_seen():
    deck = (
        b"*NODE\n1, 0., 0., 0.\n*ELEMENT, TYPE=C3D8, ELSET=weft_1\n1, 1\n2, 1\n"
        b"*Element, elset=warp_1\n3, 1\n*NSET\n1\n"
    )
    assert deck_elements(deck) == 3
    whole = dict.fromkeys(row_files("plain"), b"") | {"plain.inp": deck}
    whole |= {"report.json": b'{"mesh": {"hexahedra": 3}}'}
    assert mixed("plain", whole) == []
    assert mixed("plain", whole | {"report.json": b'{"mesh": {"hexahedra": 4}}'}) == [
        "the deck has 3 elements, the report 4"
    ]
    assert mixed("plain", {"plain.inp": deck})[0].startswith("missing: plain.msh")
