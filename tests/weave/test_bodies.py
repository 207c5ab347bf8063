"""Bodies and surfaces: their names are written and read back, and nothing else is a name."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabric_cad.weave.bodies import Body, BodyKind, Surface, SurfaceKind
from fabric_cad.weave.directions import DIRECTIONS, Direction

BODIES = st.just(Body(BodyKind.MATRIX)) | st.builds(
    Body.yarn, st.sampled_from(DIRECTIONS), st.integers(0, 10**6)
)


@given(BODIES, st.sampled_from(SurfaceKind))
def test_names_are_read_back(body, kind):
    assert Body.named(body.name) == body
    assert Surface.named(Surface(body, kind).name) == Surface(body, kind)


@pytest.mark.parametrize(
    "name", ["", "weft", "weft_0", "weft_01", "weft_1_", "weft_-1", "yarn", "Weft_1", "weft_1\n"]
)
def test_what_is_no_name_is_refused(name):
    with pytest.raises(ValueError):
        Body.named(name)
    with pytest.raises(ValueError):
        Surface.named(f"{name}_contact")


def test_only_a_yarn_has_a_direction():
    with pytest.raises(ValueError):
        Body(BodyKind.MATRIX, Direction.WEFT, 0)
    with pytest.raises(ValueError):
        Body(BodyKind.YARN)


def test_directions_cross_each_other():
    for direction in DIRECTIONS:
        assert direction.other is not direction and direction.other.other is direction
        assert direction.axis == 1 - direction.other.axis
