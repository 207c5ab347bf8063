"""What the plots draw: points of splines and of sections, and the yarn that is asked for."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from ...model.solved import SolvedFabric
from ...section.splines import Spline
from ...section.strips import Section
from ...weave.bodies import Body
from ...weave.directions import Direction
from ...weave.weaves import Yarn, yarns_of

POINTS = 41
"""Points on a curve, unless a number is given."""

_COUNTER_CLOCKWISE = (
    ("left_lower", False),
    ("bottom", False),
    ("right_lower", False),
    ("right", False),
    ("right_upper", True),
    ("top", True),
    ("left_upper", True),
    ("left", True),
)
"""A section's sides as they follow each other, and whether their strips are run backwards."""


def sample(spline: Spline, points: int = POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Places along a spline and its heights there, each of shape (points,), mm."""
    places = np.linspace(spline.knots[0], spline.knots[-1], points)
    return places, BSpline(spline.knots, spline.poles, spline.degree)(places)


def section_outline(section: Section, points: int = POINTS) -> tuple[np.ndarray, np.ndarray]:
    """The closed outline (v, z) of a section, counter-clockwise from its left edge, mm."""
    curves = []
    for side, backwards in _COUNTER_CLOCKWISE:
        if side in section.strips:
            curve = section.strips[side].at(np.linspace(0.0, 1.0, points))
            curves.append(curve[::-1] if backwards else curve)

    v, z = np.vstack([*curves, curves[0][:1]]).T
    return v, z


def yarn_of(fabric: SolvedFabric, direction: str, number: int) -> Yarn:
    """The yarn of a direction with that number, from 1."""
    body = Body.yarn(Direction(direction), number - 1)
    return next(yarn for yarn in yarns_of(fabric.weave.interlacement()) if yarn.body == body)


def along_label(direction: str) -> str:
    """What an axis along a direction's yarns is called."""
    return f"{'xy'[Direction(direction).axis]} mm"
