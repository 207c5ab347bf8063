"""Master of the plain weaves: every weft passes over one warp and under the next.

Open this file in CQ-editor, let SOLVED name a row that `fabric-cad cell` has solved, and run.
"""

from fabric_cad.masters.woven import show, woven
from fabric_cad.model.solved import read_solved
from fabric_cad.weave.weaves import Weave

SOLVED = "build/plain/solved.csv"


def cell(fabric):
    """The elementary cell of a solved fabric."""
    weave = Weave(over=1, under=1)
    return woven(fabric, weave.interlacement())


if "show_object" in globals():
    show(cell(read_solved(SOLVED)), show_object)  # noqa: F821
