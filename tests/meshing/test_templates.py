"""Section templates: conforming, complete, and leaving the outline alone."""

from collections import Counter

import numpy as np
import pytest

from fabric_cad.meshing.templates import (
    flat_template,
    lenticular_template,
    round_template,
    worst_corner,
)

FLAT = [(1, 1), (4, 3), (8, 2)]
POINTED = [(4, 2), (8, 2), (12, 2), (8, 4), (13, 4), (12, 6), (24, 8)]


def lens(across):
    """Outline of a section with pointed edges, counter-clockwise from the left tip."""
    v = np.linspace(-1, 1, across + 1)
    lower, upper = np.c_[v, -0.25 * (1 - v**2)], np.c_[v, 0.35 * (1 - v**2)]
    return np.vstack([lower, upper[::-1][1:-1]])


def box(across, through):
    """Outline of a crooked box, counter-clockwise from the lower left corner."""
    corners = np.array([[-1, -0.3], [1, -0.2], [1, 0.2], [-1, 0.25]])
    sides = [
        start + np.linspace(0, 1, parts, endpoint=False)[:, None] * (end - start)
        for start, end, parts in zip(corners, np.roll(corners, -1, axis=0), [across, through] * 2)
    ]
    return np.vstack(sides)


def area(polygon):
    x, y = polygon[..., 0], polygon[..., 1]
    return (x * np.roll(y, -1, axis=-1) - y * np.roll(x, -1, axis=-1)).sum(axis=-1) / 2


@pytest.mark.parametrize(
    ("pointed", "across", "through"), [(False, *n) for n in FLAT] + [(True, *n) for n in POINTED]
)
def test_a_template_is_a_conforming_mesh_of_the_section(pointed, across, through):
    template = (lenticular_template if pointed else flat_template)(across, through)
    outline = lens(across) if pointed else box(across, through)
    assert template.outline == len(outline)
    nodes = np.vstack([outline, template.weights @ outline])
    assert template.weights.sum(axis=1) == pytest.approx(1)  # moves and turns with its outline
    areas = area(nodes[template.quads])
    assert areas.min() > 0
    assert areas.sum() == pytest.approx(area(outline))
    edges = Counter(
        frozenset(pair)
        for quad in template.quads.tolist()
        for pair in zip(quad, quad[1:] + quad[:1])
    )
    border = {frozenset((k, (k + 1) % template.outline)) for k in range(template.outline)}
    assert {edge for edge, times in edges.items() if times == 1} == border
    assert set(edges.values()) <= {1, 2}
    assert set(template.quads.ravel()) == set(range(len(nodes)))


@pytest.mark.parametrize(("across", "through"), [(8, 3), (7, 4), (2, 2)])
def test_tips_that_do_not_fit(across, through):
    with pytest.raises(ValueError):
        lenticular_template(across, through)


@pytest.mark.parametrize(("across", "through"), [(4, 2), (12, 2), (12, 4)])
def test_a_ring_fits_a_smooth_outline(across, through):
    """On an ellipse, which has no corner, no quadrilateral of the ring template is near flat."""
    template = round_template(across, through, (0.12, 0.2))
    corner = np.arctan2(0.5, 1.0)  # outline nodes at the angles of a box's corners and between them
    ends = [-np.pi + corner, -corner, corner, np.pi - corner, np.pi + corner]
    angles = np.concatenate(
        [
            np.linspace(a, b, n, endpoint=False)
            for a, b, n in zip(ends, ends[1:], [across, through] * 2)
        ]
    )
    outline = np.column_stack([2 * np.cos(angles), np.sin(angles)])
    nodes = np.vstack([outline, template.weights @ outline])
    areas = area(nodes[template.quads])
    assert areas.min() > 0 and areas.sum() == pytest.approx(area(outline))
    assert len(template.quads) == across * through + 2 * (across + through)
    assert worst_corner(template, outline) > 0.4
