"""The matrix of hexahedra: it fills the box, conforms to the yarns, and repeats."""

from collections import Counter
from functools import lru_cache

import numpy as np
import pytest
from composite_checks import check_fills, check_repeats, face_counts
from fabrics import DRAWS, TWILL32, table

from fabric_cad.composite.cell import MATRIX
from fabric_cad.composite.matrix import composite_cell, mesh_composite
from fabric_cad.composite.options import CompositeOptions, Margin
from fabric_cad.composite.spacing import composite_mesh_options, gap_shares
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.meshing.closed import closed_mesh
from fabric_cad.meshing.hexahedron import FACES, hexahedra_volumes
from fabric_cad.meshing.plan import plan_yarns
from fabric_cad.meshing.quality import hexahedra_quality
from fabric_cad.model.identification import identify
from fabric_cad.support.errors import InputError
from fabric_cad.weave.bodies import Surface, SurfaceKind
from fabric_cad.weave.weaves import yarns_of

FABRICS = {
    fabric.name: fabric
    for family in read_families(shipped_families()).values()
    for fabric in identify(family)
}
SMALL = [name for name, fabric in FABRICS.items() if fabric.weave.wefts <= 4]


@lru_cache(maxsize=64)
def coarse(name, **options):
    """The composite of a shipped row with 4 columns a yarn and 2 layers of matrix."""
    fabric = FABRICS[name]
    return mesh_composite(
        fabric, composite_mesh_options(fabric, across=4), CompositeOptions(layers=2, **options)
    )


def random_composite(kind, seed):
    """The composite of a random fabric; skips what is no fabric, or has wedges that are not closed."""
    family, row = DRAWS[kind](np.random.default_rng(seed), "random")
    try:
        fabric = identify(table(family, row))["random"]
        options = composite_mesh_options(fabric, across=4)
        return fabric, mesh_composite(
            fabric, options, CompositeOptions(layers=1, margin=Margin(0.1))
        )
    except InputError as error:
        pytest.skip(str(error))


@pytest.mark.parametrize("name", SMALL)
def test_hexahedra_fill_the_box_of_shipped_rows(name):
    cell = coarse(name)
    check_fills(cell)
    check_repeats(cell)
    rounded = np.round(cell.mesh.points, 7)
    assert len(np.unique(rounded, axis=0)) == len(rounded)  # no double node


@pytest.mark.parametrize("kind", ["standard", "general", "patterns", "narrow"])
@pytest.mark.parametrize("seed", range(2))
def test_hexahedra_fill_the_box_of_random_fabrics(kind, seed):
    fabric, cell = random_composite(kind, seed)
    faces, times = face_counts(cell.mesh.hexahedra)
    assert times.max() == 2 and np.count_nonzero(times == 1) == sum(map(len, cell.box.values()))
    volumes = hexahedra_volumes(cell.mesh.points[cell.mesh.hexahedra])
    assert volumes.sum() == pytest.approx(cell.size.prod(), rel=1e-12)
    assert cell.size[2] == pytest.approx(1.2 * fabric.fabric_thickness)
    check_repeats(cell)


@pytest.mark.parametrize("name", ["plain", "plain_flat", "plain_round", "twill22_offsets"])
def test_yarns_keep_their_hexahedra(name):
    """Volumes of the yarns' elements are those of the yarns meshed alone, but for the wedges closed."""
    fabric, cell = FABRICS[name], coarse(name)
    options = composite_mesh_options(fabric, across=4)
    plans = plan_yarns(
        fabric, yarns_of(fabric.weave.interlacement()), options, gap_shares(fabric, options)
    )
    alone = closed_mesh(fabric, plans)
    ours = ~cell.in_matrix
    assert np.array_equal(cell.mesh.body[ours], alone.body)
    volumes = hexahedra_volumes(alone.points[alone.hexahedra])
    kept = hexahedra_volumes(cell.mesh.points[cell.mesh.hexahedra[ours]])
    areas = np.ptp(alone.points[alone.hexahedra], axis=1)[:, :2].prod(axis=1)
    assert (
        np.abs(kept - volumes) <= 2 * areas * cell.closed_wedge / 2 + 1e-12 * volumes.max()
    ).all()
    if cell.closed_wedge < 1e-9:
        assert kept == pytest.approx(volumes, rel=1e-9)
    assert cell.mesh.fibre_axes()[ours] == pytest.approx(alone.fibre_axes(), abs=0.02)
    assert not cell.mesh.fibre_axes()[~ours].any()


@pytest.mark.parametrize("name", ["twill21", "plain_flat", "plain_round"])
@pytest.mark.parametrize("contact", ["bonded", "double"])
def test_interfaces_lie_between_what_their_names_say(name, contact):
    cell = coarse(name, contact=contact)
    mesh = cell.mesh
    owners = Counter()
    bodies_of = {}
    for body, faces in zip(
        mesh.body.repeat(6), np.sort(mesh.hexahedra[:, FACES].reshape(-1, 4), axis=1).tolist()
    ):
        bodies_of.setdefault(tuple(faces), []).append(int(body))

    matrix = mesh.bodies.index(MATRIX)
    for number, yarn in enumerate(mesh.yarns):
        for kind in SurfaceKind:
            for quad in np.sort(mesh.quads_of(yarn, kind), axis=1).tolist():
                found = bodies_of[tuple(quad)]
                assert number in found
                owners[kind] += 1
                if kind is SurfaceKind.MATRIX:
                    assert matrix in found and len(found) == 2
                elif kind is SurfaceKind.CONTACT:
                    assert matrix not in found and len(found) == (2 if contact == "bonded" else 1)
                else:
                    assert found == [number]
    assert (
        owners[SurfaceKind.CONTACT] and owners[SurfaceKind.MATRIX] and not owners[SurfaceKind.FREE]
    )
    between = sum(len(set(found)) == 2 for found in bodies_of.values())
    contacts = owners[SurfaceKind.CONTACT] // 2 if contact == "bonded" else 0
    assert between == owners[SurfaceKind.MATRIX] + contacts


@pytest.mark.parametrize("name", ["twill21", "plain_flat", "twill22_chords"])
def test_double_contact_has_nodes_of_its_own_inside_the_patches(name):
    """As many faces more on the outside as there are contacts, and so many nodes more as lie inside the patches."""
    cell, bonded = coarse(name, contact="double"), coarse(name)
    volumes = hexahedra_volumes(cell.mesh.points[cell.mesh.hexahedra])
    assert volumes.sum() == pytest.approx(cell.size.prod(), rel=1e-12)
    _, times = face_counts(cell.mesh.hexahedra)
    contacts = sum(len(cell.mesh.quads_of(yarn, SurfaceKind.CONTACT)) for yarn in cell.mesh.yarns)
    assert np.count_nonzero(times == 1) == contacts + sum(map(len, cell.box.values()))

    crossings = FABRICS[name].weave.interlacement().size
    quads = contacts / 2 / crossings
    sides = np.sqrt(quads)
    assert len(cell.mesh.points) - len(bonded.mesh.points) == pytest.approx(
        crossings * (sides - 1) ** 2
    )


@pytest.mark.parametrize(
    "name", ["plain", "twill22", "twill32", "satin5", "basket22", "twill22_offsets", "crowfoot4"]
)
def test_the_matrix_of_lenticular_rows_is_well_shaped(name):
    """At least 0.6 at the default mesh."""
    cell = mesh_composite(FABRICS[name], composite_mesh_options(FABRICS[name]))
    quality = hexahedra_quality(cell.mesh.points, cell.mesh.hexahedra[cell.in_matrix])
    assert quality.scaled_jacobian.min() >= 0.6


@pytest.mark.parametrize("name", ["plain_flat", "plain_round", "twill22_round"])
def test_the_matrix_beside_flat_and_round_sides_is_well_shaped(name):
    cell = mesh_composite(FABRICS[name], composite_mesh_options(FABRICS[name]))
    quality = hexahedra_quality(cell.mesh.points, cell.mesh.hexahedra[cell.in_matrix])
    assert quality.scaled_jacobian.min() >= 0.3


@pytest.mark.parametrize("seed", [44, 70, 95])
def test_strips_beside_flat_sides_in_narrow_gaps_do_not_fold(seed):
    """Half gaps of 0.13 to 0.35 of the thickness; strips that took 0.65 of them had -0.03 (seed 70)."""
    family, row = DRAWS["standard"](np.random.default_rng(seed), "narrow")
    fabric = identify(table(family, row))["narrow"]
    cell = mesh_composite(
        fabric, composite_mesh_options(fabric, across=4), CompositeOptions(layers=1)
    )
    quality = hexahedra_quality(cell.mesh.points, cell.mesh.hexahedra[cell.in_matrix])
    assert quality.scaled_jacobian.min() >= 0.08


def test_a_gap_too_narrow_for_strips_beside_arcs_is_refused_with_its_numbers():
    family, row = DRAWS["general"](np.random.default_rng(28), "narrow")
    fabric = identify(table(family, row))["narrow"]
    words = r"w\w+_width_mm: .* leaves a gap of .* mm between w\w+s, too narrow .* round sides, which are .* mm high"
    with pytest.raises(InputError, match=words) as refused:
        mesh_composite(fabric, composite_mesh_options(fabric, across=4), CompositeOptions(layers=1))
    (problem,) = refused.value.problems
    direction = problem.column.removesuffix("_width_mm")
    width, spacing = fabric.directions[direction].width, fabric.crossed(direction).crossed_spacing
    assert f"{width:.4g} leaves a gap of {spacing - width:.3g} mm" in problem.message


def test_margin_layers_and_grading():
    fabric = FABRICS["plain"]
    options = CompositeOptions(Margin(0.05, is_share=False), layers=3, grading=4.0)
    assert np.diff(options.shares()) == pytest.approx(np.array([1.0, 2.0, 4.0]) / 7)
    cell = mesh_composite(fabric, composite_mesh_options(fabric, across=4), options)
    assert cell.margin == 0.05
    assert cell.size[2] == pytest.approx(fabric.fabric_thickness + 0.1)
    yarns = cell.mesh.points[np.unique(cell.mesh.hexahedra[~cell.in_matrix])]
    assert yarns[:, 2].max() == pytest.approx(-yarns[:, 2].min())
    assert yarns[:, 2].max() == pytest.approx(fabric.fabric_thickness / 2)


@pytest.mark.parametrize(
    ("text", "margin"),
    [("5%", Margin(0.05)), (" 2.5 % ", Margin(0.025)), ("0.04", Margin(0.04, False))],
)
def test_a_margin_is_read(text, margin):
    assert Margin.read(text).length(0.5) == pytest.approx(margin.length(0.5))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"margin": Margin(0.0)}, "margin: 0 % leaves no matrix: the yarns reach"),
        ({"margin": Margin(-1.0, False)}, "margin: -1 mm leaves no matrix"),
        ({"margin": Margin(1e-6)}, "margin: 0.0001 % is not at least 0.01 %"),
        ({"layers": 0}, "layers: 0 is not from 1 to 1000"),
        ({"layers": 1.5}, "layers: 1.5 is not a whole number"),
        ({"grading": 0.0}, "grading: 0 is not from 0.001 to 1000"),
        ({"grading": float("nan")}, "grading: nan is not from"),
        ({"contact": "glued"}, "contact: 'glued' is none of bonded, double"),
    ],
)
def test_options_that_make_no_matrix_are_refused(options, words):
    fabric = FABRICS["plain"]
    with pytest.raises(InputError, match=words):
        mesh_composite(
            fabric, composite_mesh_options(fabric, across=4), CompositeOptions(**options)
        )


@pytest.mark.parametrize("text", ["", "five", "5 percent", "nan", "inf%"])
def test_a_margin_that_is_none(text):
    with pytest.raises(InputError, match="margin: .* is neither a share"):
        Margin.read(text)


def test_a_gap_without_room_for_the_resin():
    with pytest.raises(InputError, match="gap: 4 is below 6"):
        composite_mesh_options(FABRICS["plain_flat"], gap=4)
    with pytest.raises(InputError, match="through: 3 is odd"):
        composite_mesh_options(FABRICS["plain_flat"], through=3)


def test_a_wedge_too_wide_to_close_is_refused():
    row = TWILL32 | {"weft_contact_top_mm": 0.9, "weft_contact_bottom_mm": 0.9}
    fabric = identify(table("twill", row))["twill32"]
    with pytest.raises(InputError, match="the yarns stand .* mm apart at their edges"):
        mesh_composite(fabric, composite_mesh_options(fabric))


def test_the_mesh_that_gmsh_makes_serves_as_well(tmp_path):
    """The nodes of the closed form are those of gmsh on the STEP, and the composite around them is the same."""
    from fabric_cad import build_cell, mesh_cell, read_mesh

    fabric = FABRICS["plain_unbalanced"]
    options = composite_mesh_options(fabric, across=4)
    build_cell(fabric).write_step(tmp_path / "cell.step")
    mesh_cell(tmp_path / "cell.step", fabric, options, tmp_path / "cell.msh")
    plans = plan_yarns(fabric, yarns_of(fabric.weave.interlacement()), options)
    ours, theirs = (
        composite_cell(yarns, fabric, plans)
        for yarns in (closed_mesh(fabric, plans), read_mesh(tmp_path / "cell.msh"))
    )
    assert theirs.mesh.hexahedra.shape == ours.mesh.hexahedra.shape
    volumes = [hexahedra_volumes(cell.mesh.points[cell.mesh.hexahedra]) for cell in (ours, theirs)]
    assert np.sort(volumes[0]) == pytest.approx(np.sort(volumes[1]), rel=1e-7)
    assert Surface(theirs.mesh.yarns[0], SurfaceKind.MATRIX) in theirs.mesh.surfaces
