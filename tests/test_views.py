"""Pictures and ParaView files of deformed cells, looked at by their pixels and by another reader."""

import meshio
import numpy as np
import pytest
from meshes import HEIGHT, box, together
from PIL import Image

from fabric_cad.views import _limits, draw_deformed, write_deformed_vtu


@pytest.fixture(scope="module")
def mesh():
    return together(
        box("weft_1", (0, -1.2, 0)), box("weft_2", (0, 1.2, 0)), box("warp_1", (0, 0, HEIGHT), turn=np.pi / 2)
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


def test_vtu_holds_the_initial_mesh_and_what_warps_it(mesh, displacement, tmp_path):
    points = {"pressure_MPa": np.arange(len(mesh.points)) * 1.0, "stress": np.ones((len(mesh.points), 6))}
    cells = {"transverse_strain": np.arange(len(mesh.hexahedra)) * -1.0}
    write_deformed_vtu(mesh, displacement, points, cells, tmp_path / "tension.vtu")
    found = meshio.read(tmp_path / "tension.vtu")
    assert (found.points == mesh.points).all() and (found.cells[0].data == mesh.hexahedra).all()
    assert set(found.point_data) == {"displacement", "pressure_MPa", "stress"}
    assert (found.point_data["displacement"] == displacement).all()
    assert (found.point_data["pressure_MPa"] == points["pressure_MPa"]).all()
    assert set(found.cell_data) == {"yarn", "direction", "transverse_strain"}
    assert (found.cell_data["transverse_strain"][0] == cells["transverse_strain"]).all()
    assert (found.cell_data["yarn"][0] == mesh.yarn + 1).all()
    assert (found.cell_data["direction"][0] == (mesh.yarn == 2)).all()


def test_vtu_takes_only_what_fits_the_mesh(mesh, displacement, tmp_path):
    path = tmp_path / "wrong.vtu"
    with pytest.raises(ValueError, match=r"displacement has shape \(567,\), not \(567, 3\)"):
        write_deformed_vtu(mesh, displacement[:, 0], {}, {}, path)
    with pytest.raises(ValueError, match=r"point data force has shape \(2, 3\), not \(567, 3\)"):
        write_deformed_vtu(mesh, displacement, {"force": np.zeros((2, 3))}, {}, path)
    with pytest.raises(ValueError, match=r"cell data strain has shape \(567,\), not \(288,\)"):
        write_deformed_vtu(mesh, displacement, {}, {"strain": np.zeros(567)}, path)
    with pytest.raises(ValueError, match="cell data yarn is written anyway"):
        write_deformed_vtu(mesh, displacement, {}, {"yarn": mesh.yarn}, path)
    with pytest.raises(OSError):
        write_deformed_vtu(mesh, displacement, {}, {}, tmp_path / "nowhere" / "wrong.vtu")
    assert not path.exists()


def test_hidden_yarns_are_not_drawn(mesh, displacement, tmp_path):
    path = tmp_path / "all.png"
    draw_deformed(mesh, displacement, path)
    assert min(share(picture(path), orange), share(picture(path), blue)) > 0.05
    draw_deformed(mesh, displacement, path, hide=("warp_1",))
    assert share(picture(path), orange) > 0.05 and share(picture(path), blue) == 0
    for hide, message in ((("warp_2",), "no yarn is called warp_2"), (mesh.yarns, "no yarn is left")):
        with pytest.raises(ValueError, match=message):
            draw_deformed(mesh, displacement, path, hide=hide)


def test_initial_and_tensed_cell_are_grey_and_the_scale_is_told(mesh, displacement, tmp_path):
    draw_deformed(mesh, displacement, tmp_path / "one.png", initial=True)
    draw_deformed(mesh, displacement, tmp_path / "ten.png", initial=True, scale=10.0)
    one, ten = picture(tmp_path / "one.png"), picture(tmp_path / "ten.png")
    for image in (one, ten):
        assert share(image, grey) > 0.05 and share(image, orange) == share(image, blue) == 0
    assert (one[:100, :600] == 255).all() and (ten[:100, :600] < 100).any()


def test_colours_of_a_field(mesh, displacement, tmp_path):
    """Signed values are blue to red around 0, all others violet to yellow; grey is what has none."""
    path = tmp_path / "field.png"
    draw_deformed(mesh, 0 * displacement, path, field=mesh.points[:, 0], label="x mm")
    signed = picture(path)
    assert min(share(signed, orange), share(signed, blue)) > 0.05
    some = np.where(mesh.points[:, 1] > 0, 3.0, np.nan)
    draw_deformed(mesh, 0 * displacement, path, field=some, label="pressure, MPa", limits=(0.0, 3.0))
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
    assert _limits(np.array(values)) == pytest.approx(expected)


def test_ends_of_a_colour_bar_hold_every_value():
    rng = np.random.default_rng(3)
    for values in np.exp(rng.normal(scale=5, size=(500, 1))) * rng.normal(size=(500, 4)):
        low, high, steps = _limits(values)
        assert low <= values.min() + 1e-9 * (high - low) and high >= values.max() - 1e-9 * (high - low)
        assert 3 <= steps <= 5
