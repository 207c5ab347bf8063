"""What a yarn's own edges allow any hexahedral mesh.

At a point of an edge three lines of every mesh meet: the edge itself and one line in either
side. A hexahedron with a corner there cannot have a larger scaled Jacobian than that of the
three unit tangents, once its size goes to zero: the tip angle and the slope of the edge line
bound it, not the mesher.
"""

from __future__ import annotations

import numpy as np

from .sections import Section
from .solved import SolvedFabric
from .sweeps import Spline, control_planes, control_sections, trajectory
from .weaves import yarns_of

_SAMPLES = 257


def allowed_scaled_jacobian(fabric: SolvedFabric) -> float:
    """Smallest scaled Jacobian of the three tangents over all edge points of the cell."""
    worst = 1.0
    known: set[bytes] = set()
    for yarn in yarns_of(fabric.weave.interlacement()):
        path = trajectory(fabric, yarn, control_planes(fabric, yarn.direction))
        sections = control_sections(fabric, yarn)
        for piece, first, second in zip(path.pieces, sections, sections[1:]):
            shape = (piece.poles - piece.poles[0], first.top, first.bottom, second.top, second.bottom)
            key = b"".join(np.round(each, 12).tobytes() for each in shape)
            if key not in known:
                known.add(key)
                worst = min(worst, _worst_of(piece, first, second))
    return worst


def _worst_of(piece: Spline, first: Section, second: Section) -> float:
    """The same between two control planes."""
    share = np.linspace(0.0, 1.0, _SAMPLES)
    length = piece.knots[-1] - piece.knots[0]
    blend, rate = share**2 * (3 - 2 * share), 6 * share * (1 - share) / length
    slope = _slope(piece, share)
    found = []
    for end in (0, -1):
        sides = []
        for start, stop in ((first.top, second.top), (first.bottom, second.bottom)):
            edge = slope + (stop[end] - start[end]) * rate
            across = (1 - blend) * _end_slope(first.v, start, end) + blend * _end_slope(first.v, stop, end)
            sides.append((edge, across))
        if first.pointed:
            (edge, top), (_, bottom) = sides
            found.append(np.abs(top - bottom) / np.sqrt((1 + top**2) * (1 + bottom**2) * (1 + edge**2)))
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


def _end_slope(v: np.ndarray, poles: np.ndarray, end: int) -> float:
    """dz/dv of a section's spline at its left (0) or right (-1) edge."""
    a, b = (0, 1) if end == 0 else (-2, -1)
    return (poles[b] - poles[a]) / (v[b] - v[a])
