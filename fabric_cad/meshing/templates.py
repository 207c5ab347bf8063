"""Quadrilaterals over a control section, as weights on the nodes of its outline.

A template fills any section with the same number of outline nodes: an inner node is a fixed
linear combination of outline nodes, so a whole yarn is filled by one matrix product. Outline
nodes never move, which is what keeps the contact nodes of two yarns together.

Lenticular sections end in a point. With 2k layers through the thickness, the last 2k columns
before the tip T become three patches of k x k quadrilaterals (drawn for k = 1)::

                    top k        top 2k
                 _.---*------------*---   ---*---
             _.-'      \\           |         |
          T *           * G -------* M       *
             '-._      /           |         |
                 '-.--*------------*---   ---*---
                   bottom k      bottom 2k

M is at mid-height in column 2k, and G on the way there from T: at 2/3 of it where columns are
equally wide, nearer to T where column k is.

Round sections have no corner, so that a block of four sides would degenerate at the points
where arcs and parabolas meet: an inner block is surrounded by one ring of quadrilaterals.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np


@dataclass(frozen=True, eq=False)
class Template:
    """A section's quadrilaterals.

    Nodes are numbered outline first (``outline`` of them, counter-clockwise from the lower
    left corner or left tip, seen against the direction of travel), then the inner ones, of
    which ``weights``, shape (inner, outline), gives the places. ``quads``, shape (quads, 4),
    are counter-clockwise.
    """

    outline: int
    weights: np.ndarray
    quads: np.ndarray


@lru_cache(maxsize=256)
def flat_template(across: int, through: int) -> Template:
    """``across`` x ``through`` quadrilaterals between a section's four corners."""
    outline, bottom, top, left, right = _sides(across, through)
    return numbered(outline, [coons(bottom, top, left, right)])


@lru_cache(maxsize=256)
def lenticular_template(across: int, through: int, near: float = 0.5) -> Template:
    """Quadrilaterals of a section with two pointed edges; ``through`` = 2k is even.

    ``near`` is the distance of column k from the tip over that of column 2k. Raises ValueError
    unless ``across`` is at least twice ``through``.
    """
    if through % 2 or across < 2 * through:
        raise ValueError(f"{across} columns do not hold two pointed edges of {through} layers")
    k = through // 2
    outline = 2 * across
    node = np.eye(outline)
    bottom = node[: across + 1]
    top = np.vstack([node[across:], node[:1]])[::-1]
    core = coons(
        bottom[through : across - through + 1],
        top[through : across - through + 1],
        straight(bottom[through], top[through], through),
        straight(bottom[-through - 1], top[-through - 1], through),
    )
    left = _tip(bottom[: through + 1], top[: through + 1], k, near)
    right = _tip(bottom[::-1][: through + 1], top[::-1][: through + 1], k, near)

    return numbered(outline, [core, *left, *(patch[::-1] for patch in right)])


@lru_cache(maxsize=256)
def round_template(across: int, through: int, inset: tuple[float, float]) -> Template:
    """An inner block of ``across`` x ``through`` in a ring: through + 2 layers in all.

    ``inset`` is the thickness of the ring at the lateral zones and at bottom and top, as
    shares of the section's width and height.
    """
    outline, bottom, top, left, right = _sides(across, through)
    s, t = (
        margin + np.linspace(0.0, 1.0, parts + 1) * (1 - 2 * margin)
        for margin, parts in zip(inset, (across, through))
    )
    block = _coons_at(bottom, top, left, right, s, t)
    ring = [
        np.stack([bottom, block[:, 0]], axis=1),
        np.stack([block[:, -1], top], axis=1),
        np.stack([left, block[0]], axis=0),
        np.stack([block[-1], right], axis=0),
    ]

    return numbered(outline, [block, *ring])


def block_modes(across: int, through: int) -> np.ndarray:
    """Displacements of the inner block of :func:`round_template`, shape (inner, modes), to smooth it by.

    They are bilinear between seven columns, of which two are near either side, and three rows.
    """
    near, far = max(1, round(across / 12)), round(across / 4)
    columns = {0, near, far, round(across / 2), across - far, across - near, across}
    rows = {0, through // 2, through}
    s, t = (
        np.array(
            [np.interp(np.arange(parts + 1), sorted(knots), hat) for hat in np.eye(len(knots))]
        )
        for parts, knots in ((across, columns), (through, rows))
    )
    return np.einsum("ki,lj->ijkl", s, t).reshape((across + 1) * (through + 1), -1)


def _sides(across: int, through: int) -> tuple[int, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Nodes in the outline of a four-sided section, and its bottom, top, left and right as weights on them."""
    outline = 2 * (across + through)
    node = np.eye(outline)
    bottom, right = node[: across + 1], node[across : across + through + 1]
    top = node[across + through : 2 * across + through + 1][::-1]
    left = np.vstack([node[2 * across + through :], node[:1]])[::-1]
    return outline, bottom, top, left, right


def _coons_at(bottom, top, left, right, s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Transfinite patch at the places s x t of the unit square, shape (s, t, outline)."""

    def along(side: np.ndarray, places: np.ndarray) -> np.ndarray:
        grid = np.linspace(0.0, 1.0, len(side))
        return np.array([np.interp(places, grid, column) for column in side.T]).T

    lower, upper, west, east = along(bottom, s), along(top, s), along(left, t), along(right, t)
    s, t = s[:, None, None], t[None, :, None]
    sides = (1 - t) * lower[:, None] + t * upper[:, None] + (1 - s) * west[None] + s * east[None]
    return (
        sides
        - (1 - s) * ((1 - t) * bottom[0] + t * top[0])
        - s * ((1 - t) * bottom[-1] + t * top[-1])
    )


def _tip(bottom: np.ndarray, top: np.ndarray, k: int, near: float) -> list[np.ndarray]:
    """The three patches of a left tip; row 0 of ``bottom`` and of ``top`` is the tip itself."""
    middle = (bottom[2 * k] + top[2 * k]) / 2
    share = min(4 / 3 * near, 0.9)
    centre = (1 - share) * bottom[0] + share * middle
    to_top, to_bottom, to_middle = (straight(centre, end, k) for end in (top[k], bottom[k], middle))
    point = coons(bottom[: k + 1], to_top[::-1], top[: k + 1], to_bottom[::-1])
    upper = coons(to_middle, top[k:], to_top, straight(middle, top[2 * k], k))
    lower = coons(bottom[k:], to_middle, to_bottom[::-1], straight(bottom[2 * k], middle, k))
    return [point, upper, lower]


def straight(start: np.ndarray, end: np.ndarray, parts: int) -> np.ndarray:
    """A straight side between two nodes, as weights (parts + 1, outline)."""
    share = np.linspace(0.0, 1.0, parts + 1)[:, None]
    return (1 - share) * start + share * end


def coons(bottom: np.ndarray, top: np.ndarray, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Transfinite patch between four sides, shape (columns + 1, rows + 1, outline)."""
    patch = _coons_at(
        bottom,
        top,
        left,
        right,
        np.linspace(0.0, 1.0, len(bottom)),
        np.linspace(0.0, 1.0, len(left)),
    )
    patch[:, 0], patch[:, -1], patch[0], patch[-1] = bottom, top, left, right
    return patch


def worst_corner(template: Template, outline: np.ndarray) -> float:
    """Smallest sine of a quadrilateral's corner in sections with the given outlines (..., nodes, 2), mm."""
    nodes = np.concatenate([outline, template.weights @ outline], axis=-2)
    corners = nodes[..., template.quads, :]
    ahead, behind = (np.roll(corners, shift, axis=-2) - corners for shift in (-1, 1))
    cross = ahead[..., 0] * behind[..., 1] - ahead[..., 1] * behind[..., 0]
    return float((cross / np.linalg.norm(ahead, axis=-1) / np.linalg.norm(behind, axis=-1)).min())


def numbered(outline: int, patches: list[np.ndarray]) -> Template:
    """Number the nodes of all patches once and read off the quadrilaterals."""
    numbers: dict[bytes, int] = {}
    weights = list(np.eye(outline))
    for at, row in enumerate(weights):
        numbers[_key(row)] = at
    quads = []
    for patch in patches:
        ids = np.empty(patch.shape[:2], dtype=int)
        for place in np.ndindex(ids.shape):
            key = _key(patch[place])
            if key not in numbers:
                numbers[key] = len(weights)
                weights.append(patch[place])

            ids[place] = numbers[key]

        corners = (ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:])
        quads.append(np.stack([each.ravel() for each in corners], axis=1))

    return Template(outline, np.array(weights[outline:]).reshape(-1, outline), np.vstack(quads))


def _key(weights: np.ndarray) -> bytes:
    return (np.round(weights, 9) + 0.0).tobytes()
