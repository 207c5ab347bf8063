"""A body that is no yarn passes through mesh, deck, views and report as any other."""

from types import SimpleNamespace

import numpy as np
import pytest
from fabrics import TWILL32, table
from meshes import HEIGHT, box, together

from fabric_cad.cell.figures import mesh_figures
from fabric_cad.decks.cell import write_deck
from fabric_cad.meshing.mesh import Mesh
from fabric_cad.meshing.quality import mesh_quality
from fabric_cad.model.identification import identify
from fabric_cad.pictures import draw_cell, write_vtu
from fabric_cad.weave.bodies import Body, BodyKind

MATRIX = Body(BodyKind.MATRIX)


@pytest.fixture(scope="module")
def mesh():
    """A weft, a warp on it, and a block of matrix beside them."""
    block = box("weft_1", (0, 0, -2 * HEIGHT))
    block = Mesh(block.points, block.hexahedra, block.body, (MATRIX,), {})
    return together(box("weft_1"), block, box("warp_1", (0, 0, HEIGHT), turn=np.pi / 2))


def test_it_has_elements_and_no_fibres(mesh):
    elements = mesh.elements_of(MATRIX)
    assert len(elements) == len(mesh.hexahedra) // 3
    assert not mesh.fibre_axes()[elements].any() and not mesh.across_axes()[elements].any()
    assert np.linalg.norm(mesh.fibre_axes(), axis=1)[mesh.body != 1] == pytest.approx(1)
    assert MATRIX not in mesh.yarns and len(mesh.yarns) == 2


def test_a_deck_has_its_elements_and_turns_none_of_them(mesh, tmp_path):
    write_deck(mesh, tmp_path / "cell.inp", "three bodies")
    text = (tmp_path / "cell.inp").read_text()
    assert "ELSET=matrix" in text

    first = int(mesh.elements_of(MATRIX)[0]) + 1
    lines = text[text.index("*DISTRIBUTION") :].splitlines()
    (line,) = [line for line in lines if line.startswith(f"{first}, ")]
    assert [float(cell) for cell in line.split(",")[1:]] == [1, 0, 0, 0, 1, 0]


def test_views_number_the_yarns_and_show_it_as_none(mesh, tmp_path):
    import pyvista

    write_vtu(mesh, mesh_quality(mesh), tmp_path / "cell.vtu")
    grid = pyvista.read(tmp_path / "cell.vtu")
    assert [set(grid.cell_data[name].tolist()) for name in ("yarn", "direction")] == [
        {0, 1, 2},
        {-1, 0, 1},
    ]
    assert (grid.cell_data["yarn"] == np.array([1, 0, 2])[mesh.body]).all()

    draw_cell(mesh, tmp_path / "cell.png", "three bodies")
    assert (tmp_path / "cell.png").stat().st_size > 10_000

    sets = mesh.to_meshio().cell_sets
    assert sets["matrix"][0].tolist() == mesh.elements_of(MATRIX).tolist()


def test_a_report_counts_its_hexahedra(mesh):
    fabric = identify(table("twill", TWILL32))["twill32"]
    figures = mesh_figures(
        fabric, SimpleNamespace(mesh=mesh, quality=mesh_quality(mesh), allowed=1.0)
    )
    assert figures.hexahedra == len(mesh.hexahedra) and figures.other_elements == 0
    ends = sum(len(mesh.nodes_of(yarn, "start")) for yarn in mesh.yarns)
    assert figures.end_nodes == ends
