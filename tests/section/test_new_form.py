"""A new section form is one file plus registrations: this file has one, and takes it through everything."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from fabrics import section_area, table

from fabric_cad.cad import read_step
from fabric_cad.cell.pipeline import make_cell
from fabric_cad.measured.form_rules import contact_rules
from fabric_cad.measured.rules import Rule
from fabric_cad.meshing.edged import LenticularMesh
from fabric_cad.meshing.section_mesh import mesh_form
from fabric_cad.model.claims import Claim
from fabric_cad.model.form_claims import form_claims
from fabric_cad.model.free_sides import free_side
from fabric_cad.model.identification import identify, identify_rows
from fabric_cad.section.conics import free_parabola
from fabric_cad.section.edged import Edged
from fabric_cad.section.forms import FORMS, contact_strips, register, unregister
from fabric_cad.section.profiles import contact_profile, contact_strip, free_parabola_of, free_strip
from fabric_cad.section.splines import Quadratic
from fabric_cad.section.strips import parabolic_strip
from fabric_cad.support.errors import InputError
from fabric_cad.yarn.edges import allowed_scaled_jacobian
from fabric_cad.yarn.swept import swept_yarns
from fabric_cad.yarn.volumes import section_areas, yarn_volumes


@dataclass(frozen=True)
class Eased(Edged):
    """Two pointed edges; beyond the contact chord the section bends less than the crossed yarn did.

    The contact profile goes on with a share of the parabola's curvature, tangent at the chord's end, so
    that a row must give a chord below the width.
    """

    word: ClassVar[str] = "eased"
    share: float = 0.4


def eased_rise(form, rise, slope, p, reach):
    """Height of the profile above the contact side, ``reach`` beyond the contact chord."""
    return rise + slope * reach + form.share * p * reach**2


@contact_strips.register
def _(form: Eased, frame, contact, turns, free):
    chord, half = contact.half_chord - contact.offset, contact.half_chord
    lower, upper = contact_profile(frame, contact, turns), free_parabola_of(frame, free)

    eased = [
        Quadratic(sign * half, frame.floor + p * chord**2, sign * 2 * p * chord, form.share * p)
        for sign, p in zip((-1, 1), (contact.p * turn for turn in turns))
    ]
    strips = [contact_strip(frame, contact, lower), free_strip(frame, free, upper)]
    strips.append(parabolic_strip("left_lower", [0.0, 1.0], -frame.edge, -half, eased[:1]))
    strips.append(parabolic_strip("right_lower", [0.0, 1.0], half, frame.edge, eased[1:]))
    if frame.has_laterals("top"):
        strips.append(parabolic_strip("left_upper", [0.0, 1.0], -frame.edge, free.left, upper[:1]))
        strips.append(parabolic_strip("right_upper", [0.0, 1.0], free.right, frame.edge, upper[:1]))
    return strips


@contact_rules.register
def _(form: Eased, direction, side):
    return (
        Rule(
            f"{direction}_contact_{side}_mm",
            lambda rows: rows.chord(direction, side) == rows.values[f"{direction}_width_mm"],
            "an eased section needs a contact chord below its width",
        ),
    )


def edge_rise(form, contact):
    return eased_rise(
        form, contact.rise, contact.slope, contact.p, contact.width / 2 - contact.half_chord
    )


@free_side.register
def _(form: Eased, contact, turns):
    rises = [turn * edge_rise(form, contact) for turn in turns]
    q, v0 = free_parabola(contact.thickness, contact.width, *rises, 0.0)
    return np.array([q, v0, -contact.free_half_chord, contact.free_half_chord])


@form_claims.register
def _(form: Eased, direction):
    def claim(plateau):
        return Claim(
            lambda solution: (
                ~(
                    edge_rise(form, solution.contacts[direction, plateau])
                    < solution.thickness[direction]
                )
            ),
            lambda solution, row: f"{direction}_width_mm",
            lambda solution, row: f"the eased edges of the {direction} do not fit",
        )

    return [claim("high"), claim("low")]


@section_areas.register
def _(form: Eased, columns, direction):
    return None  # no closed form registered: the volumes are those of the solids


mesh_form(Eased, LenticularMesh())


ROW = {
    "name": "eased_plain",
    "section": "eased",
    "weft_density_per_mm": 0.25,
    "weft_width_mm": 3.2,
    "weft_crimp": 0.005,
    "weft_contact_top_mm": 2.6,
    "weft_contact_bottom_mm": 2.4,
}


@pytest.fixture(scope="module")
def eased():
    form = Eased()
    register(form)
    yield form
    unregister(form)


@pytest.fixture(scope="module")
def made(eased, tmp_path_factory):
    folder = tmp_path_factory.mktemp("eased")
    measured = table("plain", ROW)
    report = make_cell(measured, folder)
    return (
        identify(measured)["eased_plain"],
        report,
        read_step(folder / "eased_plain" / "eased_plain.step"),
    )


def test_rows_may_name_it_and_keep_its_rules(eased):
    assert list(FORMS) == ["lenticular", "flat", "round", "eased"]
    with pytest.raises(
        InputError, match="weft_contact_top_mm: an eased section needs a contact chord below"
    ):
        table("plain", {key: value for key, value in ROW.items() if key != "weft_contact_top_mm"})

    too_wide = table("plain", ROW | {"weft_width_mm": 3.9, "weft_contact_top_mm": 0.4})
    assert identify_rows(too_wide).refused[0].message == "the eased edges of the weft do not fit"


def test_it_is_identified_beside_other_forms(eased):
    """A table of mixed forms gives each row what a table of its own gives."""
    lenticular = ROW | {"name": "lenticular", "section": "lenticular"}
    both = identify(table("plain", lenticular, ROW))
    for row in (ROW, lenticular):
        assert both[row["name"]] == identify(table("plain", row))[row["name"]]

    free, usual = (
        both[name].weft.free_sides["high", "turn"] for name in ("eased_plain", "lenticular")
    )
    assert free.q > usual.q  # its edges rise less, and its free side falls deeper

    measured = table("plain", lenticular, ROW)
    weft_volumes = yarn_volumes(identify_rows(measured).columns, measured.weaves)["weft"]
    assert weft_volumes[0] > 0 and np.isnan(weft_volumes[1])


def test_its_sections_touch_their_envelope_and_bend_at_the_chord_without_a_kink(made):
    fabric, _, _ = made
    for swept in swept_yarns(fabric):
        for section in swept.sections:
            outline = np.concatenate(
                [strip.at(np.linspace(0, 1, 101)) for strip in section.strips.values()]
            )
            solved = fabric.directions[swept.yarn.direction]
            assert np.ptp(outline[:, 0]) == pytest.approx(solved.width, rel=1e-12)
            assert np.ptp(outline[:, 1]) == pytest.approx(solved.thickness, rel=1e-6)
            for side, level in (("bottom", "lower"), ("top", "upper")):
                before, after = section.strips[f"left_{level}"].poles, section.strips[side].poles
                steps = [before[-1] - before[-2], after[1] - after[0]]
                assert steps[0][1] / steps[0][0] == pytest.approx(
                    steps[1][1] / steps[1][0], abs=1e-9
                )


def test_its_solids_are_valid_and_its_yarns_touch(made):
    fabric, report, solids = made
    assert all(solid.isValid() for solid in solids.values())
    consistency = report["consistency"]
    assert consistency["overlap_volume_mm3"] <= 1e-9 and consistency["max_contact_gap_mm"] <= 1e-9
    for swept in swept_yarns(fabric):
        places = [plane.place for plane in swept.planes]
        areas = [section_area(section) for section in swept.sections]
        volume = np.trapezoid(areas, places)
        assert solids[swept.yarn.name].Volume(1e-9) == pytest.approx(volume, rel=1e-6)


def test_its_hexahedra_are_as_good_as_its_edges_allow(made):
    fabric, report, _ = made
    mesh, allowed = report["mesh"], allowed_scaled_jacobian(fabric)
    assert mesh["other_elements"] == 0 and mesh["hexahedra"] > 0
    assert mesh["contact_nodes"] == mesh["coincident_contact_nodes"] > 0
    assert mesh["min_scaled_jacobian"] >= min(0.30, 0.9 * allowed) > 0.1


def test_a_form_can_be_taken_back(eased):
    with pytest.raises(ValueError, match="'eased' already"):
        register(eased)

    unregister(eased)
    try:
        with pytest.raises(InputError, match="'eased' is none of lenticular, flat, round"):
            table("plain", ROW)
    finally:
        register(eased)
