"""``fabric-cad composite``: the files of a composite cell hold what they are said to."""

import hashlib
import json

import numpy as np
import pytest

from fabric_cad.cli import main
from fabric_cad.composite.cell import BOX_FACES
from fabric_cad.decks.faces import element_faces, face_quads, outer_faces
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.meshing.hexahedron import hexahedra_volumes
from fabric_cad.weave.bodies import SurfaceKind

YARNS = ["weft_1", "weft_2", "warp_1", "warp_2"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The composite of the shipped row plain, coarse, made by the command; a cell's report stands beside it."""
    out = tmp_path_factory.mktemp("build")
    (out / "plain").mkdir()
    (out / "plain" / "report.json").write_text(json.dumps({"row": "plain", "files": {}}))
    arguments = [
        "--families",
        str(shipped_families()),
        "--out",
        str(out),
        "--across",
        "6",
        "--layers",
        "2",
        "--margin",
        "0.05",
        "-q",
    ]
    assert main(["composite", "plain", *arguments]) == 0
    return out / "plain"


@pytest.fixture(scope="module")
def mesh(folder):
    from fabric_cad import read_mesh

    return read_mesh(folder / "composite.msh")


def test_the_report_tells_of_the_mesh(folder, mesh):
    report = json.loads((folder / "composite.json").read_text())
    volumes = hexahedra_volumes(mesh.points[mesh.hexahedra])
    box = np.prod(report["box_mm"])
    assert (
        report["hexahedra"] == len(mesh.hexahedra)
        and report["other_elements"] == mesh.other_elements == 0
    )
    assert report["margin_mm"] == 0.05
    assert abs(report["volume_error"]) < 1e-12 and volumes.sum() == pytest.approx(box, rel=1e-12)
    yarns = volumes[mesh.body < 4].sum()
    assert report["yarn_volume_fraction"] == pytest.approx(yarns / box)
    assert report["min_scaled_jacobian"].keys() == {"matrix", "yarns"}
    assert report["closed_wedge_mm"] < 1e-9
    assert report["fibre_volume_fraction"] == pytest.approx(
        report["yarn_volume_fraction"] * 0.65, rel=0.2
    )


def test_every_report_of_the_folder_has_the_digests(folder):
    own = json.loads((folder / "composite.json").read_text())["files"]
    cell = json.loads((folder / "report.json").read_text())["files"]
    for name, digest in own.items():
        if name != "report.json":
            assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == digest == cell[name]
    assert {f"composite.{kind}" for kind in ("step", "msh", "inp", "vtu", "png")} <= own.keys()
    assert "composite.json" in cell


def test_the_mesh_file_names_bodies_faces_and_interfaces(folder, mesh):
    import gmsh

    assert [body.name for body in mesh.bodies] == [*YARNS, "matrix"]
    from fabric_cad.meshing.gmsh_session import gmsh_session

    with gmsh_session():
        gmsh.open(str(folder / "composite.msh"))
        names = {
            gmsh.model.getPhysicalName(*group): group for group in gmsh.model.getPhysicalGroups()
        }
        counts = {}
        for name, (dimension, group) in names.items():
            entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, group)
            counts[name] = sum(
                len(gmsh.model.mesh.getElements(dimension, each)[1][0]) for each in entities
            )
    kinds = ("matrix", "contact", "start", "end")
    assert names.keys() == {
        *YARNS,
        "matrix",
        *BOX_FACES,
        *(f"{yarn}_{kind}" for yarn in YARNS for kind in kinds),
    }
    assert counts["z_min"] == counts["z_max"] == (2 * (6 + 4)) ** 2
    assert counts["x_min"] == counts["x_max"] and counts["y_min"] == counts["y_max"]
    assert counts["weft_1_contact"] == 2 * 6 * 6


def test_the_solids_are_those_of_the_report(folder):
    """Exact volumes: the mesh's yarns, with straight edges, are a little smaller."""
    from fabric_cad.cad import read_step

    report = json.loads((folder / "composite.json").read_text())
    solids = read_step(folder / "composite.step")
    assert list(solids) == [*YARNS, "matrix"]
    box = np.prod(report["box_mm"])
    assert solids["matrix"].Volume(1e-9) == pytest.approx(report["solids"]["matrix_mm3"])
    assert report["solids"]["matrix_mm3"] + report["solids"]["yarns_mm3"] == pytest.approx(
        box, rel=1e-9
    )
    assert report["yarn_volume_fraction"] == pytest.approx(
        report["solids"]["yarns_mm3"] / box, rel=0.03
    )


def test_the_deck_has_the_same_numbers_sets_and_surfaces(folder, mesh):
    text = (folder / "composite.inp").read_text()
    elements = {}
    for block in text.split("*ELEMENT, TYPE=C3D8, ELSET=")[1:]:
        name, *lines = block.split("\n*")[0].splitlines()
        rows = np.array([[int(cell) for cell in line.split(",")] for line in lines])
        elements[name] = rows
    assert list(elements) == [*YARNS, "matrix"]
    rows = np.vstack(list(elements.values()))
    assert np.array_equal(rows[:, 1:] - 1, mesh.hexahedra[rows[:, 0] - 1])
    for name in BOX_FACES:
        assert f"*SURFACE, NAME={name}, TYPE=ELEMENT" in text and f"*NSET, NSET={name}\n" in text
    assert "*SURFACE, NAME=weft_1_matrix, TYPE=ELEMENT" in text


def test_surfaces_of_bonded_bodies_are_faces_of_their_own_elements(mesh):
    for surface, faces in element_faces(mesh).items():
        assert (mesh.body[faces.elements] == mesh.bodies.index(surface.body)).all()
        own, quads = face_quads(mesh, faces), mesh.surfaces[surface]
        assert np.array_equal(
            np.unique(np.sort(own, axis=1), axis=0), np.unique(np.sort(quads, axis=1), axis=0)
        )
    starts = {"weft_1_start": mesh.quads_of(mesh.yarns[0], SurfaceKind.START)}
    assert len(outer_faces(mesh, starts)["weft_1_start"]) == len(starts["weft_1_start"])


def test_the_vtu_has_body_fibre_and_quality(folder, mesh):
    import pyvista

    grid = pyvista.read(folder / "composite.vtu")
    body = grid.cell_data["body"]
    assert np.array_equal(body, np.where(mesh.body == 4, 0, mesh.body + 1))
    assert list(grid.field_data["yarn_names"]) == YARNS
    assert np.linalg.norm(grid.cell_data["fibre_axis"], axis=1) == pytest.approx(
        np.where(body, 1.0, 0.0)
    )
    fraction = grid.cell_data["fibre_fraction"]
    assert (
        (fraction[body == 0] == 0).all()
        and (fraction[body > 0] > 0.3).all()
        and fraction.max() < 0.9069
    )
    assert grid.cell_data["scaled_jacobian"].min() > 0.3


def test_the_picture_shows_yarns_and_matrix(folder):
    from PIL import Image

    colours = (
        np.asarray(Image.open(folder / "composite.png").convert("RGB")).reshape(-1, 3).astype(int)
    )
    shown = colours[(colours < 250).any(axis=1)]
    assert len(shown) > 0.2 * len(colours)
    orange = (shown[:, 0] > 200) & (shown[:, 2] < 80)  # a weft where the matrix is cut away
    green = (shown[:, 1] > shown[:, 0]) & (shown[:, 1] > shown[:, 2]) & (shown.min(axis=1) > 100)
    assert orange.mean() > 0.03 and green.mean() > 0.1


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["--margin", "0"], 2, "margin: 0 mm leaves no matrix"),
        (["--margin", "wide"], 2, "margin: 'wide' is neither a share"),
        (["--layers", "0"], 2, "layers: 0 is not from 1"),
        (["--grading", "-1"], 2, "grading: -1 is not from"),
        (["--contact", "loose"], 2, "invalid choice"),
    ],
)
def test_bad_input(tmp_path, capsys, arguments, status, words):
    try:
        got = main(
            [
                "composite",
                "plain",
                "--families",
                str(shipped_families()),
                "--out",
                str(tmp_path),
                *arguments,
            ]
        )
    except SystemExit as error:
        got = error.code
    assert got == status and words in capsys.readouterr().err
    assert not (tmp_path / "plain").exists()


def test_a_mesh_that_no_solver_takes_is_not_delivered(mesh):
    from fabric_cad.composite.cell import CompositeCell
    from fabric_cad.composite.options import USUAL
    from fabric_cad.composite.report import Figures, composite_report
    from fabric_cad.measured.tables import read_families
    from fabric_cad.model.identification import identify
    from fabric_cad.support.errors import BuildError

    fabric = identify(read_families(shipped_families())["plain"])["plain"]
    volumes = hexahedra_volumes(mesh.points[mesh.hexahedra])
    cell = CompositeCell(mesh, {}, np.array([volumes.sum(), 1.0, 1.0]), 0.05, 0.0, 0.0)
    good, none = np.full(len(volumes), 0.9), np.zeros(len(volumes))
    assert (
        composite_report(fabric, USUAL, cell, mesh, Figures(volumes, good, none))["row"] == "plain"
    )
    folded = np.where(np.arange(len(good)) == 3, -0.1, good)
    with pytest.raises(BuildError, match="plain: 1 hexahedra .* not above 0.0001, -0.1 at least"):
        composite_report(fabric, USUAL, cell, mesh, Figures(volumes, folded, none))
    with pytest.raises(BuildError, match="do not fill the box"):
        composite_report(fabric, USUAL, cell, mesh, Figures(volumes * 1.001, good, none))
