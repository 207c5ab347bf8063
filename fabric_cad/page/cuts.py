"""A fabric cut by an upright plane along its wefts or its warps: the outlines of the yarns it meets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..comparison.present import heights_of_skin
from ..model.solved import SolvedFabric
from ..weave.bodies import YarnBody
from ..weave.directions import Direction
from ..weave.weaves import yarns_of
from ..yarn.profiles import cut
from ..yarn.swept import SweptYarn

_PER_CROSSING = 24  # intervals along a yarn that is cut lengthwise
_ACROSS = np.linspace(0.0, 1.0, 13)  # shares of a strip
_ORDER = ("left_lower", "bottom", "right_lower", "right_upper", "top", "left_upper")


@dataclass(frozen=True, eq=False)
class CutYarn:
    """A yarn in a cut: the closed ``outline`` (points, 2), along the plane and z, and its ``midline`` or centre, mm."""

    body: YarnBody
    outline: np.ndarray
    midline: np.ndarray


@dataclass(frozen=True, eq=False)
class Cut:
    """A cut of the cell along ``direction``, at ``place`` (mm) across: yarns it runs along, then those it crosses."""

    direction: Direction
    place: float
    length: float
    yarns: tuple[CutYarn, ...]


def cut_fabric(fabric: SolvedFabric, direction: Direction, place: float) -> Cut:
    """Cut a cell by the plane along the yarns of a direction, ``place`` mm from the cell's side, 0 to the period."""
    yarns = [SweptYarn(fabric, yarn) for yarn in yarns_of(fabric.weave.interlacement())]
    along = [_lengthwise(swept, place) for swept in yarns if swept.yarn.direction == direction]
    across = [_crosswise(swept, place) for swept in yarns if swept.yarn.direction != direction]
    met = tuple(yarn for yarn in (*along, *across) if yarn is not None)
    return Cut(direction, place, fabric.period[direction.axis], met)


def _lengthwise(swept: SweptYarn, place: float) -> CutYarn | None:
    """A yarn cut along its own axis or beside it; None where the plane passes it."""
    across = place - swept.trajectory.axis
    solved = swept.fabric.directions[swept.yarn.direction]
    if abs(across) >= solved.width / 2:
        return None

    crossings = len(swept.yarn.high)
    t = np.linspace(0.0, crossings * solved.crossed_spacing, _PER_CROSSING * crossings + 1)
    bottom, top = (
        z[:, 0] for z in heights_of_skin(swept.fabric, swept.yarn, t, np.array([across]))
    )
    outline = np.column_stack([np.concatenate([t, t[::-1]]), np.concatenate([bottom, top[::-1]])])
    return CutYarn(swept.yarn.body, outline, np.column_stack([t, _midline(swept, t)]))


def _crosswise(swept: SweptYarn, place: float) -> CutYarn:
    """A yarn cut across its axis."""
    bounds = [plane.place for plane in swept.planes]
    segment = int(np.clip(np.searchsorted(bounds, place, side="right") - 1, 0, len(bounds) - 2))
    place = min(max(place, bounds[segment]), bounds[segment + 1])
    patches = {patch.side: patch for patch in swept.skin.patches if patch.segment == segment}

    pieces = []
    for side in (side for side in _ORDER if side in patches):
        profile = cut(patches[side], np.array([place]), _ACROSS)
        piece = np.column_stack([swept.trajectory.axis + profile.v[0], profile.z[0]])
        pieces.append(piece[::-1] if side == "top" or side.endswith("_upper") else piece)

    centre = np.array([[swept.trajectory.axis, _midline(swept, np.array([place]))[0]]])
    return CutYarn(swept.yarn.body, np.vstack(pieces), centre)


def _midline(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Heights (places,) of a yarn's midline, mm."""
    from scipy.interpolate import BSpline

    pieces = swept.trajectory.pieces
    starts = np.array([piece.knots[0] for piece in pieces])
    number = np.clip(np.searchsorted(starts, places, side="right") - 1, 0, len(pieces) - 1)
    heights = np.empty(len(places))
    for piece in np.unique(number):
        spline, own = pieces[piece], number == piece
        heights[own] = BSpline(spline.knots, spline.poles, spline.degree)(places[own])
    return heights
