"""The lattice: a linear map with an inverse, and the cell's periods under it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabric_cad.weave.lattice import AS_WOVEN, Lattice

LENGTHS, ANGLES = st.floats(0.01, 100), st.floats(-60, 60)


def trellis(along_weft, along_warp, degrees):
    """Both directions turned towards each other by half an angle, and the fabric thicker."""
    half = np.radians(degrees) / 2
    turned = [
        [np.cos(half), np.sin(half), 0],
        [np.sin(half), np.cos(half), 0],
        [0, 0, 1 / np.cos(2 * half)],
    ]
    return Lattice(np.array([along_weft, along_warp]), np.array(turned))


@given(LENGTHS, LENGTHS, ANGLES, st.integers(0, 2**32 - 1))
def test_the_map_has_an_inverse_and_takes_periods_to_periods(along_weft, along_warp, degrees, seed):
    lattice = trellis(along_weft, along_warp, degrees)
    woven = np.random.default_rng(seed).uniform(-50, 50, (7, 3))

    space = lattice.to_space(woven)
    assert lattice.to_woven(space) == pytest.approx(woven, abs=1e-12)
    for axis in range(3):
        assert space @ lattice.woven_coordinate(axis) == pytest.approx(woven[:, axis], abs=1e-12)

    for axis, vector in enumerate(lattice.vectors):
        moved = woven.copy()
        moved[:, axis] += (along_weft, along_warp)[axis]
        assert lattice.to_space(moved) - space == pytest.approx(np.tile(vector, (7, 1)), abs=1e-12)


@given(LENGTHS, LENGTHS)
def test_as_woven_nothing_is_moved(along_weft, along_warp):
    lattice = Lattice.axis_parallel(along_weft, along_warp)
    places = np.arange(12.0).reshape(4, 3)
    assert lattice.to_space(places) is places and lattice.to_woven(places) is places
    assert lattice.vectors.tolist() == [[along_weft, 0, 0], [0, along_warp, 0]]
    assert AS_WOVEN.is_axis_parallel


def test_arrays_are_checked_and_read_only():
    with pytest.raises(ValueError, match="right-handed"):
        Lattice(np.ones(2), np.diag([1.0, -1.0, 1.0]))
    with pytest.raises(ValueError, match="shape"):
        Lattice(np.ones(3), np.eye(3))
    with pytest.raises(ValueError, match="read-only"):
        AS_WOVEN.axes[0, 0] = 2.0
