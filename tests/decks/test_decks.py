"""Input decks: exact text on a mesh small enough to read, and faces that are those of C3D8."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from meshes import box, mesh_named

from fabric_cad.decks.cell import write_deck
from fabric_cad.decks.faces import element_faces, touching_faces
from fabric_cad.decks.keywords import (
    DIALECTS,
    Boundary,
    EngineeringConstants,
    Equation,
    Hexahedra,
    NodeSet,
    Tie,
    write_keywords,
)
from fabric_cad.decks.model import Load, Touch, model_keywords
from fabric_cad.support.errors import BuildError
from fabric_cad.weave.bodies import Surface
from fabric_cad.weave.lattice import Lattice

CONTACT, FREE = Surface.named("weft_1_contact"), Surface.named("weft_1_free")

GOLDEN = Path(__file__).parent / "golden"


@pytest.fixture
def two_yarns():
    """A weft and a warp of one hexahedron each, the warp on top, twisted a little."""
    corner = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], dtype=float)
    weft = np.vstack([corner, corner + [1.0, 0.0, 0.25]])
    warp = weft[:, [1, 0, 2]] * [1, 1, 1] + [0.0, 0.0, 1.0]
    warp = np.vstack([warp[[3, 2, 1, 0]], warp[[7, 6, 5, 4]]])
    hexahedra = np.arange(16).reshape(2, 8)
    surfaces = {
        "weft_1_contact": np.array([[2, 3, 7, 6]]),
        "weft_1_free": np.array([[0, 1, 5, 4], [1, 2, 6, 5], [0, 4, 7, 3]]),
        "weft_1_start": np.array([[0, 3, 2, 1]]),
        "weft_1_end": np.array([[4, 5, 6, 7]]),
        "warp_1_contact": np.array([[10, 11, 15, 14]]),
        "warp_1_start": np.array([[8, 11, 10, 9]]),
        "warp_1_end": np.array([[12, 13, 14, 15]]),
    }
    return mesh_named(
        np.vstack([weft, warp]), hexahedra, np.array([0, 1]), ("weft_1", "warp_1"), surfaces
    )


@pytest.mark.parametrize("dialect", DIALECTS)
def test_golden_text(two_yarns, dialect, tmp_path, request):
    write_deck(two_yarns, tmp_path / "deck.inp", "two yarns", dialect)
    text = (tmp_path / "deck.inp").read_text()
    golden = GOLDEN / f"two_yarns_{dialect}.inp"
    if request.config.getoption("--rewrite-golden"):
        golden.parent.mkdir(exist_ok=True)
        golden.write_text(text)
    assert text == golden.read_text()


def test_every_quadrilateral_is_the_named_face_of_its_element(two_yarns):
    corners = [
        (1, 2, 3, 4),
        (5, 8, 7, 6),
        (1, 5, 6, 2),
        (2, 6, 7, 3),
        (3, 7, 8, 4),
        (4, 8, 5, 1),
    ]  # of C3D8, S1 ... S6
    for name, faces in element_faces(two_yarns).items():
        found = [
            {int(two_yarns.hexahedra[e, k - 1]) for k in corners[s]}
            for e, s in zip(faces.elements, faces.sides)
        ]
        assert sorted(map(sorted, found)) == sorted(
            sorted(quad) for quad in two_yarns.surfaces[name].tolist()
        )


def test_a_surface_of_no_element_is_refused(two_yarns):
    two_yarns.surfaces[Surface.named("warp_1_free")] = np.array([[0, 2, 6, 4]])
    with pytest.raises(ValueError, match="warp_1_free"):
        element_faces(two_yarns)


def test_axes_are_orthonormal_and_follow_the_yarn(two_yarns):
    fibre, across = two_yarns.fibre_axes(), two_yarns.across_axes()
    assert fibre[0] == pytest.approx(np.array([1, 0, 0.25]) / np.hypot(1, 0.25))
    assert np.linalg.norm(across, axis=1) == pytest.approx(1)
    assert (fibre * across).sum(axis=1) == pytest.approx(0)
    assert across[:, 2] == pytest.approx(0)


def two_yarn_model(mesh, **options):
    """Every kind of keyword: friction or a tie, compaction, two loads."""
    law = EngineeringConstants(35000, 70, 60, 0.1, 0.2, 0.3, 30, 20, 10)
    loads = (
        Load("first", (0.001, 0.0, 0.0), (0.0, 0.002, 0.0)),
        Load("second", (0.0, 1e-9, 0.0), (1 / 3, 0.0, 0.0)),
    )
    touch = Touch(options.get("kind", "penalty"), 1e4, 0.3, 1e3)
    return model_keywords(
        mesh,
        Lattice.axis_parallel(1.0, 1.0),
        law,
        options.get("hardening", 2000.0),
        touch,
        loads,
        "a model\nof two yarns",
    )


@pytest.mark.parametrize(
    ("kind", "dialect"), [("penalty", "calculix"), ("penalty", "abaqus"), ("tie", "calculix")]
)
def test_golden_model(flat_yarns, kind, dialect, tmp_path, request):
    write_keywords(two_yarn_model(flat_yarns, kind=kind), tmp_path / "model.inp", dialect)
    text = (tmp_path / "model.inp").read_text()
    golden = GOLDEN / f"model_{kind}_{dialect}.inp"
    if request.config.getoption("--rewrite-golden"):
        golden.write_text(text)
    assert text == golden.read_text()


@pytest.fixture
def flat_yarns():
    """A straight weft below a straight warp, one hexahedron each."""
    corner = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], dtype=float)
    weft = np.vstack([corner, corner + [1.0, 0.0, 0.0]])
    warp = weft[:, [1, 0, 2]] + [0.0, 0.0, 1.0]
    warp = np.vstack([warp[[3, 2, 1, 0]], warp[[7, 6, 5, 4]]])
    surfaces = {
        "weft_1_contact": np.array([[2, 3, 7, 6]]),
        "weft_1_start": np.array([[0, 3, 2, 1]]),
        "weft_1_end": np.array([[4, 5, 6, 7]]),
        "warp_1_contact": np.array([[10, 11, 15, 14]]),
        "warp_1_start": np.array([[8, 11, 10, 9]]),
        "warp_1_end": np.array([[12, 13, 14, 15]]),
    }
    return mesh_named(
        np.vstack([weft, warp]),
        np.arange(16).reshape(2, 8),
        np.array([0, 1]),
        ("weft_1", "warp_1"),
        surfaces,
    )


def test_keywords_print_themselves():
    assert str(Boundary(((3, 2, 0.5),))) == "*BOUNDARY\n3, 2, 2, 0.5\n"
    assert str(Equation(((3, 1, 1.0), (2, 1, -0.5)))) == "*EQUATION\n2\n3, 1, 1, 2, 1, -0.5\n"
    assert str(NodeSet("few", np.arange(1, 19))).splitlines()[2] == "17, 18"
    assert str(Tie("glue", "a", "b", 0.001)) == "*TIE, NAME=glue, POSITION TOLERANCE=0.001\na, b\n"


def test_keywords_refuse_what_does_not_fit(tmp_path):
    with pytest.raises(ValueError, match=r"expected \(2, 8\), got \(2, 4\)"):
        Hexahedra("few", np.arange(2), np.zeros((2, 4)))
    with pytest.raises(ValueError, match="expected one of calculix, abaqus, got 'nastran'"):
        write_keywords([], tmp_path / "deck.inp", "nastran")


def test_every_end_node_is_driven_once(flat_yarns):
    """The dependent node of an equation is in no other; its terms sum to nothing for a rigid translation."""
    equations = [keyword for keyword in two_yarn_model(flat_yarns) if isinstance(keyword, Equation)]
    driven = [equation.terms[0][:2] for equation in equations]
    assert len(driven) == len(set(driven)) == 3 * 8
    used = [term[:2] for equation in equations for term in equation.terms[1:]]
    assert not set(driven) & set(used)
    for equation in equations:
        (end, axis, _), (start, _, _), (reference, _, _) = equation.terms
        apart = flat_yarns.points[end - 1] - flat_yarns.points[start - 1]
        assert apart == pytest.approx(np.eye(3)[reference - 17])
        assert [factor for _, _, factor in equation.terms] == [1, -1, -1]


def test_ends_that_do_not_match_are_refused(flat_yarns):
    flat_yarns.points[4] += 0.01
    with pytest.raises(BuildError, match="weft_1"):
        list(two_yarn_model(flat_yarns))


def test_rings_widen_the_patches_on_their_own_side():
    yarn = box("weft_1", parts=(8, 6, 2))
    mesh = replace(yarn, surfaces=dict(yarn.surfaces))
    bottom = yarn.surfaces[CONTACT].reshape(8, 6, 4)
    mesh.surfaces[CONTACT] = bottom[3:5, 2:4].reshape(-1, 4)
    outside = np.ones((8, 6), dtype=bool)
    outside[3:5, 2:4] = False
    mesh.surfaces[FREE] = np.vstack([yarn.surfaces[FREE], bottom[outside]])
    for rings, faces in ((0, 2 * 2), (1, 4 * 4), (2, 6 * 6), (9, 8 * 6)):
        found = touching_faces(mesh, rings)
        assert len(found["weft_bottom"]) == faces
        assert len(found["weft_top"]) == len(found["warp_top"]) == 0
