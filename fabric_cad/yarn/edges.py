"""What a yarn's own edges allow any hexahedral mesh.

At a point of an edge three lines of every mesh meet: the edge itself and one line in either
side. A hexahedron with a corner there cannot have a larger scaled Jacobian than that of the
three unit tangents, once its size goes to zero: the tip angle and the slope of the edge line
bound it, not the mesher.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol

import numpy as np

from ..model.solved import SolvedFabric
from ..section.splines import Spline
from ..section.strips import Section
from .swept import swept_yarns
from .trajectory import Trajectory

_SAMPLES = 257


def allowed_scaled_jacobian(fabric: SolvedFabric) -> float:
    """Smallest scaled Jacobian of the three tangents over all edge points of the cell.

    A round section has no edge; its outermost line takes its place, where the tangents are
    the line's, an upright and a horizontal.
    """
    return allowed_over(swept_yarns(fabric))


class Swept(Protocol):
    """A yarn, or a part of one: its midline's pieces, and the sections at their ends."""

    @property
    def trajectory(self) -> Trajectory:
        """The midline between the control planes."""

    @property
    def sections(self) -> tuple[Section, ...]:
        """The section in every control plane."""


def allowed_over(parts: Iterable[Swept]) -> float:
    """The same over some yarns, or over the tiles of all of them."""
    worst = 1.0
    known: set[bytes] = set()

    for swept in parts:
        sections = swept.sections
        for piece, first, second in zip(swept.trajectory.pieces, sections, sections[1:]):
            shape = [piece.poles - piece.poles[0], piece.knots - piece.knots[0]]
            shape += [
                _edge(section, *place)[:2] for section in (first, second) for place in _PLACES
            ]
            key = b"".join(np.round(each, 12).tobytes() for each in shape)
            if key not in known:
                known.add(key)
                worst = min(worst, _worst_of(piece, first, second))

    return worst


_PLACES = [(level, end) for end in (0, -1) for level in ("lower", "upper")]


def _edge(section: Section, level: str, end: int) -> tuple[float, float]:
    """Height and slope dz/dv of the lower or upper side at the left (0) or right (-1) edge."""
    poles = section.outermost("left" if end == 0 else "right", level).poles
    (v, z, _), (v_next, z_next, _) = (poles[0], poles[1]) if end == 0 else (poles[-1], poles[-2])
    return z, 0.0 if section.rounded else (z_next - z) / (v_next - v)


def _worst_of(piece: Spline, first: Section, second: Section) -> float:
    """The same between two control planes."""
    share = np.linspace(0.0, 1.0, _SAMPLES)
    length = piece.knots[-1] - piece.knots[0]
    blend, rate = share**2 * (3 - 2 * share), 6 * share * (1 - share) / length
    slope = _slope(piece, share)
    found = []

    for end in (0, -1):
        sides = []
        for level in ("lower", "upper"):
            (z_start, start), (z_stop, stop) = (
                _edge(section, level, end) for section in (first, second)
            )
            sides.append((slope + (z_stop - z_start) * rate, (1 - blend) * start + blend * stop))

        if first.pointed:
            (edge, bottom), (_, top) = sides
            found.append(
                np.abs(top - bottom) / np.sqrt((1 + top**2) * (1 + bottom**2) * (1 + edge**2))
            )
        else:
            found += [1 / np.sqrt((1 + across**2) * (1 + edge**2)) for edge, across in sides]

    return float(np.min(found))


def _slope(piece: Spline, share: np.ndarray) -> np.ndarray:
    """dz/dt of a trajectory piece: linear between its knots."""
    places = piece.knots[piece.degree : -piece.degree]  # ends and inner knots
    rises = piece.degree * np.diff(piece.poles)
    spans = piece.knots[piece.degree + 1 : -1] - piece.knots[1 : -piece.degree - 1]
    slopes = rises / spans
    if piece.degree == 1:
        return np.full_like(share, slopes[0])
    return np.interp(places[0] + share * (places[-1] - places[0]), places, slopes)
