"""Between two crossings of one float: what column ``float_gap`` changes, and what it must not."""

from dataclasses import replace

import numpy as np
import pytest
from fabrics import (
    TWILL32,
    UNBALANCED,
    flat_gaps,
    random_general_row,
    random_pattern_row,
    random_row,
    section_area,
    skin_of,
    table,
)
from hypothesis import given, settings
from matplotlib.figure import Figure
from scipy.interpolate import BSpline
from sweeps import fabric_of, patch_of, points, seeds

from fabric_cad.cell.pipeline import make_cell
from fabric_cad.measured.tables import FLOAT_GAPS
from fabric_cad.model.identification import identify, identify_rows
from fabric_cad.model.solved import read_solved
from fabric_cad.pictures.plots import plot_edges
from fabric_cad.support.errors import InputError
from fabric_cad.weave.weaves import yarns_of
from fabric_cad.yarn.planes import control_planes
from fabric_cad.yarn.swept import SweptYarn
from fabric_cad.yarn.volumes import yarn_volumes

FORMS = {
    "lenticular": {"weft_contact_top_mm": 2.3, "weft_offset_bottom_mm": 0.1},
    "flat": {"section": "flat", "lateral_height_mm": 0.03},
    "round": {"section": "round", "weft_contact_top_mm": 2.35, "weft_contact_bottom_mm": 2.3},
}


def flat_twill(**cells):
    return table("twill", TWILL32 | {"over": 2, "under": 1, "float_gap": "flat"} | cells)


def edge_height(surface, path, segment, edge, level, share):
    """Height of an edge of a yarn above its midline, mm, at shares of a segment."""
    sides = {patch.side for patch in surface.patches}
    side = f"{edge}_{level}"
    if side not in sides:
        side = {"lower": "bottom", "upper": "top"}[level]
    t, _, z = points(patch_of(surface, segment, side), share, [0.0 if edge == "left" else 1.0])[
        :, 0
    ].T
    piece = path.pieces[segment]
    return z - BSpline(piece.knots, piece.poles, piece.degree)(t)


def float_half_gaps(yarn, planes):
    """(segment, crossing) of the halves of gaps between two crossings of one float."""
    segments = [*zip(range(len(planes) - 1), planes, planes[1:])]
    for segment, before, after in segments:
        if before.crossing is None and yarn.floats_on[after.crossing]:
            yield segment, after.crossing
        if after.crossing is None and yarn.floats_on[(before.crossing + 1) % len(yarn.high)]:
            yield segment, before.crossing


DRAWS = {"standard": random_row, "general": random_general_row, "pattern": random_pattern_row}


@pytest.mark.parametrize("draw", DRAWS.values(), ids=DRAWS)
@given(seed=seeds)
@settings(max_examples=15, deadline=None)
def test_edges_run_straight_where_the_crossed_yarn_floats_on(draw, seed):
    """Where it turns instead, the edge comes down from the contact's rise, and nowhere rises again."""
    fabric = fabric_of(flat_gaps(draw), seed)
    share = np.linspace(0.0, 1.0, 9)
    yarns = yarns_of(fabric.weave.interlacement())
    for yarn in (yarns[0], yarns[-1]):
        swept = SweptYarn(fabric, yarn)
        planes, path, surface = swept.planes, swept.trajectory, swept.skin
        for segment, crossing in float_half_gaps(yarn, planes):
            # heights from the side that is touched
            touched, sign = ("lower", 1) if yarn.high[crossing] else ("upper", -1)
            for edge, turns in (("left", yarn.turns_left), ("right", yarn.turns_right)):
                found = sign * edge_height(surface, path, segment, edge, touched, share)
                floor = found[0 if planes[segment].crossing is None else -1]  # mid-gap
                if fabric.section != "round":
                    assert floor == pytest.approx(
                        -fabric.directions[yarn.direction].thickness / 2, rel=1e-12
                    )
                if turns[crossing]:
                    outwards = found if planes[segment].crossing is None else found[::-1]
                    assert (np.diff(outwards) > -1e-12).all()
                else:
                    np.testing.assert_allclose(found, floor, rtol=0, atol=1e-12)


@pytest.mark.parametrize("draw", DRAWS.values(), ids=DRAWS)
@given(seed=seeds)
@settings(max_examples=15, deadline=None)
def test_nothing_else_changes(draw, seed):
    """Crossings and the gaps in which a yarn changes sides are the same poles; the paper's section is the default."""
    fabrics = {
        gap: fabric_of(lambda rng, gap=gap: with_gap(draw(rng), gap), seed)
        for gap in ("", *FLOAT_GAPS)
    }
    assert fabrics[""] == fabrics["symmetric"] and fabrics["symmetric"] != fabrics["flat"]
    for yarn in yarns_of(fabrics["flat"].weave.interlacement())[:2]:
        first, second = (skin_of(fabrics[gap], yarn).patches for gap in FLOAT_GAPS)
        inside = {
            segment for segment, _ in float_half_gaps(yarn, control_planes(fabrics["flat"], yarn))
        }
        changed = {
            a.segment
            for a, b in zip(first, second, strict=True)
            if a.poles.tobytes() != b.poles.tobytes()
        }
        assert changed == inside


def with_gap(drawn, gap):
    family, row = drawn
    return family, row | {"float_gap": gap}


def test_mid_gap_stands_the_section_of_a_flat_contact():
    fabric = identify(flat_twill(over=3, under=2))["twill32"]
    yarn = yarns_of(fabric.weave.interlacement())[0]  # over warps 1, 2, 3, under 4, 5
    swept = SweptYarn(fabric, yarn)
    planes, sections = swept.planes, swept.sections
    in_gaps = [section for plane, section in zip(planes, sections) if plane.crossing is None]
    assert (
        in_gaps[0] is in_gaps[3] is in_gaps[5]
    )  # two changes of side, at the cut and after warp 3
    assert in_gaps[1] is in_gaps[2] and in_gaps[4] not in (in_gaps[0], in_gaps[1])
    assert in_gaps[1] is next(
        s for plane, s in zip(planes, sections) if plane.crossing == 1
    )  # warp 2 floats on
    low, high = -fabric.weft.thickness / 2, fabric.weft.thickness / 2
    assert (in_gaps[1].strips["bottom"].poles[:, 1] == low).all()
    assert (in_gaps[4].strips["top"].poles[:, 1] == high).all()


def test_a_plain_weave_has_no_floats():
    fabrics = [
        identify(table("plain", UNBALANCED | {"weft_thickness_mm": 0.3, "float_gap": gap}))[
            "unbalanced"
        ]
        for gap in FLOAT_GAPS
    ]
    for yarn in yarns_of(fabrics[0].weave.interlacement()):
        first, second = (
            [patch.poles.tobytes() for patch in skin_of(fabric, yarn).patches] for fabric in fabrics
        )
        assert first == second


@pytest.fixture(scope="module", params=FORMS)
def made(request, tmp_path_factory):
    """(row, its folder, its report) of a twill 2*1 with flat float gaps, coarsely meshed."""
    out, row = tmp_path_factory.mktemp("cells"), flat_twill(**FORMS[request.param])
    return row, out / "twill32", make_cell(row, out, {"across": 8, "gap": 2})


def test_solids_touch_and_do_not_penetrate(made):
    _, folder, report = made
    assert report["float_gap"] == "flat"
    assert read_solved(folder / "solved.csv").float_gap == "flat"
    consistency = report["consistency"]
    for name in ("max_penetration_mm", "max_contact_gap_mm", "overlap_volume_mm3"):
        assert consistency[name] <= 1e-12
    least = 9 * np.prod([shortest_chord(made[0], d) for d in ("weft", "warp")])
    assert consistency["contact_area_mm2"] > least


def shortest_chord(row, direction):
    """The shortest contact chord of a direction, mm."""
    fabric = identify(row)["twill32"]
    return 2 * min(side.half_chord for side in fabric.directions[direction].contact.values())


def test_meshes_pair_and_reach_what_the_edges_allow(made):
    mesh = made[2]["mesh"]
    assert mesh["other_elements"] == 0
    assert mesh["contact_nodes"] == mesh["coincident_contact_nodes"] > 0
    assert mesh["end_nodes"] == mesh["matching_end_nodes"] > 0
    assert mesh["min_scaled_jacobian"] >= min(0.25, 0.9 * mesh["scaled_jacobian_edges_allow"])


def test_volumes_are_those_of_the_solids(made):
    """Pointed and flat sections have the volume of symmetric gaps too: both sections between crossings are as large."""
    from fabric_cad.cad import read_step

    row, folder, report = made
    solids = read_step(folder / "twill32.step")
    if row.sections[0] == "round":
        fabric = identify(row)["twill32"]
        for yarn in yarns_of(fabric.weave.interlacement()):
            swept = SweptYarn(fabric, yarn)
            areas = [section_area(section) for section in swept.sections]
            lengths = np.diff([plane.place for plane in swept.planes])
            expected = float(lengths @ np.add(areas[1:], areas[:-1])) / 2
            # rational sections do not blend linearly, their weights being close but not the same
            assert solids[yarn.name].Volume(1e-9) == pytest.approx(expected, rel=1e-3)
        return
    table_of_one = identify_rows(row)
    for direction, volume in yarn_volumes(table_of_one.columns, row.weaves).items():
        measured = sum(
            solid.Volume(1e-9) for name, solid in solids.items() if name.startswith(direction)
        )
        assert volume[0] == pytest.approx(measured, rel=1e-9)
    paper = identify_rows(replace(row, float_gaps=("symmetric",)))
    assert report["volumes"]["yarn_mm3"] == pytest.approx(
        sum(float(volume[0]) for volume in yarn_volumes(paper.columns, row.weaves).values()),
        rel=1e-9,
    )


def test_the_column_is_read_and_told(tmp_path):
    assert flat_twill(float_gap="").float_gaps == ("symmetric",)
    with pytest.raises(InputError, match="float_gap: 'flatt' is none of symmetric, flat"):
        flat_twill(float_gap="flatt")
    identify(flat_twill()).write(tmp_path / "solved.csv")
    text = (tmp_path / "solved.csv").read_text()
    assert text.splitlines()[0].split(",")[7:9] == ["lateral_height_mm", "float_gap"]
    (tmp_path / "wrong.csv").write_text(text.replace(",flat,", ",flatt,"))
    with pytest.raises(InputError, match="'flatt' is none of symmetric, flat"):
        read_solved(tmp_path / "wrong.csv")
    without = [
        ",".join(cell for k, cell in enumerate(line.split(",")) if k != 8)
        for line in text.splitlines()
    ]
    (tmp_path / "before.csv").write_text("\n".join(without))
    assert read_solved(tmp_path / "before.csv").float_gap == "symmetric"


def test_the_picture_of_the_edges():
    spans = []
    for gap in FLOAT_GAPS:
        fabric = identify(flat_twill(over=1, under=4, float_gap=gap))["twill32"]
        axes = Figure().subplots()
        plot_edges(fabric, axes, "weft", 1)
        x, midline, left, right = (
            axes.lines[0].get_xdata(),
            *(line.get_ydata() for line in axes.lines),
        )
        assert [line.get_label() for line in axes.lines] == ["midline", "left edge", "right edge"]
        grey = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in axes.patches]
        spacing, half = (
            fabric.weft.crossed_spacing,
            (fabric.weft.crossed_spacing - fabric.warp.width) / 2,
        )
        middles = np.array([2, 3, 4]) * spacing  # weft 1 passes over warp 1, and under the others
        assert np.array(grey) == pytest.approx(np.column_stack([middles - half, middles + half]))
        inside = np.any([(x >= low) & (x <= high) for low, high in grey], axis=0)
        spans.append(np.maximum(left - midline, right - midline)[inside])
    thickness = fabric.weft.thickness
    assert spans[0].min() == pytest.approx(
        0, abs=1e-3 * thickness
    )  # mid-height, in the middle of a gap
    assert spans[1] == pytest.approx(
        thickness / 2
    )  # one edge or the other stays on the float's side
