"""The skin of every yarn: exact contact, common tangents, nothing outside its envelope."""

import numpy as np
import pytest
from fabrics import TWILL32, random_row, table
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from fabric_cad.errors import InputError
from fabric_cad.identification import identify
from fabric_cad.sweeps import control_planes, control_sections, skin, trajectory
from fabric_cad.weaves import Weave, yarns_of

seeds = st.integers(0, 2**32 - 1)


def fabric_of(seed):
    family, row = random_row(np.random.default_rng(seed))
    try:
        return identify(table(family, row))[row["name"]]
    except InputError:
        assume(False)


def skins(fabric):
    """Yarn name to (yarn, skin)."""
    found = {}
    for yarn in yarns_of(fabric.weave.interlacement()):
        path = trajectory(fabric, yarn, control_planes(fabric, yarn.direction))
        found[yarn.name] = yarn, skin(path, control_sections(fabric, yarn))
    return found


def height(patch, t, v, along=0, across=0):
    """z, or a derivative of it, of a patch at the grid of t (along) and v (across the axis)."""
    first = BSpline(patch.along.knots, patch.z, patch.along.degree)(t, along)
    return BSpline(patch.across.knots, first.T, patch.across.degree)(v, across).T


def patches(surface, side):
    return [patch for patch in surface.patches if patch.side == side]


@given(seeds)
@settings(max_examples=25, deadline=None)
def test_contact_faces_coincide(seed):
    fabric = fabric_of(seed)
    yarns = skins(fabric)
    over = fabric.weave.interlacement()
    scale = fabric.fabric_thickness
    rng = np.random.default_rng(seed)
    for i, j in rng.integers(0, fabric.weave.wefts, (6, 2)):
        (_, weft), (_, warp) = yarns[f"weft_{i + 1}"], yarns[f"warp_{j + 1}"]
        x = warp.axis + np.linspace(-0.5, 0.5, 9) * fabric.warp.width
        y = weft.axis + np.linspace(-0.5, 0.5, 9) * fabric.weft.width
        sides = ("bottom", "top") if over[i, j] else ("top", "bottom")
        z_weft = height(patches(weft, sides[0])[3 * j + 1], x, y - weft.axis)
        z_warp = height(patches(warp, sides[1])[3 * i + 1], y, x - warp.axis).T
        assert np.max(np.abs(z_weft - z_warp)) < 1e-12 * max(scale, 1)


@given(seeds)
@settings(max_examples=25, deadline=None)
def test_neighbouring_faces_have_common_points_and_tangents(seed):
    fabric = fabric_of(seed)
    for name in ("weft_1", f"warp_{fabric.weave.wefts}"):
        yarn, surface = skins(fabric)[name]
        width = fabric.directions[yarn.direction].width
        v = np.linspace(-width / 2, width / 2, 11)
        for side in ("top", "bottom"):
            strip = patches(surface, side)
            for first, second in zip(strip, strip[1:]):
                plane = first.along.knots[-1]
                assert second.along.knots[0] == plane
                for derivative in (0, 1):
                    ends = [height(patch, plane, v, along=derivative) for patch in (first, second)]
                    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


@given(seeds)
@settings(max_examples=25, deadline=None)
def test_sections_fill_their_envelope_and_nothing_else(seed):
    fabric = fabric_of(seed)
    for yarn in yarns_of(fabric.weave.interlacement())[:: fabric.weave.wefts]:
        solved = fabric.directions[yarn.direction]
        v = np.linspace(-solved.width / 2, solved.width / 2, 2001)
        knots = np.repeat([-solved.width / 2, 0, solved.width / 2], (3, 1, 3))
        for section in control_sections(fabric, yarn):
            top, bottom = (BSpline(knots, poles, 2)(v) for poles in (section.top, section.bottom))
            assert top.max() == pytest.approx(solved.thickness / 2, rel=1e-6)
            assert bottom.min() == pytest.approx(-solved.thickness / 2, rel=1e-6)
            # lenticular edges close, flat ones keep their height, the sides never cross
            assert (top - bottom)[[0, -1]] == pytest.approx(fabric.lateral_height, abs=1e-12)
            assert (top - bottom)[1:-1].min() > fabric.lateral_height - 1e-12
            assert section.pointed == (fabric.section == "lenticular")


@given(seeds)
@settings(max_examples=15, deadline=None)
def test_the_cell_repeats(seed):
    fabric = fabric_of(seed)
    for yarn, surface in skins(fabric).values():
        v = np.linspace(-0.5, 0.5, 5) * fabric.directions[yarn.direction].width
        for side in ("top", "bottom"):
            first, *_, last = patches(surface, side)
            start, end = first.along.knots[0], last.along.knots[-1]
            for derivative in (0, 1):
                assert height(first, start, v, along=derivative) == pytest.approx(
                    height(last, end, v, along=derivative), abs=1e-12
                )


def test_the_trajectory_passes_the_control_points():
    fabric = identify(table("twill", TWILL32))["twill32"]
    yarn = yarns_of(fabric.weave.interlacement())[0]  # over warps 1, 2, 3, under 4, 5
    assert yarn.high == (True, True, True, False, False)
    path = trajectory(fabric, yarn, control_planes(fabric, "weft"))

    def z(x):
        piece = next(p for p in path.pieces if p.knots[0] <= x <= p.knots[-1])
        return float(BSpline(piece.knots, piece.poles, piece.degree)(x))

    period, middle = fabric.period[0], 4 * fabric.weft.crossed_spacing  # M11: mid-float under warps 4 and 5
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
