"""The Makefile's defaults, without running a target: make says what it would do."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")


def foretold(*arguments, **environment):
    settings = {
        name: value
        for name, value in os.environ.items()
        if name not in ("WEAVE", "MAKEFLAGS", "MAKELEVEL")
    }
    done = subprocess.run(
        ["make", "-n", *arguments],
        cwd=ROOT,
        env=settings | environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


@pytest.mark.parametrize("target", ["cell", "composite", "tension", "shear", "show"])
def test_without_a_weave_the_default_row_is_taken(target):
    assert f"fabric-cad {target} twill32" in foretold(
        target
    )  # make predefines WEAVE itself, for CWEB


def test_a_weave_is_taken_from_the_command_line_and_the_environment():
    assert "fabric-cad cell satin8" in foretold("cell", "WEAVE=satin8")
    assert "fabric-cad cell plain" in foretold("cell", WEAVE="plain")
