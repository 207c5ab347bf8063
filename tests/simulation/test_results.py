"""Readers of CalculiX's files: jobs with a closed form, and files cut off anywhere."""

import numpy as np
import pytest
from jobs import (
    BLOCK,
    LENGTH,
    OUTPUT,
    POISSON,
    STIFFNESS,
    TWO_BLOCKS,
    YOUNG,
    needs_ccx,
    pressed,
    pulled,
    step,
)

from fabric_cad.simulation.results import CONTACT_FORCE, read_dat, read_frd, read_sta
from fabric_cad.simulation.solver import find_solver, run_solver
from fabric_cad.support.errors import InputError

NODAL = 5e-5  # ccx's own 4e-5 in bringing a uniform stress to the nodes, and six digits


def run(folder, text):
    deck = folder / "job.inp"
    deck.write_text(text)
    done = run_solver(deck, find_solver(None), time_limit=60)
    assert done.finished and not done.warnings, done
    return read_frd(deck.with_suffix(".frd")), read_dat(deck.with_suffix(".dat"))


def printed(records, quantity, name):
    return [record for record in records if (record.quantity, record.name) == (quantity, name)]


@needs_ccx
@pytest.mark.parametrize("nlgeom", [False, True])
def test_uniaxial_patch(tmp_path, nlgeom):
    """Linear: Hooke. NLGEOM: second Piola-Kirchhoff against Green-Lagrange, S = E (stretch^2 - 1) / 2."""
    u = 0.04
    (state,), records = run(tmp_path, BLOCK + step(pulled(u), nlgeom=nlgeom))
    strain = u / LENGTH + (0.5 * (u / LENGTH) ** 2 if nlgeom else 0)
    stretch = 1 + u / LENGTH if nlgeom else 1.0
    across = (1 - 2 * POISSON * strain) ** 0.5 if nlgeom else 1.0
    force = stretch * YOUNG * strain  # on the section of 1 mm2 there was
    stress = state.fields["STRESS"]
    assert state.components("STRESS") == ("SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX")
    assert stress.shape == (8, 6)
    assert stress[:, 0] == pytest.approx(force / across**2, rel=NODAL)  # Cauchy
    assert np.abs(stress[:, 1:]).max() < 1e-8
    assert state.fields["TOSTRAIN"][:, 0] == pytest.approx(strain, rel=NODAL)
    assert state.fields["TOSTRAIN"][:, 1:3] == pytest.approx(-POISSON * strain, rel=NODAL)
    assert state.fields["DISP"][[1, 2, 5, 6], 0] == pytest.approx(u)
    assert state.components("DISP") == ("D1", "D2", "D3") and state.components("FORC") == (
        "F1",
        "F2",
        "F3",
    )
    assert state.fields["FORC"][:, 0] == pytest.approx(
        np.array([-1, 1, 1, -1, -1, 1, 1, -1]) * force / 4, rel=1e-5
    )
    (reaction,), (work,), (volume,) = (
        printed(records, *key) for key in (("RF", "RIGHT"), ("ELSE", "BLOCK"), ("EVOL", "BLOCK"))
    )
    assert reaction.values == pytest.approx([force, 0, 0], rel=1e-6, abs=1e-9)
    assert work.values == pytest.approx([LENGTH * YOUNG * strain**2 / 2], rel=1e-6)
    assert volume.values == pytest.approx([LENGTH])


@needs_ccx
def test_time_runs_on_from_step_to_step(tmp_path):
    steps = ((0.02, "0.5, 1."), (0.04, "1., 2."))
    states, records = run(
        tmp_path, BLOCK + "".join(step(pulled(u), static, direct=True) for u, static in steps)
    )
    attempts = read_sta(tmp_path / "job.sta")
    assert [(state.step, state.increment) for state in states] == [(1, 1), (1, 2), (2, 1), (2, 2)]
    assert [state.time for state in states] == pytest.approx([0.5, 1, 2, 3])
    assert [p.time for p in printed(records, "RF", "RIGHT")] == pytest.approx([0.5, 1, 2, 3])
    assert [at.total_time for at in attempts] == pytest.approx([0.5, 1, 2, 3])
    assert [at.step_time for at in attempts] == pytest.approx([0.5, 1, 1, 2])
    assert [state.fields["DISP"][1, 0] for state in states] == pytest.approx(
        [0.01, 0.02, 0.03, 0.04]
    )


@needs_ccx
def test_two_blocks_pressed_together(tmp_path):
    u = 0.01
    (state,), records = run(tmp_path, TWO_BLOCKS + pressed(u))
    pressure = u / (2 / YOUNG + 1 / STIFFNESS)  # two cubes and the contact in a row
    assert state.components("CONTACT") == (
        "COPEN",
        "CSLIP1",
        "CSLIP2",
        "CPRESS",
        "CSHEAR1",
        "CSHEAR2",
    )
    contact = state.fields["CONTACT"]
    assert contact.shape == (16, 6)
    assert contact[8:12, 3] == pytest.approx(pressure, rel=1e-5)
    assert contact[8:12, 0] == pytest.approx(-pressure / STIFFNESS, rel=1e-5)
    assert np.abs(np.delete(contact, range(8, 12), axis=0)).max() == 0
    assert state.fields["STRESS"][:, 2] == pytest.approx(-pressure, rel=NODAL)
    (reaction,) = printed(records, "RF", "HEAD")
    assert reaction.values == pytest.approx([0, 0, -pressure], rel=1e-6, abs=1e-9)
    (energy,), (number,) = printed(records, "CELS", ""), printed(records, "CNUM", "")
    assert energy.values == pytest.approx([pressure**2 / (2 * STIFFNESS)], rel=1e-5)
    assert number.values[0] > 0
    (force,) = printed(records, "CF", "ABOVE/BELOW")
    assert force.values[CONTACT_FORCE["force"]] == pytest.approx(
        [0, 0, pressure], rel=1e-5, abs=1e-9
    )
    assert force.values[CONTACT_FORCE["area"]] == pytest.approx(1)
    assert force.values[CONTACT_FORCE["normal force"]] == pytest.approx(-pressure, rel=1e-5)
    assert force.values[CONTACT_FORCE["mean normal"]] == pytest.approx([0, 0, -1], abs=1e-9)


@needs_ccx
def test_equations_hide_the_reference_node_but_not_the_face(tmp_path):
    tied = "".join(f"*EQUATION\n2\n{node}, 1, 1., 9, 1, -1.\n" for node in (2, 3, 6, 7))
    listing = "*NODE PRINT, NSET=reference\nU, RF\n"
    load = pulled(0.02).replace("right", "9")
    text = (
        BLOCK
        + "*NODE, NSET=reference\n9, 5, 5, 5\n"
        + tied
        + step(load, nlgeom=False, output=OUTPUT + listing)
    )
    (state,), records = run(tmp_path, text)
    assert state.fields["DISP"].shape == (8, 3)  # a node of no element is not in the file
    assert printed(records, "RF", "RIGHT")[0].values[0] == pytest.approx(10)
    assert printed(records, "RF", "REFERENCE")[0].values == pytest.approx(
        np.array([[9, 0, 0, 0]]), abs=1e-9
    )
    assert printed(records, "U", "REFERENCE")[0].values == pytest.approx(
        np.array([[9, 0.02, 0, 0]])
    )


@needs_ccx
def test_nodes_a_block_lacks_are_nan(tmp_path):
    (state,), _ = run(tmp_path, BLOCK + step(pulled(0.02), output="*NODE FILE, NSET=right\nU\n"))
    missing = np.isnan(state.fields["DISP"]).all(axis=1)
    assert np.flatnonzero(~missing).tolist() == [1, 2, 5, 6]
    assert state.fields["DISP"][[1, 2, 5, 6], 0] == pytest.approx(0.02)


@needs_ccx
def test_a_file_cut_off_anywhere_gives_the_states_before(tmp_path):
    states, records = run(tmp_path, BLOCK + step(pulled(0.02), "0.25, 1.", direct=True))
    data, text = (tmp_path / "job.frd").read_bytes(), (tmp_path / "job.dat").read_bytes()
    cut = tmp_path / "cut.frd"
    counts = []
    for end in (*range(0, len(data), 37), len(data)):
        cut.write_bytes(data[:end])
        found = read_frd(cut)
        counts.append(len(found))
        for ours, whole in zip(found, states):
            assert (ours.step, ours.increment, ours.time) == (
                whole.step,
                whole.increment,
                whole.time,
            )
            assert len(found) == 1 or ours.fields.keys() == whole.fields.keys()
            for name, values in ours.fields.items():
                assert np.array_equal(values, whole.fields[name])
    assert counts == sorted(counts) and set(counts) == {0, 1, 2, 3, 4}
    cut = tmp_path / "cut.dat"
    for end in range(0, len(text), 7):
        cut.write_bytes(text[:end])
        for ours, whole in zip(read_dat(cut), records):
            assert (ours.quantity, ours.name, ours.time) == (whole.quantity, whole.name, whole.time)
            assert np.array_equal(ours.values, whole.values)


def test_other_files_are_refused(tmp_path):
    path = tmp_path / "other.frd"
    path.write_text("a letter to a friend\n")
    with pytest.raises(InputError, match="not a .frd file"):
        read_frd(path)
    path.write_bytes(
        b"    1C\n    2C                             8                                     3\n\x01\x00"
    )
    with pytest.raises(InputError, match="binary"):
        read_frd(path)


def test_attempts_that_failed_are_marked(tmp_path):
    path = tmp_path / "job.sta"
    assert read_sta(path) == ()
    path.write_text(
        "SUMMARY OF JOB INFORMATION\n  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME\n"
        "     2          1     1     3  0.125000E+01  0.250000E+00  0.250000E+00\n"
        "     2          2     1U    6  0.125000E+01  0.250000E+00  0.250000E+00\n"
        "     2          2     2     2  0.131250E+01  0.3125"
    )
    first, second = read_sta(path)
    assert first.converged and not second.converged
    assert (second.step, second.increment, second.attempt, second.iterations) == (2, 2, 1, 6)
    assert (first.total_time, first.step_time, first.size) == (1.25, 0.25, 0.25)
