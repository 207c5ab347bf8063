"""Cells under load against closed forms and published figures; CalculiX computes them here and now."""

import csv
import json
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from fabrics import table
from jobs import BLOCK, LENGTH, needs_ccx, step
from meshes import HEIGHT, WIDTH, box
from meshes import LENGTH as BOX_LENGTH
from scipy.integrate import simpson

from fabric_cad.cell.pipeline import find_row
from fabric_cad.cli import main
from fabric_cad.decks.keywords import (
    Boundary,
    Compaction,
    EngineeringConstants,
    Material,
    write_keywords,
)
from fabric_cad.decks.model import Load, Touch, model_keywords
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.simulation.energy import cell_energy
from fabric_cad.simulation.job import Solver, run_job, write_model
from fabric_cad.simulation.laws import YarnLaw
from fabric_cad.simulation.loads.shear import moment
from fabric_cad.simulation.loads.tension import curves
from fabric_cad.simulation.penetration import penetration
from fabric_cad.simulation.reached import at_rest, transverse_strains
from fabric_cad.simulation.results import read_dat
from fabric_cad.simulation.settings import read_settings
from fabric_cad.simulation.solver import find_solver
from fabric_cad.study.units import Work, run_unit
from fabric_cad.weave.bodies import SurfaceKind
from fabric_cad.weave.lattice import Lattice

pytestmark = needs_ccx
FAMILIES = shipped_families()
# the plain weave of which CalculiX results are known: spacing 4.2, width 3.2, crimp 0.5 %, sides of 10 % of b
PLAIN42 = {
    "name": "plain42",
    "weft_density_per_mm": 1 / 4.2,
    "weft_width_mm": 3.2,
    "weft_crimp": 0.005,
    "section": "flat",
    "lateral_height_mm": 0.03714,
}
PERIOD = (8.4, 8.4)
LATTICE = Lattice.axis_parallel(*PERIOD)


def solver(**options):
    return Solver(find_solver(), options.get("threads", 2), options.get("time_limit", 300.0))


def meshed(folder, **options):
    """The mesh of PLAIN42; keywords of mesh_options."""
    from fabric_cad import build_cell, identify, mesh_cell, mesh_options, read_mesh

    fabric = identify(table("plain", PLAIN42))["plain42"]
    step_file = folder / "plain42.step"
    if not step_file.exists():
        build_cell(fabric).write_step(step_file)
    mesh_cell(step_file, fabric, mesh_options(fabric, **options), folder / "plain42.msh")
    return read_mesh(folder / "plain42.msh")


def run(folder, mesh, loads, settings=None, name="job", at_once=False):
    """A job whose loads are all reached, without a warning of the solver's."""
    deck = folder / f"{name}.inp"
    write_model(deck, mesh, LATTICE, settings or read_settings(FAMILIES, "plain42"), loads, name)
    asked = "*CONTACT PRINT, TOTALS=ONLY, FREQUENCY=9999\nCELS\n*END STEP" * (
        "CONTACT PAIR" in deck.read_text()
    )
    deck.write_text(deck.read_text().replace("*END STEP", asked or "*END STEP"))
    if at_once:
        deck.write_text(deck.read_text().replace("*STATIC\n0.95,", "*STATIC\n1.,"))
    job = run_job(deck, mesh, solver())
    assert job.run.finished, job.run.reason
    assert job.run.warnings == ()
    assert len(job.reached) == len(loads)
    return job.reached


def stretched(*states):
    """Loads of biaxial tension by (E11, E22)."""
    case = read_settings(FAMILIES, "plain42").case("tension")
    return tuple(case.load(state, LATTICE) for state in states)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("simulation")


@pytest.fixture(scope="module")
def mesh(folder):
    mesh = meshed(folder, across=8)
    assert len(mesh.hexahedra) == 1536
    return mesh


@pytest.fixture(scope="module")
def reached(folder, mesh):
    """States of PLAIN42 by (E11, E22) in thousandths: k = 1 upwards, then k = 0 downwards."""
    states = [(1, 1), (2, 2), (3, 3), (4, 0), (4, 4), (4, 2), (3, 0), (2, 0), (1, 0)]
    loads = stretched(*((weft / 1000, warp / 1000) for weft, warp in states))
    return dict(zip(states, run(folder, mesh, loads, name="tension")))


def tensions(state):
    """(T11, T22), N a yarn, of a cell of two wefts and two warps."""
    return state.forces[0, 0] / 2, state.forces[1, 1] / 2


@pytest.mark.parametrize(("state", "tension"), [((4, 0), 70.5), ((4, 2), 87.6), ((4, 4), 103.5)])
def test_the_plain_weave_has_its_known_tension(reached, state, tension):
    """Known to 103.5-104 N on 1536 to 6912 elements: within 1 %."""
    assert tensions(reached[state])[0] == pytest.approx(tension, rel=0.01)


def test_equal_strains_of_a_balanced_weave_give_equal_tensions(reached):
    for state in ((1, 1), (2, 2), (3, 3), (4, 4)):  # some reached from equal strains, one by a jump
        weft, warp = tensions(reached[state])
        assert warp == pytest.approx(weft, rel=1e-3)


def test_the_slope_rises_while_the_yarns_decrimp(reached):
    """The toe at k = 0: 141 to 204 N per percent."""
    tension = [0.0] + [tensions(reached[at, 0])[0] for at in (1, 2, 3, 4)]
    slopes = np.diff(tension) / 0.1
    assert (np.diff(slopes) > 0).all()
    assert slopes[0] == pytest.approx(141, rel=0.07)
    assert slopes[-1] == pytest.approx(204, rel=0.03)


def test_yarns_in_contact_hardly_penetrate(reached, mesh):
    """At most 0.3 % of the yarn's thickness in equal strains, and most of the patches pressed."""
    thickness = 0.3714
    state = reached[4, 4]
    assert 0 < state.overclosure < 0.003 * thickness
    depth = penetration(mesh, mesh.points + state.displacement, 1.004 * LATTICE.vectors).depth
    assert depth < 0.003 * thickness
    assert 0.9 < state.share <= 1
    through = transverse_strains(mesh, state.strain)[1]
    assert through[state.pressure > 3].max() < 0  # crushed where pressed


def contact_energy(folder, name, time):
    """Energy (N mm) of the penalty at the end of a step, as the solver sums it over its contact springs."""
    (found,) = [
        each
        for each in read_dat(folder / f"{name}.dat")
        if each.quantity == "CELS" and abs(each.time - time) < 1e-6
    ]
    return float(found.values[0])


def test_the_work_of_the_forces_is_the_energy_stored(folder, reached, mesh):
    settings = read_settings(FAMILIES, "plain42")
    path = [at_rest(mesh)] + [reached[at, at] for at in (1, 2, 3, 4)]
    pulls = [state.forces[0, 0] + state.forces[1, 1] for state in path]
    work = simpson(pulls, dx=0.001 * PERIOD[0])
    state = path[-1]
    stored = cell_energy(mesh, state.displacement, settings.yarn).strain
    stored += contact_energy(folder, "tension", 5)
    assert work == pytest.approx(stored, rel=2e-3)


def test_tension_converges_with_the_mesh(folder, mesh, reached):
    found = []
    for options in ({"across": 4, "gap": 2}, {"across": 12}):
        (state,) = run(folder, meshed(folder, **options), stretched((0.004, 0.004)), name="finer")
        found.append(tensions(state)[0])
    coarse, fine = found
    middle = tensions(reached[4, 4])[0]
    assert fine == pytest.approx(middle, rel=0.01)
    assert abs(fine - middle) < abs(middle - coarse)


def test_a_turned_cell_has_no_stress(folder, mesh):
    turn = np.radians(10)
    across, along = np.sin(turn) * PERIOD[0], (np.cos(turn) - 1) * PERIOD[0]
    loads = (Load("turn", (along, across, 0.0), (-across, along, 0.0)),)
    (state,) = run(
        folder, mesh, loads, name="turn", at_once=True
    )  # half of the turn would be no turn
    assert np.abs(state.forces).max() < 1e-4
    law = read_settings(FAMILIES, "plain42").yarn
    assert (
        cell_energy(mesh, state.displacement, law).strain < 1e-5
    )  # the file gives six digits of the displacement
    assert np.abs(state.strain).max() < 1e-6


def test_the_work_of_shear_is_the_energy_stored(folder, mesh):
    text = "[shear]\nangle_deg = 4.0\npoints = 4\n"
    (folder / "simulation.toml").write_text(text)
    settings = read_settings(folder, "plain42")
    case = settings.case("shear")
    (path,) = case.paths(settings.contact)
    assert path == (1, 2, 3, 4)
    states = run(
        folder, mesh, tuple(case.load(angle, LATTICE) for angle in path), settings, name="shear"
    )
    couples = [0.0] + [
        moment(LATTICE.vectors, angle, 0.0, state.forces) for angle, state in zip(path, states)
    ]
    assert (np.diff(couples) > 0).all()
    stored = cell_energy(mesh, states[-1].displacement, settings.yarn).strain
    stored += contact_energy(folder, "shear", 4)
    assert simpson(couples, dx=np.radians(1)) == pytest.approx(stored, rel=0.02)


def alone(folder, law, strain, **options):
    """Force on the end of one straight yarn pulled by a strain, and its state."""
    yarn = box("weft_1")
    loads = (Load("pull", (strain * BOX_LENGTH, 0.0, 0.0), (0.0, 0.0, 0.0)),)
    keywords = list(
        model_keywords(
            yarn,
            Lattice.axis_parallel(BOX_LENGTH, 1.0),
            law,
            options.get("hardening", 0.0),
            Touch("penalty", 1.0),
            loads,
            "yarn",
        )
    )
    start = yarn.nodes_of(yarn.yarns[0], SurfaceKind.START)
    first, last = (
        int(start[yarn.points[start] @ [0, 1, at] == limit][0]) + 1
        for at, limit in corner(yarn, start)
    )
    # no warp is there to hold the yarn across, or to keep it from turning about itself
    keywords.insert(-1, Boundary(((first, 2, 0.0), (last, 2, 0.0))))
    write_keywords(keywords, folder / "yarn.inp")
    job = run_job(folder / "yarn.inp", yarn, solver())
    assert job.run.finished, job.run.reason
    assert job.run.warnings == ()
    return job.reached[0].forces[0, 0], job.reached[0]


def corner(yarn, start):
    """Two ways to look along a section's diagonal, and how far its corners lie in them."""
    return [(at, (yarn.points[start] @ [0, 1, at]).max()) for at in (1e-3, -1e-3)]


def test_a_straight_yarn_pulls_with_its_modulus(folder):
    """S = E1 e with Green's e: the force is E1 A e times the stretch, E A strain where it is small."""
    law = EngineeringConstants(35000, 70, 70, 0, 0, 0, 30, 30, 30)
    for strain in (1e-5, 0.01):
        force, _ = alone(folder, law, strain)
        green = strain + strain**2 / 2
        assert force == pytest.approx(35000 * WIDTH * HEIGHT * green * (1 + strain), rel=1e-6)
        assert force == pytest.approx(35000 * WIDTH * HEIGHT * strain, rel=2 * strain)


def test_an_isotropic_patch_is_strained_evenly(folder):
    young, poisson, strain = 1000.0, 0.3, 0.01
    shear = young / (2 * (1 + poisson))
    law = EngineeringConstants(young, young, young, poisson, poisson, poisson, shear, shear, shear)
    force, state = alone(folder, law, strain)
    green = strain + strain**2 / 2
    assert force == pytest.approx(young * green * (1 + strain) * WIDTH * HEIGHT, rel=1e-6)
    even = np.array([green, -poisson * green, -poisson * green, 0, 0, 0])
    assert np.abs(state.strain - even).max() < 1e-4 * green
    across, through = transverse_strains(box("weft_1"), state.strain)
    assert across == pytest.approx(even[1], rel=1e-3)
    assert through == pytest.approx(even[2], rel=1e-3)


def test_compaction_resists_with_the_cube_of_the_crush(folder):
    """Confined crush to lambda: nominal stress H (lambda - 1)**3."""
    hardening, crush = 2000.0, -0.2
    held = "".join(f"{node}, 1, 2\n" for node in range(1, 9))
    material = str(Material("m", Compaction(hardening)))
    text = BLOCK.split("*MATERIAL")[0] + material + "*SOLID SECTION, ELSET=block, MATERIAL=m\n"
    text += "*NSET, NSET=top\n5, 6, 7, 8\n*BOUNDARY\n" + held + "bottom, 3, 3\n"
    output = "*NODE PRINT, NSET=top, TOTALS=ONLY\nRF\n"
    (folder / "crush.inp").write_text(
        text + step(f"*BOUNDARY\ntop, 3, 3, {crush}\n", output=output)
    )
    job = run_job(folder / "crush.inp", box("weft_1"), solver())
    assert job.run.warnings == ("*WARNING: no degrees of freedom in the model",)
    (total,) = [each for each in read_dat(folder / "crush.dat") if each.quantity == "RF"]
    assert total.values[2] == pytest.approx(LENGTH * hardening * crush**3, rel=1e-4)


def test_energy_of_a_stretched_box_is_the_closed_form():
    law = YarnLaw(100.0, 20.0, 10.0, 5.0, 4.0, 3.0, 0.3, 0.2, 0.1, 0.15)
    yarn = box("weft_1")
    stretch = np.array([1.02, 0.97, 0.9])
    found = cell_energy(yarn, yarn.points * (stretch - 1), law)
    green = (stretch**2 - 1) / 2
    density = (
        green @ np.linalg.inv(law.compliance) @ green / 2
        + law.hardening / 4 * (stretch.prod() - 1) ** 4
    )
    assert found.strain == pytest.approx(density * BOX_LENGTH * WIDTH * HEIGHT, rel=1e-12)
    assert found.least_volume_ratio == pytest.approx(stretch.prod())


def small(folder):
    """Families and settings of few states."""
    families = folder / "families"
    families.mkdir()
    for file in FAMILIES.glob("*.csv"):
        (families / file.name).write_bytes(file.read_bytes())
    text = "[mesh]\nacross = 6\ngap = 2\n[tension]\nratios = [1]\npoints = 1\ngrid = 2\n"
    text += "[shear]\nangle_deg = 2\npoints = 1\nstrain = 0.001\n[rows.plain_flat.yarn]\ncompaction_strain = 0.05\n"
    (families / "simulation.toml").write_text(text)
    return families


def series(path):
    """Times and grids of a series, as ParaView reads them."""
    import pyvista

    reader = pyvista.get_reader(path)
    found = []
    for time in reader.time_values:
        reader.set_active_time_value(time)
        found.append((time, reader.read()[0]))
    return found


def virial(state, length):
    """What the wefts and the warps pull with, N: their stress along x and y summed over the volume, by a length (mm).

    The fibres carry nearly all of it, along axes that rise and fall.
    """
    volume = np.abs(state.compute_cell_sizes(length=False, area=False).cell_data["Volume"])
    along = state.cell_data["stress_fibre_MPa"][:, None] * state.cell_data["fibre_axis"][:, :2] ** 2
    return (along * volume[:, None]).sum(axis=0) / length


def test_the_commands_leave_their_files(tmp_path, capsys):
    families, out = small(tmp_path), tmp_path / "build"
    here = ["--families", str(families), "--out", str(out)]
    assert main(["tension", "plain_flat", *here]) == 0
    said = capsys.readouterr()
    assert "T11 N per yarn" in said.out and "state 3 of 3" in said.err
    assert main(["shear", "plain_flat", *here, "--across", "4", "-q"]) == 0
    (families / "simulation.toml").write_text("[tension]\nratios = [1]\npoints = 1\ngrid = 0\n")
    assert (
        main(["tension", "plain", *here, "--across", "4", "-q"]) == 0
    )  # one curve spans no surface
    assert (out / "plain" / "tension_curves.png").exists() and not (
        out / "plain" / "tension_surface.png"
    ).exists()
    folder = out / "plain_flat"
    for case, pictures in (
        ("tension", ("_curves", "_surface", "_normal", "_crushing", "_strain", "_pressure")),
        ("shear", ("_curve", "_normal", "_strain", "_pressure")),
    ):
        report = json.loads((folder / f"{case}.json").read_text())
        assert set(report["files"]) | {f"{case}.json"} == {
            file.name for file in folder.glob(f"{case}*")
        }
        assert all(
            sha256((folder / name).read_bytes()).hexdigest() == file
            for name, file in report["files"].items()
        )
        assert report["options"]["across"] == (6 if case == "tension" else 4)
        assert report["version"] and report["date"] and report["measured"]["name"] == "plain_flat"
        assert {f"{case}{name}.png" for name in pictures} | {f"{case}.pvd", f"{case}.csv"} <= set(
            report["files"]
        )
        vector = {f"{case}{name}.pdf" for name in pictures if "curve" in name or name == "_surface"}
        assert vector <= set(report["files"])
        assert report["solver"]["finished"] and not report["solver"]["warnings"]
        assert 0 < report["contact"]["max_contact_penetration_mm"] < 0.002
        assert 0.5 < report["contact"]["min_contact_share"] <= 1
        assert 0.9 < report["contact"]["least_volume_ratio"] < 1
    with open(folder / "tension.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["k"], row["E11"], row["E22"]) for row in rows] == [
        ("", "0", "0"),
        ("", "0", "0.004"),
        ("", "0.004", "0"),
        ("1", "0.004", "0.004"),
    ]
    last = {key: float(value) for key, value in rows[-1].items()}
    assert last["T11_N_per_mm"] == pytest.approx(2 * last["T11_N_per_yarn"] / (2 / 0.22))
    assert last["T11_N_per_yarn"] > float(rows[2]["T11_N_per_yarn"]) > 0
    states = series(folder / "tension.pvd")
    assert [state.field_data["state"][0] for _, state in states] == [
        "E11 = 0 %, E22 = 0 %",
        "E11 = 0 %, E22 = 0.4 %",
        "E11 = 0.4 %, E22 = 0 %",
        "k = 1, E11 = 0.4 %, E22 = 0.4 %",
    ]
    for number, ((time, state), row) in enumerate(zip(states, rows, strict=True)):
        assert time == number and state.field_data["T11_N_per_yarn"][0] == pytest.approx(
            float(row["T11_N_per_yarn"])
        )
    rest, pulled = states[0][1], states[-1][1]
    assert pulled.points - pulled.point_data["displacement"] == pytest.approx(
        rest.points, abs=1e-12
    )
    pulls = [2 * last["T11_N_per_yarn"], 2 * last["T22_N_per_yarn"]]
    assert virial(pulled, 1.004 * 2 / 0.22) == pytest.approx(pulls, rel=0.02)
    assert [time for time, _ in series(folder / "shear.pvd")] == [0, 2]
    assert report["valid_up_to_deg"] == 2 and not report["contact"]["states_beyond"]


def test_what_a_stopped_solver_reached_is_kept_aside(tmp_path, capsys):
    families, out = small(tmp_path), tmp_path / "build"
    before = out / "plain_flat" / "tension.csv"
    before.parent.mkdir(parents=True)
    before.write_text("earlier\n")
    (before.parent / "tension.json").write_text(
        '{"files": ["tension.csv", "tension_state_9.vtu", "../tension"]}'
    )
    more = [before.parent / "tension_state_9.vtu", out / "tension"]
    for file in more:
        file.write_text("earlier\n")
    here = ["--families", str(families), "--out", str(out)]
    assert main(["tension", "plain_flat", *here, "--time-limit", "0.2"]) == 1
    said = capsys.readouterr().err
    assert "stopped at the time limit" in said and "of its load" in said
    kept = out / "plain_flat" / "tension_incomplete"
    assert {"tension.inp", "tension.log", "tension.json", "tension.csv"} <= {
        file.name for file in kept.iterdir()
    }
    assert before.read_text() == "earlier\n"
    assert not json.loads((kept / "tension.json").read_text())["solver"]["finished"]
    assert all(file.exists() for file in more)
    assert main(["tension", "plain_flat", *here, "--across", "4", "-q"]) == 0
    assert not kept.exists() and [file.exists() for file in more] == [False, True]


def test_a_unit_of_a_study_is_stretched(tmp_path):
    row, _ = find_row(small(tmp_path), "plain_flat")
    work = Work(
        "tension",
        {"across": 4, "gap": 2},
        300.0,
        read_settings(tmp_path / "families", "plain_flat"),
    )
    outcome = run_unit(row, work, str(tmp_path / "kept"))
    assert (outcome.status, outcome.reason) == ("done", "")
    figures = outcome.figures
    assert figures["tension.k=1.T11_N_per_yarn"] == pytest.approx(
        figures["tension.k=1.T22_N_per_yarn"], rel=0.03
    )
    assert figures["consistency.max_penetration_mm"] < 1e-9 < figures["tension.max_penetration_mm"]
    assert figures["mesh.hexahedra"] == 2 * 2 * (4 * 2 * (8 + 2) + 8 * 2 * (4 + 2))
    assert {"tension.csv", "tension.pvd", "report.json"} <= {
        file.name for file in (tmp_path / "kept/plain_flat").iterdir()
    }


def test_tied_yarns_and_friction_run_too(folder, mesh):
    """Gluing and friction can only stiffen a cell."""
    load = stretched((0.001, 0.0))
    found = []
    for text in ("", "[contact]\nfriction = 0.3\n", "[contact]\nkind = 'tie'\n"):
        (folder / "simulation.toml").write_text(text)
        (state,) = run(folder, mesh, load, read_settings(folder, "plain42"), name="touch")
        found.append(tensions(state)[0])
    free, rubbing, glued = found
    assert free < rubbing < glued
    assert np.isnan(state.share)


def test_paths_go_through_every_state_asked_for():
    settings = read_settings(FAMILIES, "plain")
    (path,) = settings.case("tension").paths(settings.contact)
    assert len(path) == len({(round(weft, 9), round(warp, 9)) for weft, warp in path})
    near = {(round(weft, 9), round(warp, 9)) for weft, warp in path}
    for curve in curves(settings.case("tension")):
        assert near.issuperset((round(weft, 9), round(warp, 9)) for weft, warp in curve.states)
    levels = [0.001 * at for at in range(5)]
    assert near.issuperset((round(a, 9), round(b, 9)) for a in levels for b in levels if a or b)


def test_a_deck_alone_needs_no_solver(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PATH", str(Path("/nowhere")))
    here = ["--families", str(small(tmp_path)), "--out", str(tmp_path)]
    assert main(["tension", "plain_flat", *here, "--deck", "abaqus"]) == 0
    text = (tmp_path / "plain_flat" / "tension.inp").read_text()
    assert "*DISTRIBUTION TABLE" in text and "*CONTACT OUTPUT" in text
    assert main(["tension", "plain_flat", *here, "-q"]) == 1
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert "calculix-ccx" in said
