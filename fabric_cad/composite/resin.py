"""Strips of resin beside flat and round yarns, which make them as pointed as lenticular ones.

A sheet of elements that left one yarn's side would have to pass the neighbour's above it, and no
layer of hexahedra does that. So each side gets a strip of resin with a triangular section::

        top |__                       base: the yarn's side, flat or of two arcs, 2k edges
            |  ''--__  upper          sheets: ``reach`` = n lines of the plan grid, n > k
       side |        >* apex
            |  __--''  lower
     bottom |''

In a crossing the strip of the upper yarn lies on the lower one's top, that of the lower one under
the upper one's bottom. In the corner of n x n lines beside both yarns the two strips share the
sheet

    upper yarn's edge + lower yarn's edge - corner of the crossing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..weave.directions import Direction
from .grid import Lines
from .nodes import Nodes
from .resin_mesh import Resin
from .sheets import Sheets
from .yarns import Strip, of_direction

_BULGE = 4.5
"""Beside arcs the sheets' heights go as this power of the way to the apex.

An arc leaves the yarn's bottom with its slope. So do the sheets, hugging the fabric's faces before
they come together, or they would lie along the arc: on the row twill22_round straight ones make
corners of 4 degrees.
"""

Corners = Mapping[tuple[int, int, bool, bool], np.ndarray]
"""(weft, warp, right of the warp, right of the weft) to the nodes (n + 1 lines of x, n + 1 lines of y) of a sheet."""


def corner_sheets(strips: Sequence[Strip], nodes: Nodes, x: Lines, y: Lines, reach: int) -> Corners:
    """The sheets that the strips of both yarns share, ``reach`` lines wide, at the corners of every crossing."""
    wefts, warps = of_direction(strips, Direction.WEFT), of_direction(strips, Direction.WARP)
    corners = {}
    for i, weft in enumerate(wefts):
        for j, warp in enumerate(warps):
            over = weft.high[j]
            for right_x in (False, True):
                for right_y in (False, True):
                    rows, columns = x.outwards(j, right_x, reach), y.outwards(i, right_y, reach)
                    ours = (weft.bottom if over else weft.top)[rows, -1 if right_y else 0]
                    theirs = (warp.top if over else warp.bottom)[columns, -1 if right_x else 0]
                    corners[i, j, right_x, right_y] = _corner(nodes, ours, theirs)
    return corners


def _corner(nodes: Nodes, ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """The sheet over a weft's and a warp's edge, which begin in one node: (lines of x, lines of y)."""
    points = nodes.points
    places = points[ours[1:], None] + points[theirs[None, 1:]] - points[ours[0]]
    sheet = np.empty((len(ours), len(theirs)), dtype=int)
    sheet[:, 0], sheet[0] = ours, theirs
    sheet[1:, 1:] = nodes.add(places)
    return sheet


def lay_resin(
    strip: Strip,
    right: bool,
    crossed: Sequence[Strip],
    corners: Corners,
    nodes: Nodes,
    axes: tuple[Lines, Lines],
) -> Resin:
    """The strip of resin at one side of a yarn; ``axes`` are the lines along and across it."""
    along, across = axes
    reach = next(iter(corners.values())).shape[0] - 1
    edge = -1 if right else 0
    lines = across.outwards(strip.index, right, reach)
    lower, upper = np.full((2, along.count, reach + 1), -1)
    lower[:, 0], upper[:, 0] = strip.bottom[:-1, edge], strip.top[:-1, edge]
    is_lowest, is_highest = np.full((2, along.count), True)

    for number, (other, high) in enumerate(zip(crossed, strip.high)):
        taken, is_last = (lower, is_lowest) if high else (upper, is_highest)
        is_last[along.own(number)] = False
        taken[along.own(number)] = (other.top if high else other.bottom)[lines].T
        for end in (False, True):
            if strip.direction is Direction.WEFT:
                corner = corners[strip.index, number, end, right]
            else:
                corner = corners[number, strip.index, right, end].T

            beside = along.outwards(number, end, reach)[1:]
            taken[beside], is_last[beside] = corner[1:], False

    share = np.abs(across.places[lines] - across.places[lines[0]])
    share = np.column_stack([share, share, share]) / share[-1]
    share[:, 2] **= _BULGE if across.side else 1.0

    for sheet, other in ((lower, upper), (upper, lower)):
        alone = np.flatnonzero((sheet[:, -1] < 0) & (other[:, -1] >= 0))
        sheet[alone, -1] = other[alone, -1]
        # the strip's height over them falls to the apex: the two never cross
        places = nodes.points[other[alone]]
        height = nodes.points[sheet[alone, :1]] - places[:, :1]
        sheet[alone, 1:-1] = nodes.add((places + (1 - share) * height)[:, 1:-1])

    for number in range(along.yarns):
        _between((lower, upper), nodes, share, along, number)

    return Resin(
        strip.direction, right, lower, upper, strip.side(right)[:-1], lines, is_lowest, is_highest
    )


def _between(
    sheets: tuple[np.ndarray, np.ndarray],
    nodes: Nodes,
    share: np.ndarray,
    along: Lines,
    crossing: int,
) -> None:
    """Fill in the sheets (stations, reach + 1) in the middle of the gap after a crossing, in place.

    How far the apex is from mid-height of the yarn's side, and the sheets from their
    :func:`_lines_to_apex`, goes over from one end of the middle part to the other.
    """
    reach = len(share) - 1
    lines = along.first(crossing) + along.columns + np.arange(reach, along.between - reach + 1)
    turns, rows = np.divmod(lines, along.count)
    if len(rows) < 3:
        return

    places = along.places[rows] + turns * along.places[-1]
    way = ((places - places[0]) / (places[-1] - places[0]))[1:-1, None]
    points, inner, ends = nodes.points, rows[1:-1], rows[[0, -1]]
    middle = (points[sheets[0][rows, 0]] + points[sheets[1][rows, 0]]) / 2
    off = points[sheets[0][ends, -1]] - middle[[0, -1]]
    apex = nodes.add(middle[1:-1] + (1 - way) * off[0] + way * off[1])

    for sheet in sheets:
        bend = points[sheet[ends]] - _lines_to_apex(points, sheet[ends], share)
        sheet[inner, -1] = apex
        blend = (1 - way[..., None]) * bend[0] + way[..., None] * bend[1]
        sheet[inner, 1:-1] = nodes.add(
            (_lines_to_apex(nodes.points, sheet[inner], share) + blend)[:, 1:-1]
        )


def _lines_to_apex(points: np.ndarray, sheet: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Places (stations, reach + 1, 3) on lines from the yarn to the apex of a sheet.

    ``share`` (reach + 1, 3) of the way in x, y and z.
    """
    start, end = points[sheet[:, :1]], points[sheet[:, -1:]]
    return (1 - share) * start + share * end


def lay_resins(sheets: Sheets, resins: Sequence[Resin]) -> None:
    """Take the strips of resin into the sheets between which all that lies at mid-height is."""
    for resin in resins:
        there = sheets.along(resin.direction)
        outside = resin.across[1:]
        below, above = there.low[:, outside], there.high[:, outside]
        there.low[:, outside] = np.where(resin.is_lowest[:, None], resin.lower[:, 1:], below)
        there.high[:, outside] = np.where(resin.is_highest[:, None], resin.upper[:, 1:], above)


def reach_of(strips: Sequence[Strip], lines: Lines) -> int:
    """The lines that strips of resin take: none beside pointed sections, else those over the arcs and k + 1 more."""
    edges = strips[0].left.shape[1] - 1
    return lines.side + edges // 2 + 1 if edges else 0


def lay_all_resin(
    sheets: Sheets, strips: Sequence[Strip], nodes: Nodes, axes: tuple[Lines, Lines], reach: int
) -> list[Resin]:
    """The strips of resin at all sides of all yarns, taken into the sheets."""
    corners = corner_sheets(strips, nodes, *axes, reach)
    resins = []
    for strip in strips:
        crossed = of_direction(strips, strip.direction.other)
        own = axes if strip.direction is Direction.WEFT else axes[::-1]
        resins += [lay_resin(strip, right, crossed, corners, nodes, own) for right in (False, True)]
    lay_resins(sheets, resins)
    return resins
