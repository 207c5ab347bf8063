"""Control sections of a yarn: contact side, free side and the lateral zones between them.

All profiles are functions of v, the distance across the yarn from its axis, in a control
plane that is vertical and parallel to the cell's faces (paper, Fig. 9, 13, 17; section 4 of
the model). z is measured from the yarn's midline, the envelope rectangle is |v| <= c/2,
|z| <= b/2::

            free side: one parabola                  contact rise G(v) at the edges
           _.-'''''''''''-._                        /
        .-'                 '-.                    |
    T  <                       >  T       or  flat |   or  round (
        '--.._           _..--'                    |
              '''-----'''  contact side: G of the crossed yarn

The contact side is the crossed yarn's trajectory, G = 0 for |v| <= d_c and p (|v| - d_c)^2
beyond (0 on a side where that yarn floats on), out to the contact chord. From there a pointed
or flat section carries the parabola on to its edge, a round one turns off on a circular arc;
the crossed yarn goes straight, so that the two only move apart.
"""

from __future__ import annotations

from functools import lru_cache

from .forms import contact_strips, free_strips
from .frame import ContactSide, Frame, FreeSide
from .strips import Section, joined, upside_down


@lru_cache(maxsize=256)
def contact_section(
    frame: Frame, contact: ContactSide, turns: tuple[bool, bool], free: FreeSide, below: bool
) -> Section:
    """Section in a crossing: contact profile on one side, free parabola on the other.

    ``turns`` says whether the crossed yarn changes sides just left and right of this one,
    ``below`` whether the contact is on the bottom. The same arguments give the same section
    again: the yarns of a cell share theirs. (Fig. 9, 17)
    """
    if not below:
        return upside_down(contact_section(frame.upside_down, contact, turns, free, below=True))
    return joined(contact_strips(frame.form, frame, contact, turns, free))


@lru_cache(maxsize=256)
def free_section(frame: Frame, between: FreeSide) -> Section:
    """Section between crossings, where no yarn touches: symmetric, edges at mid-height."""
    return joined(free_strips(frame.form, frame, between))
