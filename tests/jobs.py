"""CalculiX jobs small enough for a closed form: one block pulled, and two blocks pressed together."""

import shutil

import pytest

needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="ccx is not installed")

YOUNG, POISSON, LENGTH = 1000.0, 0.3, 2.0  # MPa, -, mm; the section is 1 mm2

BLOCK = f"""*NODE, NSET=all
1, 0, 0, 0
2, {LENGTH}, 0, 0
3, {LENGTH}, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, {LENGTH}, 0, 1
7, {LENGTH}, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8, ELSET=block
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=left
1, 4, 5, 8
*NSET, NSET=right
2, 3, 6, 7
*NSET, NSET=front
1, 2, 5, 6
*NSET, NSET=bottom
1, 2, 3, 4
*MATERIAL, NAME=m
*ELASTIC
{YOUNG}, {POISSON}
*SOLID SECTION, ELSET=block, MATERIAL=m
*BOUNDARY
left, 1, 1
front, 2, 2
bottom, 3, 3
"""

OUTPUT = """*NODE FILE
U, RF
*EL FILE
S, E
*NODE PRINT, NSET=right, TOTALS=ONLY
RF
*EL PRINT, ELSET=block, TOTALS=ONLY
ELSE, EVOL
"""


def step(load, static="1., 1., 1e-6", nlgeom=True, output=OUTPUT, direct=False):
    """One static step; ``load`` is the text of its boundary or load cards; ``direct``: equal increments."""
    cards = f"*STEP, INC=1000000{', NLGEOM' if nlgeom else ''}\n*STATIC{', DIRECT' if direct else ''}\n{static}\n"
    return f"{cards}{load}\n{output}*END STEP\n"


def pulled(displacement):
    return f"*BOUNDARY\nright, 1, 1, {displacement!r}"


def pushed(force):
    """A dead load on the whole section, N."""
    return f"*CLOAD\nright, 1, {-force / 4!r}"


def endless():
    """A job of a million increments."""
    return BLOCK + step(pulled(0.02), "1e-6, 1.", output="*NODE FILE\nU\n", direct=True)


STIFFNESS = 1e4  # of the contact, N/mm3

# cubes of 1 mm, one on the other, node 9 over node 5; only faces 5-8 and 9-12 touch
TWO_BLOCKS = f"""*NODE, NSET=all
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
9, 0, 0, 1
10, 1, 0, 1
11, 1, 1, 1
12, 0, 1, 1
13, 0, 0, 2
14, 1, 0, 2
15, 1, 1, 2
16, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=blocks
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 9, 10, 11, 12, 13, 14, 15, 16
*NSET, NSET=foot
1, 2, 3, 4
*NSET, NSET=head
13, 14, 15, 16
*NSET, NSET=left
1, 4, 5, 8, 9, 12, 13, 16
*NSET, NSET=front
1, 2, 5, 6, 9, 10, 13, 14
*SURFACE, NAME=above
2, S1
*SURFACE, NAME=below
1, S2
*SURFACE INTERACTION, NAME=touch
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
{STIFFNESS}
*CONTACT PAIR, INTERACTION=touch, TYPE=SURFACE TO SURFACE
above, below
*MATERIAL, NAME=m
*ELASTIC
{YOUNG}, 0.
*SOLID SECTION, ELSET=blocks, MATERIAL=m
*BOUNDARY
foot, 3, 3
left, 1, 1
front, 2, 2
"""


def pressed(displacement):
    """The step that brings the head of two blocks down."""
    return f"""*STEP, INC=100
*STATIC
1., 1., 1e-6
*BOUNDARY
head, 3, 3, {-displacement!r}
*NODE FILE
U, RF
*EL FILE
S
*CONTACT FILE
CDIS, CSTR
*NODE PRINT, NSET=head, TOTALS=ONLY
RF
*CONTACT PRINT, TOTALS=ONLY
CELS, CNUM
*CONTACT PRINT, SLAVE=above, MASTER=below
CF
*END STEP
"""
