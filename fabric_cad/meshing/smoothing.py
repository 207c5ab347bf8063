"""Inner nodes moved to where the corners of a section's quadrilaterals are most upright.

Layers of nodes are vertical planes. At a node a hexahedron therefore has the scaled Jacobian
sin(corner) cos(slope): ``corner`` is the angle of its quadrilateral there, ``slope`` that of the
line of nodes which follows the yarn. Slopes are the yarn's own; corners are improved by minimising,
first with the residual corner - 90 deg, then with cos(corner) / sin(corner)^2, the sum of squares

    sum residual^2 + 0.2 sum log(edge / opposite edge)^2

over displacements of the inner nodes that are bilinear on a coarse grid over the inner block. The
second sum keeps cells even, so that no edge collapses. Steps are Levenberg's and Marquardt's, taken
by all sections of a chunk at once; a step that would fold a cell is refused. Outline nodes never
move.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .templates import Template

_STAGES = ((False, 7), (True, 8))
"""Whether sharp corners count for more, and the most steps taken so."""
_EVENNESS = 0.2
_SETTLED = 1e-3
"""Share by which a step has to lower the sum for another to follow."""
_NUMBERS = 4_000_000
"""Rates kept at once (32 MB), which bounds how many sections take their steps together."""


def smoothed(template: Template, modes: np.ndarray, outlines: np.ndarray) -> np.ndarray:
    """How far to move the inner nodes of some sections: coefficients (sections, modes, 2), mm.

    ``modes`` (inner, modes) are the shapes of the displacements, ``outlines`` (sections, outline,
    2) in mm. A section that has a folded cell to begin with gets zeros: it is left as the template
    fills it.
    """
    size = np.ptp(outlines[..., 0], axis=1)[:, None, None]
    nodes = np.concatenate([outlines, template.weights @ outlines], axis=1) / size
    cells = _Cells.of(template, modes)

    coefficients = np.zeros((len(outlines), modes.shape[1], 2))
    together = max(1, _NUMBERS // (12 * len(template.quads) * modes.shape[1]))
    for first in range(0, len(outlines), together):
        some = slice(first, first + together)
        for sharp, steps in _STAGES:
            # in place: a slice is a view
            _descend(cells, nodes[some], coefficients[some], sharp, steps)

    return coefficients * size


@dataclass(frozen=True, eq=False)
class _Cells:
    """The corners of a template's quadrilaterals, and how they follow the coefficients.

    ``corners`` (4, corners) are the nodes of a quadrilateral counter-clockwise from each corner on;
    ``pairs`` selects the corners that hold every pair of opposite edges once; ``shapes``
    (nodes, modes) are the displacements of all nodes.
    """

    corners: np.ndarray
    pairs: np.ndarray
    shapes: np.ndarray

    @classmethod
    def of(cls, template: Template, modes: np.ndarray) -> _Cells:
        corners = np.array([np.roll(template.quads, -turn, axis=1).ravel() for turn in range(4)])
        pairs = np.flatnonzero(np.arange(template.quads.size) % 4 < 2)
        return cls(corners, pairs, np.vstack([np.zeros((template.outline, modes.shape[1])), modes]))


def _descend(
    cells: _Cells, nodes: np.ndarray, coefficients: np.ndarray, sharp: bool, steps: int
) -> None:
    """Improve the coefficients (sections, modes, 2) in place."""
    residuals, rates = _residuals(cells, nodes + cells.shapes @ coefficients, sharp)
    cost = (residuals**2).sum(axis=1)
    damping = np.full(len(nodes), 1e-3)
    going = np.isfinite(cost)

    for _ in range(steps):
        section = np.flatnonzero(going)
        if not len(section):
            return
        step = _step(residuals[section], rates[section], damping[section])
        trial = coefficients[section] + step.reshape(len(section), -1, 2)
        new_residuals, new_rates = _residuals(cells, nodes[section] + cells.shapes @ trial, sharp)
        new_cost = (new_residuals**2).sum(axis=1)

        better = new_cost < cost[section]
        taken = section[better]
        going[taken] = new_cost[better] < (1 - _SETTLED) * cost[taken]
        coefficients[taken], cost[taken] = trial[better], new_cost[better]
        residuals[taken], rates[taken] = new_residuals[better], new_rates[better]
        damping[taken] /= 5
        damping[section[~better]] *= 5


def _step(residuals: np.ndarray, rates: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """Damped Gauss-Newton step (sections, 2 modes)."""
    normal = rates.transpose(0, 2, 1) @ rates
    diagonal = np.einsum("sii->si", normal)  # a view
    diagonal += damping[:, None] * diagonal + 1e-12 * diagonal.max(axis=1, keepdims=True)
    gradient = residuals[:, None] @ rates
    return -np.linalg.solve(normal, gradient.transpose(0, 2, 1))[..., 0]


def _residuals(cells: _Cells, nodes: np.ndarray, sharp: bool) -> tuple[np.ndarray, np.ndarray]:
    """Residuals (sections, residuals) and their rates (..., 2 modes).

    Residuals are infinite where a cell is folded.
    """
    here, ahead, opposite, behind = cells.corners
    to_ahead = _Edge.between(cells, nodes, here, ahead)
    to_behind = _Edge.between(cells, nodes, here, behind)

    (x_ahead, y_ahead), (x_behind, y_behind) = (
        np.moveaxis(edge.vector, -1, 0) for edge in (to_ahead, to_behind)
    )
    area = x_ahead * y_behind - y_ahead * x_behind
    angle = np.arctan2(area, (to_ahead.vector * to_behind.vector).sum(axis=-1))
    folded = (area <= 0).any(axis=1)

    if sharp:
        sine, cosine = np.where(folded[:, None], 1.0, np.sin(angle)), np.cos(angle)
        crooked, rate = cosine / sine**2, -(1 + cosine**2) / sine**3
    else:
        crooked, rate = angle - np.pi / 2, np.ones_like(angle)

    turning = rate[..., None] * (to_behind.turning() - to_ahead.turning())

    weight = np.sqrt(_EVENNESS)
    one = _Edge.between(cells, nodes, here[cells.pairs], ahead[cells.pairs])
    other = _Edge.between(cells, nodes, behind[cells.pairs], opposite[cells.pairs])
    uneven = weight * np.log(one.square / other.square) / 2
    residuals = np.concatenate([crooked, uneven], axis=1)
    residuals[folded] = np.inf
    stretching = weight * (one.stretching() - other.stretching())

    return residuals, np.concatenate([turning, stretching], axis=1)


@dataclass(frozen=True, eq=False)
class _Edge:
    """Edges as vectors (sections, edges, 2), and their squared lengths.

    ``shapes`` (edges, modes) are how they follow the modes.
    """

    vector: np.ndarray
    square: np.ndarray
    shapes: np.ndarray

    @classmethod
    def between(cls, cells: _Cells, nodes: np.ndarray, start: np.ndarray, end: np.ndarray) -> _Edge:
        vector = nodes[:, end] - nodes[:, start]
        return cls(vector, (vector**2).sum(axis=-1), cells.shapes[end] - cells.shapes[start])

    def turning(self) -> np.ndarray:
        """Rates of the edges' directions (sections, edges, 2 modes)."""
        normal = np.stack([-self.vector[..., 1], self.vector[..., 0]], axis=-1)
        return self._rates(normal / self.square[..., None])

    def stretching(self) -> np.ndarray:
        """Rates of the logarithms of the edges' lengths (sections, edges, 2 modes)."""
        return self._rates(self.vector / self.square[..., None])

    def _rates(self, by_vector: np.ndarray) -> np.ndarray:
        rates = self.shapes[:, :, None] * by_vector[:, :, None, :]
        return rates.reshape(*by_vector.shape[:2], -1)
