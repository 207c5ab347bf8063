"""The conics of a section from its envelope and its contact profile; whole tables at once."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np

Values: TypeAlias = Any
"""A number or an array of them; those of one call broadcast."""


class Arc(NamedTuple):
    """A circular arc of a lateral zone: radius R and height of its centre above the midline, mm."""

    radius: Values
    centre: Values


def free_parabola(
    thickness: Values, width: Values, rise_left: Values, rise_right: Values, lateral_height: Values
) -> tuple[Values, Values]:
    """Conic of the free side between two edges: (q in 1/mm, v0 in mm).

    The parabola touches the envelope rectangle's side and ends ``lateral_height`` from the
    contact profile, which has risen by ``rise_left`` and ``rise_right`` at v = -c/2, +c/2;
    all mm, arrays broadcast. The drops e = b - h - rise must be positive. (Fig. 17)
    """
    root_left = np.sqrt(thickness - lateral_height - rise_left)
    root_right = np.sqrt(thickness - lateral_height - rise_right)

    q = ((root_left + root_right) / width) ** 2
    return q, width / 2 * (root_left - root_right) / (root_left + root_right)


def lateral_arc(
    thickness: Values, width: Values, half_chord: Values, rise: Values, slope: Values
) -> Arc:
    """Arc of a round lateral zone.

    Tangent to the contact profile at its end v = ``half_chord``, where that has risen by
    ``rise`` with ``slope``, and to the rectangle's side; arrays broadcast. (Fig. 17)
    """
    root = np.sqrt(1 + np.square(slope))
    radius = (width / 2 - half_chord) / (1 - slope / root)
    return Arc(radius, rise - thickness / 2 + radius / root)


def round_free_side(
    thickness: Values, width: Values, arc_left: Arc, arc_right: Arc
) -> tuple[np.ndarray, ...]:
    """Free parabola of a round section, tangent to both arcs: (q, v0, left, right), mm and 1/mm.

    With x = 1/sin(theta) at a point of tangency, tangency to one arc is the cubic
    x^3 - (4 q D + 1) x + 4 q R = 0, D the centre's depth below the rectangle's side; its
    largest root in closed form leaves one unknown, q, found by bisection. Arrays broadcast;
    NaN where an arc does not fit below the rectangle's side.
    """
    arcs = [
        Arc(*(np.asarray(value, dtype=float) for value in arc)) for arc in (arc_left, arc_right)
    ]
    depths = [np.asarray(thickness) / 2 - arc.centre for arc in arcs]
    fits = np.all([depth > arc.radius for arc, depth in zip(arcs, depths)], axis=0)

    low, high = (np.log(np.full(np.shape(fits), bound) / width) for bound in (1e-9, 1e9))
    with np.errstate(invalid="ignore"):
        for _ in range(100):
            middle = (low + high) / 2
            vertices = [_tangency(np.exp(middle), width, *side)[0] for side in zip(arcs, depths)]
            wide = vertices[0] + vertices[1] > 0  # the vertices pass each other: q is too large
            low, high = np.where(wide, low, middle), np.where(wide, middle, high)

        q = np.exp((low + high) / 2)
        (_, left), (vertex, right) = (_tangency(q, width, *side) for side in zip(arcs, depths))

    return tuple(np.where(fits, value, np.nan) for value in (q, vertex, -left, right))


def _tangency(q: Values, width: Values, arc: Arc, depth: Values) -> tuple[Values, Values]:
    """Distance of the parabola's vertex and of the point of tangency from the axis, outwards, mm."""
    P, Q = 4 * q * depth + 1, 4 * q * arc.radius
    angle = np.arccos(np.clip(-1.5 * Q / P * np.sqrt(3 / P), -1, 1)) / 3
    x = 2 * np.sqrt(P / 3) * np.cos(angle)

    slope = np.sqrt(np.maximum(x**2 - 1, 0.0))  # of the parabola where it meets the arc
    touch = width / 2 - arc.radius + arc.radius * slope / x
    return touch - slope / (2 * q), touch


def round_between(thickness: Values, width: Values, half_chord: Values) -> tuple[Values, Values]:
    """Round section between crossings: (q, tan(theta/2)) of its parabolas and arcs.

    Parabolas and arcs meet at |v| = ``half_chord`` with slope cot(theta); mm, arrays
    broadcast. The arc fits where tan(theta/2) <= 1.
    """
    a, b, c = half_chord / 4, thickness / 2, half_chord * 3 / 4 - width / 2
    half = (-b + np.sqrt(b * b - 4 * a * c)) / (2 * a)
    return (1 - half**2) / (4 * half * half_chord), half
