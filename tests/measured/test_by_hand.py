"""Fabrics and meshes in a script: a fabric from numbers, a mesh for other libraries."""

import sys

import numpy as np
import pytest
from meshes import mesh_named

import fabric_cad
from fabric_cad import ArgumentError, InputError, identify, measured_fabric
from fabric_cad.measured.tables import MEASURED

MINE = {
    "over": 2,
    "under": 2,
    "weft_density_per_mm": 0.35,
    "weft_width_mm": 2.4,
    "weft_crimp_percent": 0.4,
}


def test_a_fabric_from_numbers_is_the_row_of_a_table(here):
    table = measured_fabric("twill", name="twill22", **MINE)
    row = fabric_cad.read_family("families/twill.csv")["twill22"]
    for column in MEASURED:
        assert np.array_equal(table.measured[column], row.measured[column], equal_nan=True)
    assert identify(table).columns == identify(row).columns
    assert table.names == ("twill22",) and table.path is None and len(table) == 1


@pytest.mark.parametrize(
    ("family", "cells"),
    [
        ("plain", {}),
        ("satin", {"harness": np.int64(8), "step": 3}),
        ("pattern", {"pattern": "oouu/oouu/uuoo/uuoo"}),
        ("pattern", {"pattern": ["oouu", "oouu", "uuoo", "uuoo"]}),
    ],
)
def test_every_family_and_kind_of_number(family, cells):
    measured = {"weft_density_per_cm": 3, "weft_width_mm": np.float32(2.5), "weft_crimp": None}
    table = measured_fabric(
        family, **cells, **measured, weft_thickness_mm=0.3, weft_thickness_mm_std=0.01
    )
    assert table.names == ("fabric",) and table.measured["weft_density_per_mm"][0] == pytest.approx(
        0.3
    )
    assert (
        len(identify(table)) == 1 and fabric_cad.propagate(table).std["fabric_thickness_mm"][0] > 0
    )


@pytest.mark.parametrize(
    ("cells", "expected"),
    [
        (
            {"weft_width_mm": 2.9},
            "weft_width_mm: 2.9 is not below the weft spacing 2.857 mm (row mine)",
        ),
        ({"weft_crimp_percent": -1}, "weft_crimp_percent: -1.0 is not above 0 (row mine)"),
        (
            {"weft_crimp_percent": float("nan")},
            "weft_crimp_percent: 'nan' is not a number (row mine)",
        ),
        ({"weft_width_mm": None}, "weft_width_mm: this cell is empty (row mine)"),
        ({"over": 0}, "over: 0 is not between 1 and 100 (row mine)"),
        ({"over": None}, "over: this cell is empty (row mine)"),
        ({"section": "oval"}, "section: 'oval' is none of lenticular, flat, round (row mine)"),
        ({"name": "a b"}, "name: 'a b' is no safe file name"),
    ],
)
def test_the_rules_of_the_tables_hold(cells, expected):
    with pytest.raises(InputError) as refused:
        measured_fabric("twill", **{"name": "mine"} | MINE | cells)
    (problem,) = refused.value.problems
    assert str(problem).startswith(expected)


@pytest.mark.parametrize(
    ("family", "cells", "expected"),
    [
        ("twil", {}, "family: 'twil' is none of plain, twill, satin, pattern; did you mean twill?"),
        (
            "twill",
            {"weft_widht_mm": 1},
            "weft_widht_mm: unknown column of the twill table; did you mean weft_width_mm?",
        ),
        ("twill", {"harness": 5}, "harness: unknown column of the twill table"),
        ("twill", {"weft_width_mm": "2.4"}, "weft_width_mm: expected a number, got str '2.4'"),
        ("twill", {"weft_width_mm": True}, "weft_width_mm: expected a number, got bool True"),
        ("twill", {"weft_width_mm": [2.4]}, "weft_width_mm: expected a number, got list [2.4]"),
        ("twill", {"over": 2.0}, "over: expected a whole number, got float 2.0"),
        ("twill", {"name": 7}, "name: expected a text, got int 7"),
    ],
)
def test_arguments_of_the_wrong_kind(family, cells, expected):
    with pytest.raises(ArgumentError) as refused:
        measured_fabric(family, **MINE | cells)
    assert str(refused.value).startswith(expected) and isinstance(
        refused.value, (TypeError, InputError)
    )


def test_what_identification_refuses_names_the_keyword():
    cells = MINE | {"weft_crimp_percent": None}
    with pytest.raises(
        InputError, match=r"^weft_crimp: this cell is empty, and so are .* \(row fabric\)$"
    ):
        identify(measured_fabric("twill", **cells))


# ---- meshes


@pytest.fixture
def mesh():
    """Two yarns of two and one hexahedra, with a contact and two ends."""
    x, y, z = np.meshgrid([0.0, 1.0, 2.0], [0.0, 1.0], [0.0, 0.5], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    cube = [0, 2, 3, 1]  # of a layer of nodes at one x, counted about it
    first = [[*cube, *(n + 4 for n in cube)], [*(n + 4 for n in cube), *(n + 8 for n in cube)]]
    second = [[n + len(points) for n in first[0]]]
    return mesh_named(
        np.vstack([points, points + [0, 0, 0.5]]),
        np.array(first + second),
        np.array([0, 0, 1]),
        ("weft_1", "warp_1"),
        {
            "weft_1_contact": np.array([[1, 3, 7, 5], [5, 7, 11, 9]]),
            "weft_1_start": np.array([cube]),
            "warp_1_contact": np.array([[12, 14, 18, 16]]),
        },
    )


def test_a_mesh_for_pyvista(mesh):
    grid = mesh.to_pyvista()
    assert grid.n_cells == 3 and np.array_equal(grid.points, mesh.points)
    assert grid.cell_data["yarn"].tolist() == [1, 1, 2] and grid.cell_data[
        "direction"
    ].tolist() == [0, 0, 1]
    assert list(grid.field_data["yarn_names"]) == ["weft_1", "warp_1"]
    assert np.array_equal(grid.cell_data["fibre_axis"], mesh.fibre_axes())
    blocks = mesh.to_pyvista(surfaces=True)
    assert blocks.keys() == ["yarns", *(surface.name for surface in mesh.surfaces)]
    contact = blocks["weft_1_contact"]
    assert contact.n_cells == 2 and contact.area == pytest.approx(2.0)
    assert np.array_equal(mesh.points[contact.point_data["node"]], contact.points)


def test_a_mesh_for_meshio(mesh, tmp_path):
    meshio = pytest.importorskip("meshio")
    whole = mesh.to_meshio()
    for path in (tmp_path / "cell.vtu", tmp_path / "cell.inp"):
        mesh.to_meshio().write(path)  # which changes a mesh for what a format lacks
    read = meshio.read(tmp_path / "cell.vtu")
    assert np.array_equal(read.cells_dict["hexahedron"], mesh.hexahedra)
    assert [len(block.data) for block in whole.cells] == [3, 4]
    assert [values.tolist() for values in whole.cell_data["yarn"]] == [[1, 1, 2], [1, 1, 1, 2]]
    for number, body in enumerate(mesh.bodies):
        assert np.array_equal(whole.cell_sets[body.name][0], np.flatnonzero(mesh.body == number))
    for surface, quads in mesh.surfaces.items():
        assert np.array_equal(whole.cells[1].data[whole.cell_sets[surface.name][1]], quads)


def test_meshio_is_asked_for_by_name(mesh, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(
        fabric_cad.MissingPackageError, match="needs the package meshio: pip install meshio"
    ):
        mesh.to_meshio()
