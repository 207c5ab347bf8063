"""Element quality: VTK's figures to the last digits, what each figure misses, and round sections as good as can be."""

import numpy as np
import pytest
from closed_meshes import closed_quality, general_fabric
from meshes import box

from fabric_cad.meshing.options import mesh_options
from fabric_cad.meshing.quality import hexahedra_quality, mesh_quality
from fabric_cad.yarn.edges import allowed_scaled_jacobian

CUBE = np.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    dtype=float,
)


def prism(*section, length=1.0):
    """The hexahedron over four points (v, z), counter-clockwise, along the third axis; its quality."""
    end = np.column_stack([np.array(section, dtype=float), np.zeros(4)])
    return hexahedra_quality(np.vstack([end, end + [0, 0, length]]), np.arange(8)[None])


def test_scaled_jacobian_and_aspect_are_those_of_verdict_in_vtk():
    import pyvista

    rng = np.random.default_rng(9)
    mesh = box("weft_1", parts=(40, 30, 20))  # more than one chunk
    points = mesh.points * [1, 1, 0.2] + rng.normal(0, 0.008, mesh.points.shape)
    ours = hexahedra_quality(points, mesh.hexahedra)
    grid = pyvista.UnstructuredGrid({pyvista.CellType.HEXAHEDRON: mesh.hexahedra}, points)
    for name, values in (
        ("scaled_jacobian", ours.scaled_jacobian),
        ("max_edge_ratio", ours.aspect),
    ):
        assert values == pytest.approx(grid.cell_quality(name).cell_data[name], rel=1e-9, abs=1e-12)
    assert ours.scaled_jacobian.min() < 0 < ours.scaled_jacobian.max()  # folded cells too


def test_figures_do_not_change_where_a_cell_is_moved_turned_scaled_or_numbered_otherwise():
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(3)
    points = CUBE + rng.normal(0, 0.1, CUBE.shape)
    turned = Rotation.from_euler("xyz", [0.3, 1.0, 2.0]).apply(points) * 7 + [1, 2, 3]
    around = [1, 2, 3, 0, 5, 6, 7, 4]
    one = hexahedra_quality(points, np.arange(8)[None])
    for other in (
        hexahedra_quality(turned, np.arange(8)[None]),
        hexahedra_quality(points, np.array([around])),
    ):
        for name, values in vars(one).items():
            assert vars(other)[name] == pytest.approx(values), name


def test_a_brick_has_aspect_and_no_fault():
    thin = prism((0, 0), (1, 0), (1, 0.01), (0, 0.01))
    assert thin.scaled_jacobian == pytest.approx(1) and thin.opposite_edge_ratio == pytest.approx(1)
    assert thin.least_angle == pytest.approx(90) and thin.greatest_angle == pytest.approx(90)
    assert thin.aspect == pytest.approx(100)


def test_a_collapsed_flat_side_is_seen():
    """0.00015 mm beside 0.15 mm: upright corners, which the scaled Jacobian takes for good."""
    side, far = 0.00015, 0.15
    collapsed = prism((0, -far / 2), (0.2, -side / 2), (0.2, side / 2), (0, far / 2), length=0.2)
    assert collapsed.scaled_jacobian > 0.9 and collapsed.least_angle > 60
    assert collapsed.opposite_edge_ratio == pytest.approx(side / far)


def test_a_flat_sliver_is_seen():
    """The tip of a thin lens: its edges are of like lengths, its corner is one of a degree."""
    half = np.radians(1.0) / 2
    sliver = prism((0, 0), (1, -np.tan(half)), (4 / 3, 0), (1, np.tan(half)))
    assert sliver.opposite_edge_ratio > 0.3 and sliver.aspect < 2
    assert sliver.scaled_jacobian == pytest.approx(np.sin(2 * half), rel=1e-6)
    assert sliver.least_angle == pytest.approx(1.0)


def test_an_edge_without_length_is_no_good_element():
    """VTK calls it 1e30."""
    points = CUBE.copy()
    points[6] = points[2]
    for found in (
        hexahedra_quality(points, np.arange(8)[None]),
        prism((0, 0), (1, 0), (1, 0), (0, 1)),
    ):
        assert (
            found.scaled_jacobian == 0 and found.opposite_edge_ratio == 0 and found.least_angle == 0
        )


def test_quality_of_a_mesh_is_that_of_its_hexahedra():
    found = mesh_quality(box("weft_1"))
    assert found.scaled_jacobian == pytest.approx(1) and found.aspect == pytest.approx(2)


@pytest.mark.parametrize("seed", [18, 31, 132, 138, 139, 183])
def test_round_sections_are_as_good_as_their_edges_allow(seed):
    """Thick yarns and narrow gaps of ``make stability``, once at 0.03 to 0.08."""
    fabric = general_fabric(seed)
    assert fabric.section == "round"
    allowed = allowed_scaled_jacobian(fabric)
    found = closed_quality(fabric)
    assert found.scaled_jacobian.min() >= min(0.3, 0.9 * allowed)
    assert found.opposite_edge_ratio.min() > 0.01


@pytest.mark.parametrize(
    "asked", [{"across": 24, "through": 8}, {"gap": 12}, {"across": 6}, {"size": 0.05}]
)
def test_round_sections_at_other_sizes(asked):
    fabric = general_fabric(87)
    found = closed_quality(fabric, mesh_options(fabric, **asked))
    assert found.scaled_jacobian.min() >= min(0.3, 0.9 * allowed_scaled_jacobian(fabric))
