"""Voxels of a composite cell: exact fractions in the limit, faces where the skin is, files as they are read."""

import numpy as np
import pytest

from fabric_cad.composite.fibres import fibre_fractions, fibre_sections
from fabric_cad.composite.substances import Constituents, Fibre, GivenYarn, Matrix
from fabric_cad.composite.voxels import vertical_extent, voxelise
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError
from fabric_cad.yarn.heights import heights
from fabric_cad.yarn.profiles import section_areas
from fabric_cad.yarn.swept import swept_yarns

ROWS = [
    "plain",
    "plain_flat",
    "plain_round",
    "twill22_offsets",
    "twill22_chords",
    "twill22_round",
    "satin5",
]


@pytest.fixture(scope="module")
def tables():
    return read_families(shipped_families())


@pytest.fixture(scope="module")
def fabrics(tables):
    return {fabric.name: fabric for table in tables.values() for fabric in identify(table)}


def volume(swept):
    """A yarn's volume, mm3: Gauss over all knots."""
    points, weights = np.polynomial.legendre.leggauss(8)
    knots = np.unique(np.concatenate([piece.knots for piece in swept.trajectory.pieces]))
    spans = np.diff(knots)[:, None]
    return (
        section_areas(swept, (knots[:-1, None] + spans * (points + 1) / 2).ravel())
        @ (spans * weights / 2).ravel()
    )


@pytest.mark.parametrize("name", ROWS)
def test_heights_are_those_of_the_skin(fabrics, name):
    """At the points of the skin's own patches, and the area between both faces is the section's."""
    swept = swept_yarns(fabrics[name])[0]
    for patch in swept.skin.patches[:: max(1, len(swept.skin.patches) // 12)]:
        if patch.side in ("left", "right"):
            continue
        for t, v, z in patch.at(np.array([0.3, 0.8]), np.array([0.2, 0.7])).reshape(-1, 3):
            faces = np.array(heights(swept, np.array([t]), np.array([v]))).ravel()
            assert np.abs(faces - z).min() < 1e-9

    edge = swept.fabric.directions[swept.yarn.direction].width / 2
    v = edge * np.sin(
        np.linspace(-np.pi / 2, np.pi / 2, 2001)
    )  # dense at the edges, where arcs are upright
    places = np.array([0.1, 0.37, 0.62]) * swept.planes[-1].place
    lower, upper = heights(swept, places, np.clip(v, -edge, edge))
    area = np.sum((upper - lower)[:, 1:-1] * (v[2:] - v[:-2]) / 2, axis=1)
    np.testing.assert_allclose(area, section_areas(swept, places), rtol=1e-4)


@pytest.mark.parametrize("name", ROWS)
def test_shares_are_exact_to_half_a_voxel(fabrics, name):
    """Upright edges lie along rows of voxels, which round off alike; elsewhere errors cancel."""
    fabric = fabrics[name]
    yarns = swept_yarns(fabric)
    volumes = {swept.yarn.name: volume(swept) for swept in yarns}
    for counts in ((31, 37, 23), (93, 111, 69)):
        voxels = voxelise(fabric, counts, 0.05 * fabric.fabric_thickness)
        found = voxels.fractions()
        for swept in yarns:
            way = fabric.directions[swept.yarn.direction]
            beside, up = voxels.spacing[1 - swept.yarn.direction.axis], voxels.spacing[2]
            exact = volumes[swept.yarn.name] / np.prod(voxels.spacing * counts)
            assert found[swept.yarn.name] == pytest.approx(
                exact, rel=(beside / way.width + up / way.thickness) / 2
            )


def test_every_voxel_between_a_yarns_faces_is_that_yarns(fabrics):
    fabric = fabrics["twill22_offsets"]
    voxels = voxelise(fabric, (40, 50, 30), 0.02)
    low, high = vertical_extent(fabric)
    assert high - low == pytest.approx(fabric.fabric_thickness)

    x, y, z = (
        voxels.origin[n] + (np.arange(count) + 0.5) * voxels.spacing[n]
        for n, count in enumerate((40, 50, 30))
    )
    for number, swept in enumerate(swept_yarns(fabric), start=1):
        along, across = (x, y) if swept.yarn.direction == "weft" else (y, x)
        lower, upper = (
            face + -(low + high) / 2
            for face in heights(swept, along, across - swept.trajectory.axis)
        )
        inside = (z > lower[..., None]) & (z < upper[..., None])
        own = voxels.body if swept.yarn.direction == "weft" else voxels.body.swapaxes(0, 1)
        np.testing.assert_array_equal(own == number, inside)


def test_a_shifted_period_gives_the_same_material(fabrics):
    """Half a cell of a plain weave further stands the same weave with its directions' floats exchanged."""
    body = voxelise(fabrics["plain"], (40, 40, 30), 0.03).body
    yarn = (body > 0).astype(int) + (body > 2)
    np.testing.assert_array_equal(np.roll(yarn, (20, 20), (0, 1)), yarn)
    flipped = np.roll(yarn, 20, 0)[:, :, ::-1]
    assert (flipped == yarn).mean() > 0.999


def test_axes_are_unit_vectors_along_the_yarns(fabrics):
    voxels = voxelise(fabrics["satin5"], (50, 50, 30), 0.01)
    length = np.linalg.norm(voxels.fibre_axis, axis=-1)
    np.testing.assert_allclose(length[voxels.body > 0], 1, atol=1e-6)
    assert not length[voxels.body == 0].any()
    weft, warp = voxels.body == 1, voxels.body == 6
    assert not voxels.fibre_axis[weft][:, 1].any()
    assert not voxels.fibre_axis[warp][:, 0].any()


def test_fractions_are_those_along_the_yarn(tables, fabrics):
    row = tables["plain"]["twintex_tpeet22"]
    fabric = fabrics["twintex_tpeet22"]
    sections = fibre_sections(
        row, Constituents(Matrix(3500.0, 0.35), Fibre(73e3, 73e3, 30e3, 30e3, 0.2, 2.5))
    )
    voxels = voxelise(fabric, (24, 24, 20), 0.05, sections)
    swept = swept_yarns(fabric)[0]
    places = (np.arange(24) + 0.5) * voxels.spacing[0]
    expected = fibre_fractions(swept, sections, places)
    for number, value in enumerate(expected):
        found = voxels.fibre_fraction[number][voxels.body[number] == 1]
        np.testing.assert_allclose(found, value, rtol=1e-6)
    assert not voxels.fibre_fraction[voxels.body == 0].any()
    assert np.isnan(voxelise(fabric, (6, 6, 6), 0.05).fibre_fraction).any()

    given = fibre_sections(
        row, Constituents(Matrix(3500.0, 0.35), None, GivenYarn(0.5, own_fraction=True))
    )
    half = voxelise(fabric, (6, 6, 6), 0.05, given)
    np.testing.assert_array_equal(np.unique(half.fibre_fraction), [0, 0.5])


def test_both_files_hold_the_same(fabrics, tmp_path):
    import pyvista

    voxels = voxelise(fabrics["plain_unbalanced"], (7, 8, 9), 0.05)
    voxels.write_npz(tmp_path / "voxels.npz")
    voxels.write_vti(tmp_path / "voxels.vti")
    stored, image = np.load(tmp_path / "voxels.npz"), pyvista.read(tmp_path / "voxels.vti")
    assert (
        stored["yarns"].tolist()
        == ["weft_1", "weft_2", "warp_1", "warp_2"]
        == list(image.field_data["yarn_names"])
    )
    np.testing.assert_array_equal(
        stored["body"], image.cell_data["body"].reshape(9, 8, 7).transpose(2, 1, 0)
    )
    axes = image.cell_data["fibre_axis"].reshape(9, 8, 7, 3).transpose(2, 1, 0, 3)
    np.testing.assert_array_equal(stored["fibre_axis"], axes)
    np.testing.assert_allclose(
        image.bounds[1::2], stored["origin_mm"] + stored["spacing_mm"] * (7, 8, 9)
    )
    for point in image.cell_centers().points[::37]:
        x, y, z = ((point - stored["origin_mm"]) / stored["spacing_mm"]).astype(int)
        assert image.cell_data["body"][image.find_containing_cell(point)] == stored["body"][x, y, z]


def test_a_grid_that_is_none_is_refused(fabrics):
    for counts in ((0, 5, 5), (10_000, 10_000, 10_000)):
        with pytest.raises(InputError, match="cells: .* is not from 1x1x1"):
            voxelise(fabrics["plain"], counts, 0.05)
