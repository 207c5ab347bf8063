"""The two sheets between which the yarns lie, and the layers of matrix from there to the box.

Over every node of the plan grid stands one vertical line::

    crossing            gap of a weft strip      pocket (gap x gap)
    ---- +H/2 ----      ---- +H/2 ----           ---- +H/2 ----
       layers              layers                   layers
    --- high -----      --- high -----           -- high = low --   Coons surface between four tip lines
       upper yarn          weft                     layers
       lower yarn       --- low ------           ---- -H/2 ----
    --- low ------         layers
       layers           ---- -H/2 ----
    ---- -H/2 ----
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..weave.directions import Direction
from .grid import Lines
from .nodes import Nodes
from .yarns import Strip


@dataclass(frozen=True, eq=False)
class Sheets:
    """Node numbers (lines of x, lines of y) of the lowest and of the highest skin on every line of the torus."""

    low: np.ndarray
    high: np.ndarray

    @classmethod
    def empty(cls, x: Lines, y: Lines) -> Sheets:
        """No nodes yet: -1."""
        return cls(np.full((x.count, y.count), -1), np.full((x.count, y.count), -1))

    def along(self, direction: Direction) -> Sheets:
        """The same numbers as (lines along, lines across) a direction: a view of them."""
        return self if direction is Direction.WEFT else Sheets(self.low.T, self.high.T)


def lay_yarns(sheets: Sheets, strips: Sequence[Strip], x: Lines, y: Lines) -> None:
    """Take the yarns' skins into the sheets: alone in the gaps, in crossings as the weave says."""
    for strip in strips:
        own = (y if strip.direction is Direction.WEFT else x).own(strip.index)
        there = sheets.along(strip.direction)
        there.low[:, own], there.high[:, own] = strip.bottom[:-1], strip.top[:-1]

    for strip in strips:
        along, across = (x, y) if strip.direction is Direction.WEFT else (y, x)
        there, own = sheets.along(strip.direction), across.own(strip.index)
        for crossing, high in enumerate(strip.high):
            lines = along.own(crossing)
            if high:
                there.high[np.ix_(lines, own)] = strip.top[lines]
            else:
                there.low[np.ix_(lines, own)] = strip.bottom[lines]


def fill_pockets(sheets: Sheets, nodes: Nodes, x: Lines, y: Lines, reach: int) -> None:
    """Span the sheet of every pocket between its four tip lines, which lie ``reach`` lines off the yarns."""
    for weft in range(y.yarns):
        columns = _pocket(y, weft, reach)
        for warp in range(x.yarns):
            rows = _pocket(x, warp, reach)
            inner = np.ix_(rows[1:-1] % x.count, columns[1:-1] % y.count)
            rim = sheets.low[np.ix_(rows % x.count, columns % y.count)]
            sheets.low[inner] = sheets.high[inner] = nodes.add(
                _coons(nodes.points, rim, (x, rows), (y, columns))
            )


def _pocket(lines: Lines, yarn: int, reach: int) -> np.ndarray:
    """The lines from one yarn's tip to the next one's, counted on beyond the last line of the cell."""
    return lines.first(yarn) + lines.columns + np.arange(reach, lines.between - reach + 1)


def _coons(points: np.ndarray, rim: np.ndarray, *axes: tuple[Lines, np.ndarray]) -> np.ndarray:
    """Places of a pocket's inner nodes from its ``rim`` (rows, columns), whose inner part is not looked at.

    What is blended is how far nodes are from the plan grid, so that it does not matter where the
    cell is cut.
    """
    places, shares = [], []
    for lines, numbers in axes:
        turns, line = np.divmod(numbers, lines.count)
        places.append(lines.places[line])
        unrolled = places[-1] + turns * lines.places[-1]
        shares.append((unrolled - unrolled[0]) / (unrolled[-1] - unrolled[0]))

    grid = np.zeros((*rim.shape, 3))
    grid[..., 0], grid[..., 1] = np.meshgrid(*places, indexing="ij")
    off = points[rim] - grid
    s, t = shares[0][1:-1, None, None], shares[1][None, 1:-1, None]
    sides = (
        (1 - t) * off[1:-1, :1] + t * off[1:-1, -1:] + (1 - s) * off[:1, 1:-1] + s * off[-1:, 1:-1]
    )
    lower = (1 - s) * off[0, 0] + s * off[-1, 0]
    upper = (1 - s) * off[0, -1] + s * off[-1, -1]

    return grid[1:-1, 1:-1] + sides - (1 - t) * lower - t * upper


def layers_of(sheet: np.ndarray, nodes: Nodes, grid: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Node numbers (lines of x, lines of y, layers + 1) of the matrix from a sheet to the box.

    ``grid`` (lines of x, lines of y, 3) are the nodes on the box, mm, ``shares`` (layers + 1,) the
    parts of the way from the sheet, 0, to the box, 1.
    """
    start = nodes.points[sheet]
    places = start[..., None, :] + shares[1:, None] * (grid - start)[..., None, :]
    places[..., -1, :] = grid
    return np.concatenate([sheet[..., None], nodes.add(places)], axis=2)
