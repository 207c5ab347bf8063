"""Hexahedra of the strips of resin that :mod:`fabric_cad.composite.resin` lays beside flat and round yarns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..meshing.templates import Template, coons, numbered, straight
from ..weave.directions import Direction
from .nodes import Nodes


@dataclass(frozen=True, eq=False)
class Resin:
    """The strip of resin at one side of a yarn, on the torus.

    ``lower`` and ``upper`` (stations, reach + 1) are its sheets' nodes, from the yarn to the apex;
    ``side`` (stations, 2k + 1) those of the yarn's side, upwards; ``across`` the lines it covers.
    ``is_lowest`` and ``is_highest`` (stations,) tell where no yarn lies below and above it.
    """

    direction: Direction
    right: bool
    lower: np.ndarray
    upper: np.ndarray
    side: np.ndarray
    across: np.ndarray
    is_lowest: np.ndarray
    is_highest: np.ndarray

    @property
    def template(self) -> Template:
        """The section's quadrilaterals."""
        return triangle(self.lower.shape[1] - 1, (self.side.shape[1] - 1) // 2)


@lru_cache(maxsize=64)
def triangle(reach: int, half: int) -> Template:
    """Quadrilaterals of a strip's section with ``reach`` columns and a base of 2 ``half`` edges.

    Outline counter-clockwise from the base's lower end: lower sheet, apex, upper sheet, base. Three
    patches meet in a point between the base's middle and the line where the last ``half`` columns
    begin.
    """
    outline = 2 * reach + 2 * half
    node = np.eye(outline)
    lower, upper = node[: reach + 1], node[reach : 2 * reach + 1][::-1]
    base = np.vstack([node[2 * reach :], node[:1]])[::-1]

    split = reach - half
    centre = 0.3 * base[half] + 0.35 * (lower[split] + upper[split])
    to_base = straight(base[half], centre, split)
    to_lower, to_upper = straight(lower[split], centre, half), straight(centre, upper[split], half)
    beneath = coons(lower[: split + 1], to_base, base[: half + 1], to_lower)
    above = coons(to_base, upper[: split + 1], base[half:], to_upper)
    point = coons(lower[split:], to_upper, to_lower, upper[split:][::-1])

    return numbered(outline, [beneath, above, point])


def resin_nodes(resin: Resin, nodes: Nodes) -> np.ndarray:
    """Node numbers (stations, nodes) of a strip's section, in the order of its :func:`triangle`."""
    outline = np.hstack([resin.lower, resin.upper[:, -2::-1], resin.side[:, -2:0:-1]])
    inner = np.einsum("io,roc->ric", resin.template.weights, nodes.points[outline])
    return np.hstack([outline, nodes.add(inner)])


def resin_hexahedra(resin: Resin, numbers: np.ndarray) -> np.ndarray:
    """Hexahedra (elements, 8) of a strip from its nodes (stations + 1, nodes), in the order of its :func:`triangle`."""
    ahead = (resin.direction is Direction.WEFT) == resin.right
    quads = resin.template.quads if ahead else resin.template.quads[:, ::-1]
    return np.concatenate([numbers[:-1][:, quads], numbers[1:][:, quads]], axis=2).reshape(-1, 8)
