"""``fabric-cad permeability``: its files, and what they say of a closed direction and of the clearance."""

import csv
import json

import numpy as np
import pytest

from fabric_cad.cli import main
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.meshing.hexahedron import hexahedra_volumes

FILES = {f"permeability.{kind}" for kind in ("json", "csv", "vtu", "png", "pdf")}


def run(folder, *options):
    mesh = ["--across", "4", "--gap", "2", "--layers", "2"]
    common = ["--families", str(shipped_families()), "--out", str(folder), "--quiet"]
    assert main(["permeability", "plain", *mesh, *options, *common]) == 0
    return json.loads((folder / "plain" / "permeability.json").read_text())


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("permeability")
    return folder / "plain", run(folder, "--margin-study")


def test_every_file_is_there_and_traced(written):
    folder, report = written
    assert {path.name for path in folder.iterdir()} == FILES
    assert set(report["files"]) == FILES - {"permeability.json"}
    assert (
        report["measured"]["name"] == "plain"
        and report["yarns"] == "rigid"
        and report["top"] == "periodic"
    )


def test_principal_values_and_axes_are_those_of_the_tensor(written):
    _, report = written
    tensor, axes = np.array(report["K_mm2"]), np.array(report["axes"])
    assert report["principal_mm2"] == sorted(report["principal_mm2"], reverse=True)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(
        axes.T @ np.diag(report["principal_mm2"]) @ axes, tensor, rtol=0, atol=1e-12
    )


def test_the_error_bar_is_what_another_mesh_differs_by(written):
    _, report = written
    axes = np.array(report["axes"])
    coarse = np.diag(axes @ report["checks"]["coarse_K_mm2"] @ axes.T)
    differs = 100 * np.abs(coarse / report["principal_mm2"] - 1)
    assert report["error_bar_percent"] == pytest.approx(differs.max(), rel=1e-9)
    assert report["mesh"]["coarse"]["hexahedra"] < report["mesh"]["fine"]["hexahedra"]


def test_the_margin_study_is_of_half_and_twice_the_margin(written):
    _, report = written
    margins = [other["margin_mm"] for other in report["margin_study"]]
    np.testing.assert_allclose(margins, np.array([0.5, 2.0]) * report["margin_mm"])
    less, more = (other["K_mm2"][0][0] for other in report["margin_study"])
    assert less < report["K_mm2"][0][0] < more


def test_the_table_holds_the_tensor(written):
    folder, report = written
    with open(folder / "permeability.csv", newline="") as file:
        table = {line["quantity"]: float(line["value"]) for line in csv.DictReader(file)}
    assert table["K_zz"] == pytest.approx(report["K_mm2"][2][2], rel=1e-8)
    assert table["margin"] == pytest.approx(report["margin_mm"], rel=1e-8)


def test_paraview_finds_the_flow_that_the_tensor_tells(written):
    """By Simpson's rule over the nodes as VTK orders them: eight corners, twelve edges, six faces, the middle."""
    import pyvista

    folder, report = written
    grid = pyvista.read(folder / "permeability.vtu")
    assert {f"velocity_{a}_mm2" for a in "xyz"} | {f"pressure_{a}_mm" for a in "xyz"} == set(
        grid.point_data
    )
    nodes = grid.cell_connectivity.reshape(-1, 27)
    volumes = hexahedra_volumes(grid.points[nodes[:, :8]])
    weights = np.repeat([1, 4, 16, 64], [8, 12, 6, 1]) / 216
    means = (
        np.einsum("e,n,enc->c", volumes, weights, grid.point_data["velocity_x_mm2"][nodes])
        / volumes.sum()
    )
    assert means[0] * report["mesh"]["fine"]["porosity"] == pytest.approx(
        report["K_mm2"][0][0], rel=0.05
    )

    middle = grid.points[nodes[:, 20:26]]  # of the faces -x +x -y +y -z +z
    assert (middle[:, 1, 0] > middle[:, 0, 0]).all() and (middle[:, 3, 1] > middle[:, 2, 1]).all()
    assert (middle[:, 5, 2] > middle[:, 4, 2]).all()


def test_plates_close_the_normal_and_the_report_says_so(tmp_path):
    report = run(tmp_path, "--top", "plates")
    assert report["K_mm2"][2] == [0.0, 0.0, 0.0] and report["principal_mm2"][2] == 0.0
    (sentence,) = report["closed"]
    assert "K is 0 along z" in sentence and "plates" in sentence


def test_porous_yarns_let_a_little_more_through(written, tmp_path):
    rigid, porous = written[1], run(tmp_path, "--yarns", "porous", "--fibre-diameter", "70")
    assert porous["yarns"] == "porous" and porous["fibre_diameter_um"] == pytest.approx(70)
    for axis in range(3):
        assert 1 < porous["K_mm2"][axis][axis] / rigid["K_mm2"][axis][axis] < 1.05
    assert porous["mesh"]["fine"]["porosity"] == pytest.approx(
        rigid["mesh"]["fine"]["porosity"], rel=1e-9
    )


@pytest.mark.parametrize(
    "options", [["--yarns", "porous", "--fibre-diameter", "0"], ["--fibre-diameter", "7"]]
)
def test_a_fibre_without_diameter_or_pores_is_refused(tmp_path, capsys, options):
    common = ["--families", str(shipped_families()), "--out", str(tmp_path)]
    try:
        status = main(["permeability", "plain", *options, *common])
    except SystemExit as end:
        status = end.code
    assert status == 2
    assert "fibre-diameter" in capsys.readouterr().err


def test_a_margin_that_leaves_nothing_is_refused(tmp_path, capsys):
    common = ["--families", str(shipped_families()), "--out", str(tmp_path)]
    assert main(["permeability", "plain", "--margin", "0", *common]) == 2
    assert "margin" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
