"""The models compared: identities of each, and what they do to the same fabric."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from fabrics import TWILL32, UNBALANCED, random_row, table
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import fabric_cad
from fabric_cad.comparison import MODELS, TOLERANCE, Model, compare, comparison_table, measure
from fabric_cad.comparison.crossings import crossings, facing
from fabric_cad.comparison.measures import yarn_volume
from fabric_cad.comparison.models import constant_section
from fabric_cad.comparison.profiles import elliptic, lens_radius, lenticular
from fabric_cad.comparison.trajectories import circular, sinusoidal, straight_bars
from fabric_cad.model.identification import identify
from fabric_cad.pictures.plots import plot_gap_maps, plot_model_cuts
from fabric_cad.support.errors import BuildError, InputError
from fabric_cad.weave.weaves import yarns_of

seeds = st.integers(0, 2**32 - 1)
CRITICISED, PRESENT = MODELS[:-1], MODELS[-1]
TRAJECTORIES = (sinusoidal, circular, straight_bars)
PLAIN = {"name": "plain", "weft_density_per_mm": 0.22, "weft_width_mm": 3.2, "weft_crimp": 0.004}


@pytest.fixture(autouse=True)
def _no_window(monkeypatch):
    monkeypatch.setattr(plt, "show", lambda: None)
    plt.switch_backend("agg")


@pytest.fixture(scope="module")
def twill():
    return identify(table("twill", TWILL32))["twill32"]


@pytest.fixture(scope="module")
def plain():
    return identify(table("plain", PLAIN))["plain"]


@pytest.fixture(scope="module")
def unbalanced():
    return identify(table("plain", UNBALANCED | {"fabric_thickness_mm": 0.75}))["unbalanced"]


def fabric_of(seed):
    family, row = random_row(np.random.default_rng(seed))
    try:
        return identify(table(family, row))[row["name"]]
    except InputError:
        assume(False)


@given(seeds)
@settings(max_examples=25, deadline=None)
def test_the_present_model_touches_everywhere_and_penetrates_nowhere(seed):
    fabric = fabric_of(seed)
    found = measure(fabric, PRESENT, points=24)
    rounding = 1e-13 * max(fabric.fabric_thickness, 1)
    assert found.max_penetration < rounding
    assert found.mean_void < rounding
    assert found.contact_percent == pytest.approx(100, abs=1e-9)
    assert found.crossing_area == pytest.approx(
        fabric.weave.wefts * fabric.weave.warps * fabric.weft.width * fabric.warp.width
    )


@given(seeds)
@settings(max_examples=25, deadline=None)
def test_every_model_touches_at_the_centre_of_every_crossing(seed):
    fabric = fabric_of(seed)
    for model in MODELS:
        for weft, warp in crossings(fabric):
            try:
                gap = facing(fabric, model, (weft, warp), np.zeros(1), np.zeros(1)).gap
            except BuildError:
                assert model.title.startswith("circular")
                break
            assert abs(gap[0, 0]) < 1e-12 * max(fabric.fabric_thickness, 1)


@pytest.mark.parametrize("fall", TRAJECTORIES, ids=lambda fall: fall.__name__)
def test_a_trajectory_rises_by_the_amplitude(fall, twill, unbalanced):
    for fabric in (twill, unbalanced):
        for solved, crossed in ((fabric.weft, fabric.warp), (fabric.warp, fabric.weft)):
            ends = fall(np.array([0.0, solved.crossed_spacing / 2]), solved, crossed)
            assert ends == pytest.approx([0.0, solved.amplitude / 2], abs=1e-14)


@pytest.mark.parametrize("fall", (sinusoidal, circular), ids=lambda fall: fall.__name__)
def test_a_curved_trajectory_has_tangents(fall, unbalanced):
    solved, crossed = unbalanced.weft, unbalanced.warp
    u = np.linspace(0, solved.crossed_spacing / 2, 20001)
    slopes = np.diff(fall(u, solved, crossed)) / np.diff(u)
    assert slopes[0] == pytest.approx(0, abs=1e-4)
    assert np.max(np.abs(np.diff(slopes))) < 1e-4


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.title)
def test_yarns_are_closed_and_periodic(model, twill):
    for yarn in yarns_of(twill.weave.interlacement()):
        solved = twill.directions[yarn.direction]
        edge = np.array([-0.5, 0.0, 0.5]) * solved.width
        t = np.linspace(0, len(yarn.high) * solved.crossed_spacing, 2001)
        bottom, top = model.heights(twill, yarn, t, edge)
        assert top[:, 1] - bottom[:, 1] == pytest.approx(
            solved.thickness, abs=3e-2 * solved.thickness
        )
        assert top[:, ::2] == pytest.approx(bottom[:, ::2], abs=1e-9)
        assert top[0] == pytest.approx(top[-1], abs=1e-12)
        assert np.max(np.abs(np.diff(top, axis=0))) < 0.05 * solved.thickness  # no jumps


def section_area(section, solved):
    b, c = solved.thickness, solved.width
    if section is elliptic:
        return np.pi * b * c / 4
    radius = lens_radius(solved)
    return 2 * (
        radius**2 * np.arcsin(c / (2 * radius)) - c / 2 * (radius - b / 2)
    )  # two circular segments


@pytest.mark.parametrize("section", (elliptic, lenticular), ids=lambda section: section.__name__)
@pytest.mark.parametrize("fall", (lambda u, *_: 0 * u, sinusoidal), ids=("straight", "sinusoidal"))
def test_a_yarns_volume_is_its_section_times_its_projected_length(section, fall, unbalanced):
    model = Model("", constant_section(fall, section))
    x, y = unbalanced.period
    wefts, warps = unbalanced.weave.wefts, unbalanced.weave.warps
    expected = wefts * x * section_area(section, unbalanced.weft) + warps * y * section_area(
        section, unbalanced.warp
    )
    assert yarn_volume(unbalanced, model) == pytest.approx(expected, rel=1e-11)


def test_two_straight_lenses_touch_at_one_point(plain):
    model = Model("straight", constant_section(lambda u, *_: 0 * u, lenticular))
    weft, warp = next(crossings(plain))
    v = np.linspace(-0.5, 0.5, 41) * plain.weft.width
    gap = facing(plain, model, (weft, warp), v, v).gap
    assert gap[20, 20] == pytest.approx(0, abs=1e-15)
    assert np.count_nonzero(gap < 1e-6) == 1
    found = measure(plain, model)
    assert found.overlap_volume < 1e-15
    # near the point the gap is (v^2 + u^2) / (2 R): within the tolerance on a disc of area 2 pi R tolerance
    disc = 2 * np.pi * lens_radius(plain.weft) * found.tolerance
    assert found.contact_area == pytest.approx(4 * disc, rel=0.02)


def test_yarns_in_one_plane_overlap_in_steinmetz_solids(plain):
    # two elliptic cylinders at right angles share 16/3 r^3 (Steinmetz), scaled by b / c in height
    model = Model(
        "in one plane",
        constant_section(lambda u, solved, _: solved.amplitude / 2 + 0 * u, elliptic),
    )
    b, c = plain.weft.thickness, plain.weft.width
    found = measure(plain, model)
    assert found.overlap_volume == pytest.approx(4 * 16 / 3 * (c / 2) ** 2 * b / 2, rel=1e-3)
    assert found.max_penetration == pytest.approx(b, rel=1e-3)


def test_bars_penetrate_as_deep_as_a_chord_cuts_an_ellipse(plain):
    # over one half width: A u / a - b/2 (1 - sqrt(1 - (2 u / c)^2)) is largest where the ellipse has the bar's
    # slope; both yarns of a crossing in a plain weave do so at once
    a, b, c, rise = (
        plain.weft.crossed_spacing,
        plain.weft.thickness,
        plain.weft.width,
        plain.weft.amplitude,
    )
    steep = rise / a * c / b
    u = c / 2 * steep / np.sqrt(1 + steep**2)
    deepest = 2 * (rise * u / a - b / 2 * (1 - np.sqrt(1 - (2 * u / c) ** 2)))
    assert measure(plain, MODELS[4]).max_penetration == pytest.approx(deepest, rel=1e-4)


def test_an_arc_of_the_lens_radius_touches_the_lens_along_the_arc(plain):
    weft, warp = next(crossings(plain))
    v = np.linspace(-0.1, 0.1, 21) * plain.warp.width
    gap = facing(plain, MODELS[3], (weft, warp), v, v).gap
    assert np.max(np.abs(gap)) < 1e-13


@pytest.mark.parametrize("model", CRITICISED, ids=lambda model: model.title)
def test_a_constant_section_penetrates_or_leaves_voids(model, twill):
    found = measure(twill, model)
    assert found.overlap_percent > 0.5 or found.mean_void > 0.1 * twill.weft.thickness
    assert (
        found.mean_void > 0.05 * twill.weft.thickness
    )  # no section is flat where the crossed yarn floats
    assert found.contact_percent < 20


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.title)
@pytest.mark.parametrize("weave", ("twill", "plain", "unbalanced"))
def test_the_grid_is_fine_enough(model, weave, request):
    fabric = request.getfixturevalue(weave)
    usual, fine = measure(fabric, model), measure(fabric, model, points=768)
    small = 1e-6 * fabric.fabric_thickness
    assert usual.max_penetration == pytest.approx(fine.max_penetration, rel=2e-3, abs=small)
    for name in ("overlap_volume", "void_volume"):
        assert getattr(usual, name) == pytest.approx(
            getattr(fine, name), rel=1e-3, abs=small * fine.crossing_area
        )
    assert usual.contact_percent == pytest.approx(fine.contact_percent, abs=1.0)


def test_what_cannot_be_made_is_refused_with_its_numbers(twill):
    steep = replace(twill, weft=replace(twill.weft, amplitude=1.2))
    with pytest.raises(
        BuildError, match=r"cannot rise by 1\.2 mm over a spacing of 2\.857 mm.*have room for 0\.5"
    ):
        measure(steep, MODELS[2])
    thick = replace(twill, warp=replace(twill.warp, thickness=2.5))
    with pytest.raises(BuildError, match=r"no lens is 2\.5 mm thick and 2\.4 mm wide"):
        measure(thick, MODELS[1])


def test_the_tolerance_is_of_the_thinner_yarn(unbalanced):
    found = measure(unbalanced, PRESENT, points=8)
    assert found.tolerance == TOLERANCE * min(unbalanced.weft.thickness, unbalanced.warp.thickness)
    assert measure(unbalanced, MODELS[0], tolerance=1.0).contact_percent == pytest.approx(100)


def test_the_table_has_a_line_for_every_model(twill):
    results = compare(twill, points=16)
    lines = comparison_table(results).splitlines()
    assert (
        [line[:24].strip() for line in lines[2:]]
        == [each.model for each in results]
        == [m.title for m in MODELS]
    )
    assert len({len(line) for line in lines}) == 1


def test_the_pictures_are_drawn(twill):
    figure, axes = plt.subplots(len(MODELS), 2)
    plot_model_cuts(twill, axes[:, 0], "warp", 2)
    assert plot_gap_maps(twill, axes[:, 1]).get_clim() == pytest.approx(
        (-twill.weft.thickness / 4, twill.weft.thickness / 4)
    )
    assert [ax.get_title() for ax in axes[:, 1]] == [model.title for model in MODELS]
    plt.close(figure)


def test_comparing_loads_no_cad_and_no_pictures():
    absent = ("cadquery", "OCP", "gmsh", "scipy", "matplotlib")
    code = f"import sys, fabric_cad.comparison; print([name for name in {absent!r} if name in sys.modules])"
    place = Path(fabric_cad.__file__).parents[1]
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=place, check=True
    )
    assert done.stdout.strip() == "[]"
