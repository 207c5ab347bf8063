"""Cells of others as rows: that they are computed, and that the documentation tells what comes out.

The others' numbers are recalled or another program's and stand beside ours in ``docs/stiffness.md``; nothing is
fitted to them, and no test asks for agreement.
"""

import re
from pathlib import Path

import numpy as np
import pytest

from fabric_cad.cell.pipeline import Stages, find_row
from fabric_cad.composite.constituents import read_constituents
from fabric_cad.composite.homogenisation.homogenise import constants
from fabric_cad.composite.options import CompositeOptions, Margin
from fabric_cad.composite.stiffness.computation import composite_model, compute_stiffness

FOLDER = Path(__file__).parent / "published"
PAGE = Path(__file__).parents[2] / "docs" / "stiffness.md"


@pytest.mark.parametrize("name", ["scida_plain", "b3_tex_plain"])
def test_a_cell_of_others_is_as_the_documentation_says(name):
    row, _ = find_row(FOLDER, name)
    options = CompositeOptions(margin=Margin(0.01))
    model = composite_model(
        row, read_constituents(FOLDER, name), mesh={}, options=options, stages=Stages()
    )
    effective = compute_stiffness(model, plate=False, stages=Stages()).effective
    found = constants(effective.stiffness)

    cells = [
        line.strip("| ").split("|")
        for line in PAGE.read_text(encoding="utf-8").splitlines()
        if "| here |" in line
    ]
    told = {"scida_plain": cells[0], "b3_tex_plain": cells[1]}[name][-6:]
    for key, text in zip(("Ex", "Ez", "Gxy", "Gxz", "nu_xy", "nu_xz"), told):
        value = found[key] / (1 if key.startswith("nu") else 1e3)
        digits = len(re.sub(r"^[0.]*|\.", "", text.strip()))
        assert float(f"{value:.{digits}g}") == pytest.approx(float(text)), key
    for lower, upper in (
        (effective.reuss, effective.stiffness),
        (effective.stiffness, effective.voigt),
    ):
        assert np.linalg.eigvalsh(upper - lower).min() > 0
