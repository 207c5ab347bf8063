"""The skin of every yarn: exact contact, common tangents, nothing outside its envelope."""

import numpy as np
import pytest
from fabrics import (
    TWILL32,
    flat_gaps,
    random_general_row,
    random_pattern_row,
    random_row,
    skin_of,
    table,
)
from hypothesis import given, settings
from scipy.interpolate import BSpline
from sweeps import fabric_of, patch_of, points, seeds

from fabric_cad.model.identification import identify
from fabric_cad.pictures.plots import section_outline
from fabric_cad.weave.weaves import Weave, yarns_of
from fabric_cad.yarn.planes import contact_segment
from fabric_cad.yarn.swept import SweptYarn, swept_yarns

DRAWS = {
    "standard": random_row,
    "general": random_general_row,
    "flat gaps": flat_gaps(random_pattern_row),
}
rows = pytest.mark.parametrize("draw", DRAWS.values(), ids=DRAWS)


@rows
@given(seed=seeds)
@settings(max_examples=25, deadline=None)
def test_contact_faces_coincide(draw, seed):
    fabric = fabric_of(draw, seed)
    yarns = yarns_of(fabric.weave.interlacement())
    over = fabric.weave.interlacement()
    rng = np.random.default_rng(seed)
    share = np.linspace(0, 1, 9)
    for _ in range(4):
        i, j = rng.integers(0, fabric.weave.wefts), rng.integers(0, fabric.weave.warps)
        weft, warp = yarns[i], yarns[fabric.weave.wefts + j]
        found = []
        for yarn, crossing, side in (
            (weft, j, "bottom" if over[i, j] else "top"),
            (warp, i, "top" if over[i, j] else "bottom"),
        ):
            surface = skin_of(fabric, yarn)
            patch = patch_of(surface, contact_segment(surface.planes, crossing), side)
            place = points(patch, share, share)
            place[..., 1] += surface.axis
            found.append(place if yarn is weft else place[..., [1, 0, 2]].transpose(1, 0, 2))
        assert found[0] == pytest.approx(found[1], abs=1e-12 * max(1, *fabric.period))


@rows
@given(seed=seeds)
@settings(max_examples=25, deadline=None)
def test_neighbouring_faces_have_common_points_and_tangents(draw, seed):
    fabric = fabric_of(draw, seed)
    yarns = yarns_of(fabric.weave.interlacement())
    share = np.linspace(0, 1, 7)
    for yarn in (yarns[0], yarns[-1]):
        surface = skin_of(fabric, yarn)
        segments = len(surface.planes) - 1
        for side in {patch.side for patch in surface.patches}:
            strip = [patch_of(surface, segment, side) for segment in range(segments)]
            shift = np.array([surface.planes[-1].place, 0.0, 0.0])
            for first, second, moved in [
                *((a, b, 0.0) for a, b in zip(strip, strip[1:])),
                (strip[-1], strip[0], shift),
            ]:
                assert points(first, [1.0], share) == pytest.approx(
                    points(second, [0.0], share) + moved, abs=1e-11
                )
                ends = points(first, [1.0], share, along=1), points(second, [0.0], share, along=1)
                assert ends[0] == pytest.approx(ends[1], abs=1e-9)


@rows
@given(seed=seeds)
@settings(max_examples=25, deadline=None)
def test_sections_fill_their_envelope_and_nothing_else(draw, seed):
    fabric = fabric_of(draw, seed)
    yarns = yarns_of(fabric.weave.interlacement())
    for yarn in (yarns[0], yarns[-1]):
        solved = fabric.directions[yarn.direction]
        for section in SweptYarn(fabric, yarn).sections:
            v, z = section_outline(section, 801)
            assert (v.min(), v.max()) == pytest.approx(
                (-solved.width / 2, solved.width / 2), rel=1e-9
            )
            assert (z.min(), z.max()) == pytest.approx(
                (-solved.thickness / 2, solved.thickness / 2), rel=1e-5
            )
            assert np.sum(v[:-1] * z[1:] - v[1:] * z[:-1]) > 0  # counter-clockwise
            assert section.pointed == (fabric.section == "lenticular")
            assert section.rounded == (fabric.section == "round")
            if fabric.section == "flat":
                for side in ("left", "right"):
                    assert np.ptp(section.strips[side].poles[:, 1]) == pytest.approx(
                        fabric.lateral_height
                    )


@given(seeds)
@settings(max_examples=40, deadline=None)
def test_round_sections_are_smooth_all_around(seed):
    fabric = fabric_of(lambda rng: random_general_row(rng, form="round"), seed)
    yarns = yarns_of(fabric.weave.interlacement())
    joints = [
        ("bottom", "right_lower"),
        ("left_lower", "bottom"),
        ("top", "right_upper"),
        ("left_upper", "top"),
    ]
    for yarn in (yarns[0], yarns[-1]):
        for section in SweptYarn(fabric, yarn).sections:
            for before, after in joints:
                first, second = section.strips[before].poles, section.strips[after].poles
                assert first[-1, :2] == pytest.approx(second[0, :2], abs=1e-12)
                tangents = first[-1, :2] - first[-2, :2], second[1, :2] - second[0, :2]
                (a, b), (c, d) = (tangent / np.linalg.norm(tangent) for tangent in tangents)
                assert abs(a * d - b * c) < 1e-6
            for side in (
                "right_lower",
                "left_lower",
                "right_upper",
                "left_upper",
            ):  # vertical at the edge
                poles = section.strips[side].poles
                edge = poles[[-1, -2]] if side.startswith("right") else poles[[0, 1]]
                assert edge[0, 0] == pytest.approx(edge[1, 0], abs=1e-12)


def test_the_trajectory_passes_the_control_points():
    fabric = identify(table("twill", TWILL32))["twill32"]
    yarn = yarns_of(fabric.weave.interlacement())[0]  # over warps 1, 2, 3, under 4, 5
    assert yarn.high == (True, True, True, False, False)
    path = SweptYarn(fabric, yarn).trajectory

    def z(x):
        piece = next(p for p in path.pieces if p.knots[0] <= x <= p.knots[-1])
        return float(BSpline(piece.knots, piece.poles, piece.degree)(x))

    period, middle = (
        fabric.period[0],
        4 * fabric.weft.crossed_spacing,
    )  # M11: mid-float under warps 4 and 5
    for x, height_there in fabric.weft.points:
        for place in (middle + x, middle - x):
            assert z(place % period) == pytest.approx(height_there, abs=1e-12)


@pytest.mark.parametrize("weave", [Weave(1, 1), Weave(3, 2), Weave(1, 7, 3), Weave(1, 4, 2)])
def test_interlacement(weave):
    over = weave.interlacement()
    assert over.shape == (weave.wefts, weave.warps)
    assert (over.sum(axis=1) == weave.over).all() and (over.sum(axis=0) == weave.over).all()
    for yarn in yarns_of(over):
        changes = sum(a != b for a, b in zip(yarn.high, yarn.high[1:] + yarn.high[:1]))
        assert changes == 2
    assert (np.roll(over[0], weave.step) == over[1]).all()


def test_weaves_that_are_none():
    for numbers in ((0, 1), (1, 0), (1, 7, 2)):
        with pytest.raises(ValueError):
            Weave(*numbers)


@rows
@given(seed=seeds)
@settings(max_examples=10, deadline=None)
def test_a_swept_yarn_is_made_once_and_starts_and_ends_in_its_sections(draw, seed):
    fabric = fabric_of(draw, seed)
    share = np.linspace(0, 1, 5)
    for swept in swept_yarns(fabric)[:2]:
        assert swept.skin is swept.skin and swept.trajectory.planes is swept.planes
        assert len(swept.sections) == len(swept.planes) == len(swept.trajectory.pieces) + 1

        for patch in swept.skin.patches:
            piece = swept.trajectory.pieces[patch.segment]
            for end, place in ((0, piece.poles[0]), (1, piece.poles[-1])):
                strip = swept.sections[patch.segment + end].strips[patch.side]
                expected = strip.at(share) + [0.0, place]
                np.testing.assert_allclose(
                    patch.at([end], share)[0, :, 1:], expected, rtol=0, atol=1e-12
                )
