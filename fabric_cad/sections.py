"""Control sections of a yarn: contact side, free side and, where flat, vertical sides.

All profiles are functions of v, the distance across the yarn from its axis, in a control
plane that is vertical and parallel to the cell's faces (paper, Fig. 9, 13, 17; section 4 of
the model). z is measured from the yarn's midline, the envelope rectangle is |v| <= c/2,
|z| <= b/2::

            free side: one parabola                  contact rise G(v) at the edges
           _.-'''''''''''-._                        /
        .-'                 '-.                    |
    T  <                       >  T       or  flat |   (lateral height)
        '--.._           _..--'                    |
              '''-----'''  contact side: G of the crossed yarn
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

KINDS = ("float", "edge", "turn")
"""Contact sections: the crossed yarn floats on both sides (flat contact), turns on the right
side only, turns on both."""


def free_side(thickness, width, rise_left, rise_right, lateral_height):
    """Conic of the free side, z = -+(b/2 - q (v - v0)^2): (q in 1/mm, v0 in mm).

    The parabola touches the envelope rectangle's side and ends ``lateral_height`` from the
    contact profile, which has risen by ``rise_left`` and ``rise_right`` at v = -c/2, +c/2;
    all mm, arrays broadcast. The drops e = b - h - rise must be positive. (Fig. 17)
    """
    root_left = np.sqrt(thickness - lateral_height - rise_left)
    root_right = np.sqrt(thickness - lateral_height - rise_right)
    q = ((root_left + root_right) / width) ** 2
    return q, width / 2 * (root_left - root_right) / (root_left + root_right)


@dataclass(frozen=True, eq=False)
class Section:
    """A control section as quadratic spline poles over v, each array of shape (4,), mm.

    ``v``, ``top`` and ``bottom`` are the poles over the knots -c/2, 0, c/2 (threefold at the
    ends, single at the axis). Sides are vertical segments where top and bottom poles differ
    at an end, a point (lenticular) where they agree exactly.
    """

    v: np.ndarray
    top: np.ndarray
    bottom: np.ndarray

    @property
    def pointed(self) -> bool:
        """True where both lateral zones are points (lenticular)."""
        return self.top[0] == self.bottom[0] and self.top[-1] == self.bottom[-1]


def _across(width: float) -> np.ndarray:
    """Greville abscissae of the section's splines: v itself as a spline."""
    return np.array([-width / 2, -width / 4, width / 4, width / 2])


def _parabola(width: float, q: float, v0: float) -> np.ndarray:
    """Poles of q (v - v0)^2: its polar form at consecutive knots."""
    ends = np.array([-width / 2, -width / 2, 0.0, width / 2, width / 2])
    return q * (ends[:-1] - v0) * (ends[1:] - v0)


def contact_section(
    thickness: float,
    width: float,
    rise_left: float,
    rise_right: float,
    q: float,
    v0: float,
    lateral_height: float,
    contact_below: bool,
) -> Section:
    """Section in a crossing: contact profile on one side, one parabola on the other.

    The contact profile is the crossed yarn's trajectory, half a parabola from the axis to
    each edge that rises by ``rise_left``, ``rise_right`` (0: flat); mm.
    """
    contact = np.array([rise_left, 0.0, 0.0, rise_right]) - thickness / 2
    free = thickness / 2 - _parabola(width, q, v0)
    free[0], free[-1] = contact[0] + lateral_height, contact[-1] + lateral_height
    if contact_below:
        return Section(_across(width), free, contact)
    return Section(_across(width), -contact, -free)


def free_section(thickness: float, width: float, lateral_height: float) -> Section:
    """Section between crossings, where no yarn touches: symmetric, edges at mid-height."""
    q = 2 * (thickness - lateral_height) / width**2
    top = thickness / 2 - _parabola(width, q, 0.0)
    top[0] = top[-1] = lateral_height / 2
    bottom = -top
    if not lateral_height:
        bottom[0] = bottom[-1] = top[0]  # 0.0, not -0.0
    return Section(_across(width), top, bottom)
