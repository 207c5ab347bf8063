"""The one order of corners, edges and faces, against what it must be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fabric_cad.meshing.hexahedron import (
    CORNERS,
    EDGES,
    FACES,
    LENGTHWISE,
    hexahedra_volumes,
    shape_slopes,
)


def test_edges_join_corners_along_their_axis():
    for axis, edges in enumerate(EDGES):
        steps = CORNERS[edges[:, 1]] - CORNERS[edges[:, 0]]
        assert (steps == 2 * np.eye(3, dtype=int)[axis]).all()
    assert sorted(EDGES[2].tolist()) == sorted(LENGTHWISE.tolist())


def test_every_face_lies_on_one_side_and_turns_inwards():
    sides = set()
    for corners in CORNERS[FACES]:
        (axis,) = np.flatnonzero(np.ptp(corners, axis=0) == 0)
        normal = np.cross(corners[1] - corners[0], corners[3] - corners[0])
        assert normal[axis] * corners[0, axis] < 0  # clockwise, seen from outside
        sides.add((int(axis), int(corners[0, axis])))
    assert len(sides) == 6


@given(st.integers(0, 2**32 - 1))
def test_slopes_and_volumes_of_a_linear_map(seed):
    rng = np.random.default_rng(seed)
    change = rng.normal(size=(3, 3))
    corners = CORNERS @ change + rng.normal(size=3)

    slopes = shape_slopes(rng.uniform(-1, 1, 3))
    assert corners.T @ slopes == pytest.approx(change.T, abs=1e-12)
    assert hexahedra_volumes(corners[None]) == pytest.approx(8 * np.linalg.det(change), abs=1e-12)


@given(st.integers(0, 2**32 - 1))
def test_the_volume_of_a_warped_hexahedron_is_what_its_faces_enclose(seed):
    """By the divergence theorem; a bilinear face's flux is exact at 2 x 2 Gauss points."""
    corners = CORNERS + np.random.default_rng(seed).uniform(-0.4, 0.4, (8, 3))

    enclosed = 0.0
    for face in FACES:
        a, b, c, d = corners[face]
        for s in (1 - 1 / np.sqrt(3), 1 + 1 / np.sqrt(3)):
            for t in (1 - 1 / np.sqrt(3), 1 + 1 / np.sqrt(3)):
                s_half, t_half = s / 2, t / 2
                place = (1 - s_half) * ((1 - t_half) * a + t_half * d) + s_half * (
                    (1 - t_half) * b + t_half * c
                )
                by_s = (1 - t_half) * (b - a) + t_half * (c - d)
                by_t = (1 - s_half) * (d - a) + s_half * (c - b)
                enclosed -= place @ np.cross(by_s, by_t) / 12
    assert hexahedra_volumes(corners[None])[0] == pytest.approx(enclosed, abs=1e-12)
