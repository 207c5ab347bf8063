"""A solved row read back: it drives masters, so that what it says has to mean something."""

import pytest
from fabrics import TWILL32, table

from fabric_cad.model.identification import identify
from fabric_cad.model.solved import SolvedFabric, read_solved
from fabric_cad.support.errors import InputError


def test_a_written_row_is_the_fabric_it_was(tmp_path):
    solved = identify(table("twill", TWILL32))
    solved.write(tmp_path / "solved.csv")
    assert read_solved(tmp_path / "solved.csv") == solved[TWILL32["name"]]


def test_a_row_from_before_float_gaps_has_symmetric_ones():
    row = identify(table("twill", TWILL32)).row(TWILL32["name"])
    without = {column: value for column, value in row.items() if column != "float_gap"}
    assert SolvedFabric.from_row(without) == SolvedFabric.from_row(row)


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("section", "oval", "section: 'oval' is none of lenticular, flat, round"),
        ("float_gap", "open", "float_gap: 'open' is none of symmetric, flat"),
        ("weft_width_mm", "wide", "'wide' is not a number"),
    ],
)
def test_a_word_that_means_nothing_is_refused(tmp_path, column, value, message):
    solved = identify(table("twill", TWILL32))
    text = {name: str(values[0]) for name, values in solved.columns.items()} | {column: value}
    path = tmp_path / "solved.csv"
    path.write_text(",".join(text) + "\n" + ",".join(text.values()) + "\n")
    with pytest.raises(InputError, match=message):
        read_solved(path)
