"""A fabric's page: one file, nothing from outside, numbers that come back, cuts that are the yarns'."""

import base64
import json
import re

import numpy as np
import pytest

from fabric_cad.cli import main
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.model.identification import identify
from fabric_cad.page.cuts import cut_fabric
from fabric_cad.page.document import fabric_page, gallery_page
from fabric_cad.page.drawing import cut_drawing
from fabric_cad.page.edited import edited, solution_of
from fabric_cad.page.scene import MANY, scene
from fabric_cad.weave.directions import DIRECTIONS, Direction
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.profiles import section_areas
from fabric_cad.yarn.swept import SweptYarn
from fabric_cad.yarn.tessellation import tessellate

ROWS = {
    row.names[0]: row for measured in read_families(shipped_families()).values() for row in measured
}
FEW = ["plain", "plain_flat", "twill22_chords", "twill22_round", "herringbone22"]


def numbers(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=kind)


@pytest.mark.parametrize("name", FEW)
def test_a_scene_holds_the_tiles_to_its_16_bits(name):
    fabric = identify(ROWS[name])[name]
    drawn = json.loads(json.dumps(scene(fabric)))
    groups = iter(drawn["groups"])
    for tiled in tessellate(fabric):
        for tiling in (tiled.tiles, tiled.caps):
            group = next(groups)
            points = numbers(group["points"], "<i2").reshape(group["tiles"], group["size"], 4)[
                ..., :3
            ]
            normals = numbers(group["normals"], "i1").reshape(*points.shape[:2], 4)[..., :3]
            back = np.array(group["middle"]) + np.array(group["extent"]) * points / 32767
            assert np.abs(back - tiling.points).max() < 2e-5 * np.ptp(tiling.points)
            assert np.abs(normals / 127 - tiling.normals).max() < 0.01
            assert np.array_equal(
                numbers(group["triangles"], "<u2").reshape(-1, 3), tiling.triangles
            )
            assert np.allclose(
                numbers(group["places"], "<f4").reshape(-1, 3), tiling.places, rtol=1e-6
            )


@pytest.mark.parametrize("name", ["plain", "twill22_chords", "twill22_offsets", "twill22_round"])
def test_contact_is_marked_where_points_lie_on_the_crossed_yarn(name):
    fabric = identify(ROWS[name])[name]
    for group in scene(fabric)["groups"][::2]:
        marks = (
            numbers(group["normals"], "i1").reshape(group["tiles"], group["size"], 4)[..., 3] > 0
        )
        points = numbers(group["points"], "<i2").reshape(*marks.shape, 4)[..., :3] / 32767
        points = np.array(group["middle"]) + np.array(group["extent"]) * points
        direction = Direction(group["direction"])
        own, crossed = fabric.directions[direction], fabric.crossed(direction)
        for tile, touching in zip(points, marks):
            along = np.ptp(tile[touching][:, direction.axis])
            across = np.ptp(tile[touching][:, direction.other.axis])
            assert any(
                np.isclose(along, 2 * side.half_chord, atol=2e-3)
                for side in crossed.contact.values()
            )
            assert any(
                np.isclose(across, 2 * side.half_chord, atol=2e-3) for side in own.contact.values()
            )


@pytest.mark.parametrize("name", FEW)
@pytest.mark.parametrize("share", [0.11, 0.5, 0.83])
def test_a_cut_across_a_yarn_has_its_sections_area_and_stays_in_the_fabric(name, share):
    fabric = identify(ROWS[name])[name]
    swept = {yarn.body: SweptYarn(fabric, yarn) for yarn in yarns_of(fabric.weave.interlacement())}
    for direction in DIRECTIONS:
        place = share * fabric.period[direction.other.axis]
        cut = cut_fabric(fabric, direction, place)
        crossed = [yarn for yarn in cut.yarns if yarn.body.direction != direction]
        assert len(crossed) == fabric.weave.crossed_by(direction)
        for yarn in crossed:
            v, z = yarn.outline.T
            area = np.sum(v * np.roll(z, -1) - z * np.roll(v, -1)) / 2
            assert area == pytest.approx(
                section_areas(swept[yarn.body], np.array([place]))[0], rel=0.02
            )
        heights = np.concatenate([yarn.outline[:, 1] for yarn in cut.yarns])
        assert np.ptp(heights) < fabric.fabric_thickness * (1 + 1e-9)


def test_a_cut_along_an_axis_is_as_thick_as_the_yarn_and_beside_the_yarns_there_is_none():
    fabric = identify(ROWS["twill22"])["twill22"]
    (own,) = [
        yarn
        for yarn in cut_fabric(fabric, DIRECTIONS[0], 1 / 0.35 / 2).yarns
        if yarn.body.direction == "weft"
    ]
    half = len(own.outline) // 2
    thick = own.outline[half:][::-1, 1] - own.outline[:half, 1]
    assert thick.max() == pytest.approx(fabric.weft.thickness, rel=1e-9)
    assert not [
        yarn
        for yarn in cut_fabric(fabric, DIRECTIONS[0], 0.0).yarns
        if yarn.body.direction == "weft"
    ]


@pytest.mark.parametrize("name", ROWS)
def test_a_page_asks_for_nothing_and_is_small(name):
    text = fabric_page(solution_of(ROWS[name])).text
    assert len(text.encode()) < 0.7e6
    outside = re.findall(
        r"(?:src|href|action)=\"([^\"]*)\"|url\(|@import|fetch\(|XMLHttp|WebSocket|import\(", text
    )
    assert outside == []
    assert re.findall(r"https?://[^\s\"]*", text) in ([], ["http://www.w3.org/2000/svg"] * 2)


def test_texts_of_a_row_are_escaped():
    nasty = '</script><img src=x onerror="alert(1)">'
    row = edited(ROWS["plain"]).changed(notes=nasty, source="<b>&")
    from fabric_cad.page.edited import answer

    text = fabric_page(answer(row)).text
    assert "<img" not in text and "&lt;/script&gt;&lt;img" in text and "&lt;b&gt;&amp;" in text


def test_many_crossings_are_drawn_with_coarse_tiles():
    satin = solution_of(ROWS["satin8"])
    large = edited(ROWS["satin8"]).resized(16, 16)
    from fabric_cad.page.edited import answer

    assert satin.fabric.weave.interlacement().size < MANY <= 256
    sizes = [scene(found.fabric)["groups"][0]["size"] for found in (satin, answer(large))]
    assert sizes[1] < sizes[0] / 2


def test_the_command_writes_a_page_and_a_gallery(here, capsys):
    assert main(["page", "twill22"]) == 0
    assert "twill22" in (here / "build" / "twill22" / "page.html").read_text()
    assert main(["page", "--gallery"]) == 0
    index = (here / "build" / "gallery" / "index.html").read_text()
    links = re.findall(r'href="([^"]+)"', index)
    assert sorted(links) == sorted(f"{name}.html" for name in ROWS)
    assert all((here / "build" / "gallery" / link).exists() for link in links)
    assert main(["page", "no_such_row"]) == 2
    capsys.readouterr()


def test_a_gallery_is_drawn_from_cuts():
    solution = solution_of(ROWS["plain"])
    cut = cut_fabric(solution.fabric, DIRECTIONS[0], solution.fabric.warp.crossed_spacing / 2)
    assert cut_drawing(solution.fabric, cut) in gallery_page([solution]).text
