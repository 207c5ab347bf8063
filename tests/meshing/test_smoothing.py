"""Smoothing the inner nodes of a section: true rates, better corners, an outline that stays."""

import numpy as np
import pytest

from fabric_cad.meshing.smoothing import _Cells, _residuals, smoothed
from fabric_cad.meshing.templates import Template, block_modes, round_template, worst_corner

ACROSS, UPRIGHT = 8, 2
TEMPLATE = round_template(ACROSS, UPRIGHT, (0.05, 0.2))
MODES = block_modes(ACROSS, UPRIGHT)


def ellipse(height):
    corner = np.arctan2(0.5, 1.0)
    ends = [-np.pi + corner, -corner, corner, np.pi - corner, np.pi + corner]
    angles = np.concatenate(
        [
            np.linspace(a, b, n, endpoint=False)
            for a, b, n in zip(ends, ends[1:], [ACROSS, UPRIGHT] * 2)
        ]
    )
    return np.column_stack([np.cos(angles), height * np.sin(angles)])


@pytest.mark.parametrize("sharp", [False, True])
def test_rates_are_those_of_finite_differences(sharp):
    outline = ellipse(0.4)[None]
    nodes = np.concatenate([outline, TEMPLATE.weights @ outline], axis=1)
    cells = _Cells.of(TEMPLATE, MODES)
    _, rates = _residuals(cells, nodes, sharp)
    step = 1e-6
    for mode, axis in ((0, 0), (4, 1), (10, 1), (MODES.shape[1] - 1, 0)):
        move = np.zeros((1, MODES.shape[1], 2))
        move[0, mode, axis] = step
        ahead, behind = (
            _residuals(cells, nodes + sign * (cells.shapes @ move), sharp)[0] for sign in (1, -1)
        )
        scale = max(1.0, np.abs(rates[0, :, 2 * mode + axis]).max())
        assert rates[0, :, 2 * mode + axis] / scale == pytest.approx(
            (ahead - behind)[0] / (2 * step) / scale, abs=1e-5
        )


def test_corners_get_better_and_size_does_not_count():
    outlines = np.array([ellipse(height) for height in (0.15, 0.4, 0.8)])
    coefficients = smoothed(TEMPLATE, MODES, outlines)
    for outline, moved in zip(outlines, coefficients):
        full = np.concatenate([outline, TEMPLATE.weights @ outline + MODES @ moved])
        as_weights = Template(len(full), np.empty((0, len(full))), TEMPLATE.quads)
        assert worst_corner(as_weights, full) >= max(0.5, worst_corner(TEMPLATE, outline) - 1e-9)
    assert smoothed(TEMPLATE, MODES, 1e-3 * outlines) == pytest.approx(
        1e-3 * coefficients, abs=1e-9
    )


def test_a_folded_section_is_left_alone():
    folded = ellipse(0.4)
    folded[2, 1] += 0.7  # a node of the bottom above the top
    assert not smoothed(TEMPLATE, MODES, folded[None]).any()
