"""Levels: neighbours at a crossing are half the sum of both amplitudes apart, however many lie below."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabric_cad.weave.directions import Direction
from fabric_cad.weave.levels import Level
from fabric_cad.weave.weaves import Weave, yarns_of

AMPLITUDES, COUNTS = st.floats(0, 2), st.integers(0, 4)


@given(AMPLITUDES, AMPLITUDES, COUNTS, COUNTS)
def test_a_warp_on_a_weft_and_a_weft_on_a_warp(A1, A2, wefts, warps):
    weft = Level(wefts, warps).height(Direction.WEFT, A1, A2)
    warp_on_it = Level(wefts + 1, warps).height(Direction.WARP, A1, A2)
    assert warp_on_it - weft == pytest.approx((A1 + A2) / 2, abs=1e-12)

    warp = Level(wefts, warps).height(Direction.WARP, A1, A2)
    weft_on_it = Level(wefts, warps + 1).height(Direction.WEFT, A1, A2)
    assert weft_on_it - warp == pytest.approx((A1 + A2) / 2, abs=1e-12)


@given(AMPLITUDES, AMPLITUDES)
def test_two_levels_span_an_amplitude(A1, A2):
    low, high = (Level(0, below).height(Direction.WEFT, A1, A2) for below in (0, 1))
    assert (low, high) == (0.0, A1)
    low, high = (Level(below, 0).height(Direction.WARP, A1, A2) for below in (0, 1))
    assert (low, high) == ((A1 - A2) / 2, (A1 + A2) / 2)


@pytest.mark.parametrize(
    "weave", [Weave(1, 1), Weave(3, 2), Weave(1, 7, 3), Weave(pattern=("110", "001"))]
)
def test_of_two_crossing_yarns_one_has_the_other_below(weave):
    yarns = yarns_of(weave.interlacement())
    wefts, warps = ([yarn for yarn in yarns if yarn.direction is d] for d in Direction)
    weft_over = np.array([[level.warps_below for level in yarn.levels] for yarn in wefts])
    warp_over = np.array([[level.wefts_below for level in yarn.levels] for yarn in warps])
    assert (weft_over + warp_over.T == 1).all()
    assert (weft_over == weave.warps_below()).all()
