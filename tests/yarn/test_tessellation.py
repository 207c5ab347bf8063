"""Tiles are the swept yarns themselves: on their patches, joined to each other, closed, outwards."""

import numpy as np
import pytest
from fabrics import DRAWS, random_general_row, table

from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError
from fabric_cad.weave.directions import Direction
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.edges import allowed_over, allowed_scaled_jacobian
from fabric_cad.yarn.swept import SweptYarn
from fabric_cad.yarn.tessellation import BITS, swept_tiles, tessellate, tile_codes
from fabric_cad.yarn.tiles import COARSE, SIDES, Grid, basis
from fabric_cad.yarn.volumes import yarn_volumes

SHIPPED = {
    fabric.name: fabric
    for measured in read_families(shipped_families()).values()
    for fabric in identify(measured)
}


def drawn(draw, seed, **options):
    """A random fabric; draws that are none are drawn anew."""
    rng = np.random.default_rng(seed)
    for _ in range(200):
        try:
            family, row = draw(rng, **options)
            (fabric,) = identify(table(family, row))
            return fabric
        except InputError:
            continue
    raise AssertionError("no fabric in 200 draws")


RANDOM = {f"{part}-{seed}": drawn(draw, seed) for part, draw in DRAWS.items() for seed in range(2)}
RANDOM |= {f"round-{seed}": drawn(random_general_row, seed, form="round") for seed in range(2)}
FABRICS = SHIPPED | RANDOM


def standing(tiling):
    """Points of every tile where it stands, (instances, points, 3)."""
    return tiling.points[tiling.tile] + tiling.places[:, None]


def in_plan(direction, points):
    return points if direction == Direction.WEFT else points[..., [1, 0, 2]]


@pytest.mark.parametrize("name", FABRICS)
def test_points_of_tiles_are_those_of_the_swept_yarns_patches(name):
    fabric, grid = FABRICS[name], COARSE
    for tiled in tessellate(fabric, grid):
        points = standing(tiled.tiles)
        for yarn in (
            yarn
            for yarn in yarns_of(fabric.weave.interlacement())
            if yarn.direction == tiled.direction
        ):
            swept = SweptYarn(fabric, yarn)
            gaps = [number for number, plane in enumerate(swept.planes) if plane.crossing is None]
            for crossing, (first, last) in enumerate(zip(gaps, gaps[1:])):
                own = points[(tiled.tiles.yarn == yarn.index)][crossing]
                patches = [patch for patch in swept.skin.patches if first <= patch.segment < last]
                expected = _on_patches(patches, first, grid) + [0.0, swept.trajectory.axis, 0.0]
                assert np.abs(own - in_plan(tiled.direction, expected)).max() < 1e-12 * max(
                    fabric.period
                )


def _on_patches(patches, first, grid):
    """The grid of points on patches of one crossing, in the order of a tile."""
    sides = [side for side in SIDES if any(patch.side == side for patch in patches)]
    segments = max(patch.segment for patch in patches) - first + 1
    across = grid.intervals(sides)
    strips = []
    for side in sides:
        rows = []
        for intervals, patch in zip(
            grid.along[segments], (patch for patch in patches if patch.side == side)
        ):
            values = patch.at(np.linspace(0, 1, intervals + 1), np.linspace(0, 1, across[side] + 1))
            rows.append(values if not rows else values[1:])
        strips.append(np.vstack(rows).reshape(-1, 3))
    return np.vstack(strips)


@pytest.mark.parametrize("name", FABRICS)
def test_tiles_of_neighbours_join_in_points_and_normals(name):
    for tiled in tessellate(FABRICS[name]):
        tiles, axis = tiled.tiles, tiled.direction.axis
        points, normals = standing(tiles), tiles.normals[tiles.tile]
        start = np.isclose(tiles.points[0, :, axis], 0.0, atol=1e-9)
        end = np.isclose(tiles.points[0, :, axis], tiles.points[0, :, axis].max(), rtol=1e-12)
        assert start.sum() == end.sum() > 0
        for yarn in np.unique(tiles.yarn):
            own = np.flatnonzero(tiles.yarn == yarn)
            for before, after in zip(own, own[1:]):
                assert np.abs(points[before][end] - points[after][start]).max() < 1e-11
                assert np.abs(normals[before][end] - normals[after][start]).max() < 1e-7
            # the last one runs on into the first, a period on
            assert np.abs((points[own[-1]][end] - points[own[0]][start])[:, 1 - axis]).max() < 1e-11
            assert np.abs((points[own[-1]][end] - points[own[0]][start])[:, 2]).max() < 1e-11


@pytest.mark.parametrize("name", FABRICS)
def test_tiles_and_caps_enclose_the_yarns_volume(name):
    fabric = FABRICS[name]
    fine = Grid({3: (12, 18, 12), 5: (9, 6, 12, 6, 9)}, {1: (36,), 3: (9, 18, 9)})
    coarse, finer = ([volume(tiled) for tiled in tessellate(fabric, grid)] for grid in (None, fine))
    if fabric.section == "round":
        assert np.allclose(coarse, finer, rtol=0.03)  # no closed form
        return
    columns = {column: np.array([value]) for column, value in _columns(fabric).items()}
    exact = [yarn_volumes(columns, (fabric.weave,))[d][0] for d in Direction]
    errors = [np.abs(np.array(found) / exact - 1).max() for found in (coarse, finer)]
    assert errors[1] < 4e-3 and errors[1] < errors[0] / 6  # of second order, a third of the size


def _columns(fabric):
    """The columns of a solved table that volumes look at."""
    columns = {"section": fabric.section}
    for name, solved in fabric.directions.items():
        columns |= {
            f"{name}_width_mm": solved.width,
            f"{name}_thickness_mm": solved.thickness,
            f"{name}_crossed_spacing_mm": solved.crossed_spacing,
            f"{name}_between_q": solved.between.q,
        }
        for plateau, contact in solved.contact.items():
            columns[f"{name}_{plateau}_offset_mm"] = contact.offset
        for (plateau, kind), side in solved.free_sides.items():
            columns |= {
                f"{name}_{plateau}_{kind}_q": side.q,
                f"{name}_{plateau}_{kind}_v0_mm": side.v0,
            }
    return columns | {
        "p11": fabric.weft.p_low, "p12": fabric.weft.p_high, "p21": fabric.warp.p_high, "p22": fabric.warp.p_low
    }  # fmt: skip


def volume(tiled):
    """Of tiles and caps together, mm3, by the divergence theorem: right where all triangles turn outwards."""
    total = 0.0
    for tiling in (tiled.tiles, tiled.caps):
        corners = standing(tiling)[:, tiling.triangles]
        a, b, c = corners[:, :, 0], corners[:, :, 1], corners[:, :, 2]
        total += np.einsum("nti,nti->", a, np.cross(b, c)) / 6
    return total


@pytest.mark.parametrize(
    "name", ["plain_flat", "twill22_chords", "twill22_round", "satin8", "patterns-1", "round-0"]
)
def test_normals_are_unit_and_those_of_the_triangles_in_the_limit(name):
    fine = Grid({3: (12, 18, 12), 5: (9, 6, 12, 6, 9)}, {1: (36,), 3: (9, 18, 9)})
    for tiled in tessellate(FABRICS[name], fine):
        for tiling in (tiled.tiles, tiled.caps):
            assert np.abs(np.linalg.norm(tiling.normals, axis=-1) - 1).max() < 1e-12
            corners = tiling.points[:, tiling.triangles]
            faces = np.cross(
                corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0]
            )
            sizes = np.linalg.norm(faces, axis=-1)
            means = tiling.normals[:, tiling.triangles].mean(axis=2)
            sines = np.linalg.norm(np.cross(faces, means), axis=-1)
            assert (faces * means).sum(axis=-1).min() >= 0.0
            assert sines.sum() < 0.03 * sizes.sum()  # at most 2 degrees off in the mean


def test_a_code_tells_high_and_the_four_turns():
    weave = SHIPPED["herringbone22"].weave
    for direction in Direction:
        yarns = [yarn for yarn in yarns_of(weave.interlacement()) if yarn.direction == direction]
        for yarn, codes in zip(yarns, tile_codes(weave.interlacement(), direction)):
            n = len(yarn.high)
            for k, code in enumerate(codes):
                high = yarn.high[k]
                turns = high != yarn.high[k - 1], high != yarn.high[(k + 1) % n]
                bits = dict(zip(BITS, (high, *turns, yarn.turns_left[k], yarn.turns_right[k])))
                assert code == sum(bit << place for place, bit in enumerate(bits.values()))


def test_the_basis_is_that_of_scipy():
    from scipy.interpolate import BSpline

    rng = np.random.default_rng(3)
    for degree in (1, 2, 3):
        inner = np.sort(rng.uniform(0.1, 0.9, size=3))
        knots = np.array([0.0] * (degree + 1) + [*inner] + [1.0] * (degree + 1))
        places = np.linspace(0, 1, 23)
        values, slopes = basis(knots, degree, places)
        spline = BSpline(knots, np.eye(len(knots) - degree - 1), degree)
        assert np.abs(values - spline(places)).max() < 1e-14
        assert np.abs(slopes - spline.derivative()(places)).max() < 1e-12


def test_a_tile_is_not_made_twice_and_arrays_cannot_be_written_to():
    weft, _ = tessellate(SHIPPED["satin8"])
    assert len(weft.tiles.points) == len(np.unique(weft.tiles.tile)) <= 32
    with pytest.raises(ValueError, match="read-only"):
        weft.tiles.points[0] = 0.0


@pytest.mark.parametrize("name", FABRICS)
def test_the_edges_of_tiles_allow_what_those_of_the_yarns_do(name):
    assert allowed_over(swept_tiles(FABRICS[name])) == pytest.approx(
        allowed_scaled_jacobian(FABRICS[name]), rel=1e-9
    )
