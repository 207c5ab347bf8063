"""Pictures and ParaView files of deformed cells, looked at by their pixels and by another reader."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import pyvista
from fabrics import table
from meshes import HEIGHT, LENGTH, WIDTH, box, together
from PIL import Image

from fabric_cad.pictures import State, cut_along, draw_cell, draw_deformed, write_series
from fabric_cad.pictures.cell import window_size
from fabric_cad.pictures.limits import limits_of
from fabric_cad.pictures.scene import scale_bar
from fabric_cad.pictures.skin import skin_of
from fabric_cad.simulation.laws import YarnLaw
from fabric_cad.simulation.stress import yarn_stress
from fabric_cad.weave.bodies import Body, Surface, SurfaceKind


@pytest.fixture(scope="module")
def mesh():
    return together(
        box("weft_1", (0, -1.2, 0)),
        box("weft_2", (0, 1.2, 0)),
        box("warp_1", (0, 0, HEIGHT), turn=np.pi / 2),
    )


@pytest.fixture(scope="module")
def displacement(mesh):
    return np.random.default_rng(0).normal(scale=0.02, size=mesh.points.shape) + [0.1, 0.0, 0.0]


def picture(path):
    return np.asarray(Image.open(path).convert("RGB"), dtype=int)


def share(image, wanted):
    """Share of a picture's pixels for which ``wanted(red, green, blue)`` holds."""
    return wanted(*np.moveaxis(image, 2, 0)).mean()


def blue(red, green, blue):
    return blue - red > 40


def orange(red, green, blue):
    return red - blue > 60


def grey(red, green, blue):
    return (np.ptp([red, green, blue], axis=0) < 12) & (red < 235) & (red > 60)


def series(mesh, displacement, folder):
    """Rest and two states, each moved once more, with a point field and a cell field."""
    states = [
        State(
            0.5 * number,
            f"state {number}",
            number * displacement,
            {"pressure_MPa": np.arange(len(mesh.points)) * 1.0 * number},
            {"strain": np.arange(len(mesh.hexahedra)) * -1.0},
            {"E11": 0.001 * number, "row": "three"},
        )
        for number in range(3)
    ]
    write_series(
        mesh, states, folder / "tension.pvd", {"displacement": "mm", "pressure_MPa": "MPa"}
    )
    return states


def test_a_series_holds_every_state_at_its_deformed_points(mesh, displacement, tmp_path):
    states = series(mesh, displacement, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"tension.pvd"} | {
        f"tension_state_{n}.vtu" for n in range(3)
    }
    reader = pyvista.get_reader(tmp_path / "tension.pvd")
    assert reader.time_values == [0.0, 0.5, 1.0]
    for number, (time, state) in enumerate(zip(reader.time_values, states)):
        reader.set_active_time_value(time)
        (grid,) = reader.read()
        assert np.abs(grid.points - (mesh.points + state.displacement)).max() < 1e-15
        assert (grid.point_data["displacement"] == state.displacement).all()
        assert grid.point_data.active_vectors_name == "displacement"
        assert (grid.point_data["pressure_MPa"] == state.point_data["pressure_MPa"]).all()
        assert set(grid.cell_data) == {"yarn", "direction", "fibre_axis", "strain"}
        assert (grid.cell_data["yarn"] == mesh.body + 1).all()
        assert (grid.cell_data["direction"] == (mesh.body == 2)).all()
        facts = {name: grid.field_data[name][0] for name in ("state", "row", "E11", "TimeValue")}
        assert facts == {
            "state": f"state {number}",
            "row": "three",
            "E11": 0.001 * number,
            "TimeValue": time,
        }
        assert list(grid.field_data["yarn_names"]) == [yarn.name for yarn in mesh.yarns]
        assert list(grid.field_data["units"]) == ["displacement: mm", "pressure_MPa: MPa"]


def test_a_series_takes_only_what_fits_the_mesh(mesh, displacement, tmp_path):
    path = tmp_path / "wrong.pvd"
    for wrong, message in (
        ({"displacement": displacement[:, 0]}, r"displacement has shape \(567,\), not \(567, 3\)"),
        (
            {"point_data": {"force": np.zeros((2, 3))}},
            r"point data force has shape \(2, 3\), not \(567, 3\)",
        ),
        (
            {"cell_data": {"strain": np.zeros(567)}},
            r"cell data strain has shape \(567,\), not \(288,\)",
        ),
        ({"cell_data": {"yarn": mesh.body}}, "cell data yarn is written anyway"),
    ):
        state = State(**{"time": 0.0, "label": "", "displacement": displacement} | wrong)
        with pytest.raises(ValueError, match=message):
            write_series(mesh, [state], path, {})
    with pytest.raises(OSError):
        write_series(mesh, [State(0.0, "", displacement)], tmp_path / "nowhere" / "wrong.pvd", {})
    assert not list(tmp_path.iterdir())


def test_stress_of_a_straight_yarn_pulled_and_turned_is_the_closed_form():
    """Stretch L of a yarn with nu = 0: S = E1 (L^2 - 1) / 2 and Cauchy's stress L S, wherever the yarn points."""
    law = YarnLaw(35000.0, 70.0, 70.0, 30.0, 30.0, 30.0, 0.0, 0.0, 0.0, np.inf)
    stretch = 1.01
    green = (stretch**2 - 1) / 2
    for turn in (0.0, 0.7):
        yarn = box("weft_1")
        cosine, sine = np.cos(turn), np.sin(turn)
        rotation = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        moved = (yarn.points * [stretch, 1, 1]) @ rotation.T
        columns = yarn_stress(yarn, moved - yarn.points, law).columns()
        assert columns.pop("strain_fibre") == pytest.approx(green, rel=1e-9)
        assert columns.pop("stress_fibre_MPa") == pytest.approx(35000 * green * stretch, rel=1e-9)
        assert (
            len(columns) == 10 and max(np.abs(values).max() for values in columns.values()) < 1e-8
        )


def test_stress_stays_with_the_fibres_in_simple_shear():
    """Fibres that a shear leaves as long as they were carry nothing: the stress is the soft shear's."""
    law = YarnLaw(35000.0, 70.0, 70.0, 30.0, 30.0, 30.0, 0.0, 0.0, 0.0, np.inf)
    yarn, slope = box("weft_1"), 0.1
    moved = np.zeros_like(yarn.points)
    moved[:, 0] = slope * yarn.points[:, 1]  # F e1 = e1, F e2 = e2 + slope e1
    found = yarn_stress(yarn, moved, law)
    second = np.array([0.0, 70 * slope**2 / 2, 30 * slope])  # S11, S22, S12
    assert found.strain[:, 0, 1] == pytest.approx(slope / 2)
    assert found.stress[:, 1, 1] == pytest.approx(second[1])
    assert found.stress[:, 0, 1] == pytest.approx(second[2] + slope * second[1])
    assert found.stress[:, 0, 0] == pytest.approx(2 * slope * second[2] + slope**2 * second[1])


def test_compaction_presses_on_all_sides():
    law = YarnLaw(35000.0, 70.0, 70.0, 30.0, 30.0, 30.0, 0.0, 0.0, 0.0, 0.1)
    yarn = box("weft_1")
    found = yarn_stress(yarn, yarn.points * [0, 0, -0.2], law)
    pressure = law.hardening * (-0.2) ** 3
    assert found.stress[:, 0, 0] == pytest.approx(pressure)
    assert found.stress[:, 2, 2] == pytest.approx(pressure + 0.8 * 70 * (0.64 - 1) / 2)


def test_a_cut_follows_its_material_points(mesh):
    """Pulled along the wefts and pressed: every outline is the rectangle at rest, and that rectangle deformed."""
    gradient = np.diag([0.02, 0.0, -0.1])
    outlines = cut_along(mesh, mesh.points @ gradient, "weft_2")
    assert sorted(outline.yarn.name for outline in outlines) == ["warp_1", "weft_2"]
    for outline, width, level in zip(
        sorted(outlines, key=lambda each: each.yarn.name), (WIDTH, LENGTH), (HEIGHT, 0.0)
    ):
        low, high = outline.rest.min(axis=0), outline.rest.max(axis=0)
        assert [*low, *high] == pytest.approx(
            [-width / 2, level - HEIGHT / 2, width / 2, level + HEIGHT / 2]
        )
        assert outline.deformed == pytest.approx(outline.rest * [1.02, 0.9])
        assert outline.rest[0] == pytest.approx(outline.rest[-1])
    with pytest.raises(ValueError, match="no yarn is called warp_2"):
        cut_along(mesh, 0 * mesh.points, "warp_2")


def test_only_rims_and_creases_along_a_yarn_are_lines(mesh):
    """A box has four creases of 8 edges and two rims of 16, and six smooth sides; a steep fold across adds none."""
    skin = skin_of(mesh, [Body.named("weft_1")])
    assert len(skin.lines) == 4 * 8 + 2 * 16 and skin.patch.max() + 1 == 6
    points = mesh.points.copy()
    ridge = np.isclose(points[:, 0], 0)
    points[ridge, 2] += 2.0
    folded = skin_of(replace(mesh, points=points), [Body.named("weft_1")])
    assert {tuple(line) for line in folded.lines} == {tuple(line) for line in skin.lines}


@pytest.fixture(scope="module")
def twill(tmp_path_factory):
    """A twill 3*2 with narrow gaps: its floats' edges leap within them."""
    from fabric_cad import build_cell, identify, mesh_cell, mesh_options, read_mesh

    row = {
        "name": "t",
        "over": 3,
        "under": 2,
        "weft_density_per_mm": 0.35,
        "weft_width_mm": 2.4,
        "weft_crimp": 0.004,
    }
    fabric, folder = identify(table("twill", row))["t"], tmp_path_factory.mktemp("twill")
    build_cell(fabric).write_step(folder / "t.step")
    mesh_cell(folder / "t.step", fabric, mesh_options(fabric, across=12), folder / "t.msh")
    return read_mesh(folder / "t.msh")


def test_the_edges_drawn_of_a_twill_run_along_its_yarns_or_around_their_ends(twill):
    lines = skin_of(twill, twill.yarns).lines
    ends = np.zeros(len(twill.points), dtype=bool)
    for surface, quads in twill.surfaces.items():
        ends[quads] |= surface.kind in (SurfaceKind.START, SurfaceKind.END)
    inner = lines[~ends[lines].all(axis=1)]
    along = {
        tuple(sorted(pair))
        for corner in range(4)
        for pair in twill.hexahedra[:, [corner, corner + 4]].tolist()
    }
    assert {tuple(sorted(line)) for line in inner.tolist()} <= along
    # and each yarn's two edges are drawn from end to end
    layers = (
        len(twill.hexahedra)
        // len(twill.yarns)
        // len(twill.surfaces[Surface.named("weft_1_start")])
    )
    assert len(inner) == len(twill.yarns) * 2 * layers


def test_a_picture_has_a_scale_bar_of_round_length_beside_the_cell(mesh, tmp_path):
    bar = scale_bar(mesh.points)
    assert bar.length == 0.5
    assert np.linalg.norm(np.diff(bar.points, axis=0), axis=1) == pytest.approx([0.5, 0.5])
    assert bar.points[:, 0].max() < mesh.points[:, 0].min()
    draw_cell(mesh, tmp_path / "cell.png")
    image = picture(tmp_path / "cell.png")
    draw_cell(mesh, tmp_path / "titled.png", "three yarns")
    titled = picture(tmp_path / "titled.png")
    dark = (image.max(axis=2) < 60) & (np.arange(1600) < 600) & (np.arange(1200) > 800)[:, None]
    assert 300 < dark.sum() < 10000
    assert (image[:70, :400] == 255).all() and (titled[:70, :400].max(axis=2) < 100).any()


@pytest.mark.parametrize(
    "screen", [(1366, 768), (1280, 720), (1920, 1080), (800, 1280), (5120, 2880)]
)
def test_the_window_fits_the_screen(screen):
    width, height = window_size(screen)
    assert width <= 0.8 * screen[0] and height <= 0.8 * screen[1]
    assert width / height == pytest.approx(4 / 3, rel=0.01)
    assert width == 1600 or width > 0.79 * screen[0] or height > 0.79 * screen[1]


@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="no X server to open a window on")
def test_show_opens_a_window_that_fits_a_laptop():
    code = """
import pyvista
from meshes import box
from fabric_cad.pictures import show_cell
sizes = []
wait = pyvista.Plotter.show
def shown(plotter, **options):
    wait(plotter, interactive=False, auto_close=False, **options)
    sizes.append((*plotter.render_window.GetActualSize(), *plotter.render_window.GetScreenSize()))
    plotter.close()
pyvista.Plotter.show = shown
show_cell(box("weft_1"), "box")
print(*sizes[0])
"""
    run = ["xvfb-run", "-a", "-s", "-screen 0 1366x768x24", sys.executable, "-c", code]
    done = subprocess.run(run, capture_output=True, text=True, check=True, env=environment())
    width, height, *screen = map(int, done.stdout.split()[-4:])
    assert screen == [1366, 768] and 600 < width < 1366 and 400 < height < 768


def environment():
    """This process' own, with the tests' helpers to be imported, and a display left to be named."""
    found = {
        name: value for name, value in os.environ.items() if name != "VTK_DEFAULT_OPENGL_WINDOW"
    }
    return found | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}


def test_hidden_yarns_are_not_drawn(mesh, displacement, tmp_path):
    path = tmp_path / "all.png"
    draw_deformed(mesh, displacement, path)
    assert min(share(picture(path), orange), share(picture(path), blue)) > 0.05
    draw_deformed(mesh, displacement, path, hide=("warp_1",))
    assert share(picture(path), orange) > 0.05 and share(picture(path), blue) == 0
    for hide, message in (
        (("warp_2",), "no yarn is called warp_2"),
        ([yarn.name for yarn in mesh.yarns], "no yarn is left"),
    ):
        with pytest.raises(ValueError, match=message):
            draw_deformed(mesh, displacement, path, hide=hide)


def test_the_state_is_named_above_the_picture(mesh, displacement, tmp_path):
    draw_deformed(mesh, displacement, tmp_path / "plain.png", field=mesh.points[:, 0])
    draw_deformed(
        mesh, displacement, tmp_path / "named.png", field=mesh.points[:, 0], title="row: k = 1"
    )
    plain, named = picture(tmp_path / "plain.png"), picture(tmp_path / "named.png")
    assert (plain[:70, :400] == 255).all() and (named[:70, :400] < 100).any()


def test_the_bar_ends_where_the_values_that_are_seen_do(mesh, tmp_path):
    """What the picture hides, here the underside, does not stretch its colours."""
    field = np.where(
        mesh.points[:, 2] > mesh.points[:, 2].max() - 1e-9, mesh.points[:, 1] / 2 + 1, 0.0
    )
    hidden = np.where(mesh.points[:, 2] < mesh.points[:, 2].min() + 1e-9, -100.0, field)
    rest = np.zeros_like(mesh.points)
    for name, values in (("seen", field), ("hidden", hidden)):
        draw_deformed(mesh, rest, tmp_path / f"{name}.png", field=values, hide=("weft_1", "weft_2"))
    seen, other = picture(tmp_path / "seen.png")[:1000], picture(tmp_path / "hidden.png")[:1000]
    assert (np.abs(seen - other).max(axis=2) > 30).mean() < 0.02


def test_colours_of_a_field(mesh, displacement, tmp_path):
    """Signed values are blue to red around 0, all others violet to yellow; grey is what has none."""
    path = tmp_path / "field.png"
    draw_deformed(mesh, 0 * displacement, path, field=mesh.points[:, 0], label="x mm")
    signed = picture(path)
    assert min(share(signed, orange), share(signed, blue)) > 0.05
    some = np.where(mesh.points[:, 1] > 0, 3.0, np.nan)
    draw_deformed(
        mesh, 0 * displacement, path, field=some, label="pressure, MPa", limits=(0.0, 3.0)
    )
    image = picture(path)
    yellow = share(image, lambda red, green, blue: (red > 150) & (green > 130) & (blue < 110))
    assert yellow > 0.05 and share(image, grey) > 0.05
    draw_deformed(mesh, displacement, path, field=np.full(len(mesh.points), np.nan))
    assert share(picture(path), grey) > 0.1
    with pytest.raises(ValueError, match=r"field has shape \(3,\), not \(567,\)"):
        draw_deformed(mesh, displacement, path, field=np.zeros(3))


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((-0.052, 0.03), (-0.06, 0.06, 4)),
        ((-0.001, 0.054), (-0.015, 0.06, 5)),
        ((0.02, 3.0), (0.0, 3.2, 4)),
        ((-0.24, -0.01), (-0.24, 0.0, 4)),
        ((100.0, 104.0), (100.0, 104.0, 4)),
        ((5.0, 5.0), (4.5, 5.5, 4)),
        ((), (-0.5, 0.5, 4)),
    ],
)
def test_ends_of_a_colour_bar_are_round(values, expected):
    assert limits_of(np.array(values)) == pytest.approx(expected)


def test_ends_of_a_colour_bar_hold_every_value():
    rng = np.random.default_rng(3)
    for values in np.exp(rng.normal(scale=5, size=(500, 1))) * rng.normal(size=(500, 4)):
        low, high, steps = limits_of(values)
        assert low <= values.min() + 1e-9 * (high - low) and high >= values.max() - 1e-9 * (
            high - low
        )
        assert 3 <= steps <= 5
