"""The rules of a row stand in one place: whoever asks is told the same of the same row."""

from dataclasses import replace

import numpy as np
import pytest
from fabrics import UNBALANCED, table
from hypothesis import given, settings
from hypothesis import strategies as some

from fabric_cad.measured.columns import MEASURED, NUMBERS, WEAVE_COLUMNS
from fabric_cad.measured.relations import out_of_bounds
from fabric_cad.measured.rules import bound_fault
from fabric_cad.study.design import Samples
from fabric_cad.study.rows import study_rows
from fabric_cad.support.errors import InputError

WEAVES = {
    "plain": {},
    "twill": {"over": 2, "under": 2},
    "satin": {"harness": 5, "step": 2},
    "pattern": {"pattern": "ou/uo"},
}
CELLS = {
    "over": some.sampled_from([0, 1, 3, 100, 101]),
    "under": some.sampled_from([-1, 1, 2]),
    "harness": some.sampled_from([1, 2, 5, 6, 8, 200]),
    "step": some.sampled_from([0, 1, 2, 3, 6]),
    "pattern": some.sampled_from(
        ["ou/uo", "oo/uo", "ou", "oou/uo", "xo/ou", "/".join(["ou", "uo"] * 60)]
    ),
}
OFTEN_SOUND = some.sampled_from([-1.0, 0.0, 0.05, 0.2, 1.0, 2.5, 3.0, 4.0, 6.0])


def told(family, row):
    try:
        table(family, row)
    except InputError as error:
        return [(problem.column, problem.message) for problem in error.problems]
    return []


@settings(deadline=None, max_examples=300)
@given(draw=some.data())
def test_reader_and_study_refuse_the_same_rows_for_the_same_reason(draw):
    family = draw.draw(some.sampled_from(list(WEAVES)))
    base = WEAVES[family] | UNBALANCED | {"section": "lenticular"}
    varied = {column: draw.draw(CELLS[column]) for column in WEAVE_COLUMNS[family]}
    numbers = draw.draw(some.dictionaries(some.sampled_from(MEASURED), OFTEN_SOUND, max_size=5))
    section = draw.draw(some.sampled_from(["lenticular", "round", "flat"]))

    values = {
        name: np.array([value]) for name, value in (varied | numbers | {"section": section}).items()
    }
    _, refused = study_rows(table(family, base), Samples(values))
    asked = [(problem.column, problem.message) for problem in refused.values()]

    row = base | varied | {"section": section}
    measured = {column: (row | numbers)[column] for column in MEASURED if column in row | numbers}
    cells = {column: value for column, value in row.items() if column not in MEASURED} | {
        column: f"{value:g}" for column, value in measured.items()
    }
    answers = told(family, cells)
    of_weave = [answer for answer in answers if answer[0] in WEAVE_COLUMNS[family]]
    assert (
        asked == (of_weave or answers)[:1]
    )  # a study tells one fault a row, of the weave before others


@pytest.mark.parametrize("column", ["warp_density_per_mm", "warp_width_mm"])
def test_a_direction_without_a_cell_is_told_alike_of_texts_and_of_numbers(column):
    whole = table("plain", UNBALANCED)
    lacking = replace(whole, measured=whole.measured | {column: np.array([np.nan])})
    answers = told("plain", {name: value for name, value in UNBALANCED.items() if name != column})
    assert [
        (problem.column, problem.message) for problem in out_of_bounds(lacking).values()
    ] == answers


@pytest.mark.parametrize("column", NUMBERS)
def test_the_bound_of_a_column_is_the_readers(column):
    value = column.removesuffix("_std")
    density = value if value.startswith("weft_density_per_") else "weft_density_per_mm"
    cells = {"name": "r", density: 0.2, "weft_width_mm": 3}
    if value not in cells and value != column:
        cells[value] = 1

    for number in (-1, 0):
        fault = bound_fault(column, number)
        assert ((column, fault) in told("plain", cells | {column: number})) == (fault is not None)
