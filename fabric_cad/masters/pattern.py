"""Master of all other weaves: a pattern tells, weft by weft, which warps it passes over.

Open this file in CQ-editor, let SOLVED name a row that `fabric-cad cell` has solved, and run.
"""

from fabric_cad.masters.woven import show, woven
from fabric_cad.model.solved import read_solved
from fabric_cad.weave.weaves import Weave

SOLVED = "build/basket22/solved.csv"


def cell(fabric):
    """The elementary cell of a solved fabric."""
    weave = Weave(pattern=fabric.weave.pattern)
    return woven(fabric, weave.interlacement())


if "show_object" in globals():
    show(cell(read_solved(SOLVED)), show_object)  # noqa: F821
