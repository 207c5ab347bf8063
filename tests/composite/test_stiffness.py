"""The stiffness of composite cells: what is known of any, of balanced and turned ones, and the files of the command."""

import csv
import json
import shutil
import subprocess

import numpy as np
import pytest

from fabric_cad.cli import main
from fabric_cad.composite.homogenisation.homogenise import constants, homogenise, homogenise_plate
from fabric_cad.composite.materials import element_materials
from fabric_cad.composite.matrix import mesh_composite
from fabric_cad.composite.options import USUAL, CompositeOptions
from fabric_cad.composite.spacing import composite_mesh_options
from fabric_cad.composite.stiffness.computation import COARSE, periodic_mesh
from fabric_cad.composite.substances import Constituents, GivenYarn, Matrix
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families, read_family
from fabric_cad.model.identification import identify

RESIN = Matrix(3500.0, 0.35)
YARN = Constituents(RESIN, None, GivenYarn(None, 151e3, 10.1e3, 5.7e3, 0.24, 0.5))
"""The yarn and resin of the published convergence table of this construction."""

HEADER = "name,weft_density_per_mm,weft_width_mm,weft_crimp,warp_density_per_mm,warp_width_mm,warp_crimp,thicker,"


@pytest.fixture(scope="module")
def fabrics():
    return {
        fabric.name: fabric
        for table in read_families(shipped_families()).values()
        for fabric in identify(table)
    }


def pattern(folder, rows):
    """Fabrics of pattern.csv, from their cells after the header's."""
    path = folder / "pattern.csv"
    path.write_text(HEADER + "pattern,fabric_thickness_mm\n" + "\n".join(rows) + "\n")
    return identify(read_family(path))


def solved(fabric, constituents=YARN, **mesh):
    """Volume shares and effective properties of a fabric's composite."""
    cell = mesh_composite(fabric, composite_mesh_options(fabric, **(COARSE | mesh)), USUAL)
    materials = element_materials(cell.mesh, np.where(cell.in_matrix, 0.0, np.nan), constituents)
    effective = homogenise(periodic_mesh(cell, fabric), materials)
    volumes = effective.response.integrals.volumes[0]
    return volumes[~cell.in_matrix].sum() / volumes.sum(), effective


def test_a_mesh_of_which_one_number_is_told_is_as_fine_both_ways(fabrics):
    options = composite_mesh_options(fabrics["plain"], **(COARSE | {"across": 12}))
    assert (options.across, options.crossing) == (12, 12)
    assert composite_mesh_options(fabrics["plain"], **COARSE).crossing == COARSE["across"]


def test_a_balanced_plain_weave_is_as_published(fabrics):
    """The mesh of 5 952 hexahedra (yarns .4200 of the cell) as solved by an independent code and by CalculiX."""
    share, effective = solved(fabrics["plain"])
    assert share == pytest.approx(0.4200, abs=1e-4)
    found = constants(effective.stiffness)
    published = {
        "Ex": 33417.0,
        "Ez": 7014.8,
        "Gxz": 1950.8,
        "Gxy": 2724.2,
        "nu_xy": 0.1024,
        "nu_xz": 0.4515,
    }
    for name, value in published.items():
        assert found[name] == pytest.approx(value, rel=1e-3)
    for one, other in (("Ex", "Ey"), ("Gxz", "Gyz"), ("nu_xz", "nu_yz")):
        assert found[one] == pytest.approx(found[other], rel=1e-6)


@pytest.mark.parametrize(
    "name", ["plain_flat", "plain_round", "twill21", "satin5", "plain_unbalanced"]
)
def test_bounds_and_symmetry_on_every_section_form(fabrics, name):
    gap = (
        {"gap": 2} if fabrics[name].section == "lenticular" else {}
    )  # else as much as strips of resin need
    _, effective = solved(fabrics[name], across=4, crossing=4, **gap)
    for lower, upper in (
        (effective.reuss, effective.stiffness),
        (effective.stiffness, effective.voigt),
    ):
        assert np.linalg.eigvalsh(upper - lower).min() > 0
    assert effective.response.asymmetry < 1e-8
    np.testing.assert_allclose(
        effective.stiffness, effective.stiffness.T, rtol=0, atol=1e-8 * effective.stiffness.max()
    )


def test_yarns_of_resin_make_resin(fabrics):
    law = RESIN.law
    resin = Constituents(
        RESIN, None, GivenYarn(None, law.E1_MPa, law.E2_MPa, law.G12_MPa, law.nu12, law.nu23)
    )
    _, effective = solved(fabrics["twill21"], resin, across=4, crossing=4, gap=2)
    expected = law.stiffness(np.eye(3)[:1])[0]
    for found in (effective.stiffness, effective.voigt, effective.reuss):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * expected.max())


def test_half_a_period_further_is_the_same_material(tmp_path):
    numbers = "0.22,3.2,0.004,,,,"
    here, there = pattern(tmp_path, [f"here,{numbers},ou/uo,", f"there,{numbers},uo/ou,"])
    mesh = {"across": 4, "crossing": 4, "gap": 2}
    (_, first), (_, second) = solved(here, **mesh), solved(there, **mesh)
    np.testing.assert_allclose(
        first.stiffness, second.stiffness, rtol=0, atol=1e-8 * first.stiffness.max()
    )


def test_weft_and_warp_exchanged_is_the_mirrored_cell(tmp_path):
    """Mirrored at x = y: xx and yy change places, and so do yz and xz."""
    one, other = "0.25,2.8,0.006,0.22,3.3,0.003,", "0.22,3.3,0.003,0.25,2.8,0.006,"
    here, mirrored = pattern(
        tmp_path, [f"here,{one}weft,oou/uoo/ouo,0.92", f"mirrored,{other}warp,uou/uuo/ouu,0.92"]
    )
    mesh = {"across": 4, "crossing": 4, "gap": 2}
    (_, first), (_, second) = solved(here, **mesh), solved(mirrored, **mesh)
    order = [1, 0, 2, 4, 3, 5]
    expected = first.stiffness[np.ix_(order, order)]
    assert np.abs(expected - first.stiffness).max() > 1e-3 * expected.max()
    np.testing.assert_allclose(second.stiffness, expected, rtol=0, atol=1e-8 * expected.max())


def test_a_plate_is_softer_than_a_laminate_in_phase(fabrics):
    """Free floor and ceiling take away what the neighbours above and below hold."""
    fabric = fabrics["plain"]
    cell = mesh_composite(
        fabric, composite_mesh_options(fabric, across=4, crossing=4, gap=2), USUAL
    )
    materials = element_materials(cell.mesh, np.where(cell.in_matrix, 0.0, np.nan), YARN)
    plate = homogenise_plate(periodic_mesh(cell, fabric, through=False), materials)
    stack = homogenise(periodic_mesh(cell, fabric), materials).stiffness
    plane = np.linalg.inv(np.linalg.inv(stack)[np.ix_([0, 1, 5], [0, 1, 5])]) * plate.thickness
    assert np.linalg.eigvalsh(plane - plate.A).min() > 0
    whole = np.block([[plate.A, plate.B], [plate.B.T, plate.D]])
    assert np.linalg.eigvalsh(whole).min() > 0
    assert (
        np.abs(plate.B).max() < 1e-6 * plate.A.max()
    )  # its two faces are alike, half a period apart


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stiffness")
    mesh = ["--across", "4", "--gap", "2", "--layers", "2"]
    common = ["--families", str(shipped_families()), "--out", str(folder)]
    assert main(["stiffness", "plain_unbalanced", "--plate", *mesh, *common, "--quiet"]) == 0
    return folder / "plain_unbalanced"


def test_the_report_holds_what_it_says(written):
    report = json.loads((written / "stiffness.json").read_text())
    stiffness = np.array(report["C_MPa"])
    np.testing.assert_allclose(stiffness @ report["S_per_MPa"], np.eye(6), atol=1e-9)
    assert report["constants"] == pytest.approx(constants(stiffness))
    assert {*report} >= {
        "expansion_per_K",
        "conductivity_W_per_mK",
        "density_g_cm3",
        "voigt_MPa",
        "reuss_MPa",
    }
    assert report["yarn"]["fibre_fraction"] == {"least": 0.65, "greatest": 0.65}
    assert report["mesh"]["fibre_volume_fraction"] == pytest.approx(
        0.65 * report["mesh"]["yarn_volume_fraction"]
    )
    share = report["mesh"]["fibre_volume_fraction"]
    assert report["density_g_cm3"] == pytest.approx(share * 1.76 + (1 - share) * 1.2)
    assert report["plate"]["thickness_mm"] == pytest.approx(report["mesh"]["box_mm"][2])
    assert report["solver"]["residual"] <= report["solver"]["tolerance"] == 1e-7
    assert set(report["files"]) == {path.name for path in written.iterdir()} - {"stiffness.json"}
    with open(written / "stiffness.csv", newline="") as file:
        table = {line["quantity"]: float(line["value"]) for line in csv.DictReader(file)}
    assert table["Ex"] == pytest.approx(report["constants"]["Ex"])
    assert table["conductivity_zz"] == pytest.approx(report["conductivity_W_per_mK"][2][2])


def test_the_series_adds_up_to_the_stiffness(written):
    """Mean strain and stress of every load case, by volumes at rest."""
    import pyvista

    stiffness = np.array(json.loads((written / "stiffness.json").read_text())["C_MPa"])
    paraview = [0, 1, 2, 5, 3, 4]
    for load in range(6):
        grid = pyvista.read(written / f"stiffness_state_{load}.vtu")
        grid.points = np.asarray(grid.points) - grid.point_data["displacement"]
        volumes = grid.compute_cell_sizes()["Volume"]
        mean = volumes @ grid.cell_data["stress"] / volumes.sum()
        np.testing.assert_allclose(
            mean, 0.01 * stiffness[load][paraview], atol=1e-5 * 0.01 * stiffness.max()
        )
        mean = volumes @ grid.cell_data["strain"] / volumes.sum()
        np.testing.assert_allclose(mean, 0.01 * np.eye(6)[load][paraview], atol=1e-7)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["stiffness", "plain", "--margin", "0"], "margin: 0 mm leaves no matrix"),
        (["stiffness", "plain", "--layers", "0"], "layers: 0 is not from 1"),
        (["voxels", "plain", "--cells", "0x4x4"], "cells: 0x4x4 is not from 1x1x1"),
        (["voxels", "plain", "--margin=-5%"], "margin: -5 % leaves no matrix"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_written(here, capsys, arguments, told):
    assert main(arguments) == 2
    assert told in capsys.readouterr().err
    assert not (here / "build" / "plain").exists()


def test_a_lack_of_constituents_is_told_with_its_file(here, capsys):
    (here / "families" / "composite.toml").write_text("[matrix]\nE_MPa = 3500\nnu = 0.35\n")
    assert main(["stiffness", "plain"]) == 2
    assert "composite.toml: fibre: there is no table [fibre], nor" in capsys.readouterr().err


def test_a_stopped_solver_leaves_earlier_results(here, capsys, monkeypatch):
    from fabric_cad.composite.homogenisation import response

    (here / "build" / "plain").mkdir(parents=True)
    (here / "build" / "plain" / "stiffness.json").write_text("earlier")
    patient = response.solve
    monkeypatch.setattr(response, "solve", lambda *given: patient(*given, most=2))
    assert main(["stiffness", "plain", "--across", "4", "--gap", "2"]) == 1
    assert "after 2 iterations the residual is" in capsys.readouterr().err
    assert (here / "build" / "plain" / "stiffness.json").read_text() == "earlier"


def test_voxels_are_written(here):
    assert main(["voxels", "plain", "--cells", "8x8x6", "--margin", "10%", "--quiet"]) == 0
    stored = np.load(here / "build" / "plain" / "voxels.npz")
    assert stored["body"].shape == (8, 8, 6)
    thickness = 2 * 0.3622081848
    assert stored["spacing_mm"][2] * 6 == pytest.approx(1.2 * thickness, rel=1e-6)
    assert (here / "build" / "plain" / "voxels.vti").stat().st_size > 1000


def gauss_weights(mesh):
    """Volumes (elements, 8) at the integration points of C3D8, first axis fastest."""
    signs = (
        np.array(
            [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
        )
        * 2
        - 1.0
    )
    weights = []
    for z, y, x in np.ndindex(2, 2, 2):
        at = (2 * np.array([x, y, z]) - 1) / np.sqrt(3)
        factors = 1 + signs * at
        slopes = np.stack(
            [signs[:, i] * factors[:, i - 2] * factors[:, i - 1] / 8 for i in range(3)], axis=1
        )
        weights.append(np.linalg.det(np.einsum("ai,naj->nij", slopes, mesh.points[mesh.hexahedra])))
    return np.stack(weights, axis=1)


def printed_stresses(text):
    """Per step, rows of element, point, xx, yy, zz, xy, xz, yz from a .dat file of CalculiX."""
    for block in text.split(" stresses (")[1:]:
        lines = [line.split() for line in block.split("total internal energy")[0].splitlines()[1:]]
        yield np.array([line for line in lines if len(line) == 8], dtype=float)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="needs CalculiX")
def test_calculix_finds_the_same_stiffness_from_the_deck(here):
    """Yarns whose fibre fraction varies along them, stresses integrated over the cell."""
    glass = "[fibre]\nE1_MPa = 73e3\nE2_MPa = 73e3\nG12_MPa = 30e3\nG23_MPa = 30e3\nnu12 = 0.2\ndensity_g_cm3 = 2.5\n"
    (here / "families" / "composite.toml").write_text(glass + "[matrix]\nE_MPa = 3500\nnu = 0.35\n")
    row = "twintex_tpeet22"
    command = [
        "stiffness",
        row,
        "--across",
        "4",
        "--crossing",
        "4",
        "--gap",
        "2",
        "--layers",
        "1",
        "--quiet",
    ]
    assert main([*command, "--deck", "calculix"]) == 0
    assert main(command) == 0

    folder = here / "build" / row
    assert "*DISTRIBUTION TABLE" not in (folder / "stiffness.inp").read_text()
    subprocess.run([shutil.which("ccx"), "stiffness"], cwd=folder, check=True, capture_output=True)
    report = json.loads((folder / "stiffness.json").read_text())
    fractions = report["yarn"]["fibre_fraction"]
    assert fractions["greatest"] > 1.02 * fractions["least"]

    fabric = identify(read_families("families")["plain"][row])[row]
    options = composite_mesh_options(fabric, across=4, crossing=4, gap=2)
    weights = gauss_weights(mesh_composite(fabric, options, CompositeOptions(layers=1)).mesh)
    columns = []
    for rows in printed_stresses((folder / "stiffness.dat").read_text()):
        element, point = rows[:, :2].astype(int).T - 1
        mean = weights[element, point] @ rows[:, 2:] / np.prod(report["mesh"]["box_mm"])
        columns.append(mean[[0, 1, 2, 5, 4, 3]])
    stiffness = np.array(report["C_MPa"])
    np.testing.assert_allclose(columns, stiffness, rtol=0, atol=1e-7 * stiffness.max())


def test_the_deck_for_abaqus_asks_for_volumes(here):
    assert (
        main(
            [
                "stiffness",
                "plain",
                "--across",
                "4",
                "--gap",
                "2",
                "--layers",
                "1",
                "--deck",
                "abaqus",
                "-q",
            ]
        )
        == 0
    )
    deck = (here / "build" / "plain" / "stiffness.inp").read_text()
    assert deck.count("*STEP") == 6
    assert "S, IVOL" in deck
    assert "*DISTRIBUTION TABLE" in deck
    assert (
        max(len(word) for line in deck.splitlines() if line[:1] != "*" for word in line.split(", "))
        <= 20
    )
