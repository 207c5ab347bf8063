"""Input decks: exact text on a mesh small enough to read, and faces that are those of C3D8."""

from pathlib import Path

import numpy as np
import pytest

from fabric_cad.decks.cell import write_deck
from fabric_cad.decks.faces import element_faces
from fabric_cad.decks.keywords import DIALECTS
from fabric_cad.meshing.mesh import Mesh

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
    return Mesh(np.vstack([weft, warp]), hexahedra, np.array([0, 1]), ("weft_1", "warp_1"), surfaces)


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
    corners = [(1, 2, 3, 4), (5, 8, 7, 6), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 8, 4), (4, 8, 5, 1)]  # of C3D8, S1 ... S6
    for name, (elements, sides) in element_faces(two_yarns).items():
        found = [{int(two_yarns.hexahedra[e, k - 1]) for k in corners[s]} for e, s in zip(elements, sides)]
        assert sorted(map(sorted, found)) == sorted(sorted(quad) for quad in two_yarns.surfaces[name].tolist())


def test_a_surface_of_no_element_is_refused(two_yarns):
    two_yarns.surfaces["stray"] = np.array([[0, 2, 6, 4]])
    with pytest.raises(ValueError, match="stray"):
        element_faces(two_yarns)


def test_axes_are_orthonormal_and_follow_the_yarn(two_yarns):
    fibre, across = two_yarns.fibre_axes(), two_yarns.across_axes()
    assert fibre[0] == pytest.approx(np.array([1, 0, 0.25]) / np.hypot(1, 0.25))
    assert np.linalg.norm(across, axis=1) == pytest.approx(1)
    assert (fibre * across).sum(axis=1) == pytest.approx(0)
    assert across[:, 2] == pytest.approx(0)
