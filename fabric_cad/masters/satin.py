"""Master of the satins of N harnesses: a weft passes over one warp; the next starts `step` warps on.

Open this file in CQ-editor, let SOLVED name a row that `fabric-cad cell` has solved, and run.
"""

from fabric_cad.masters.woven import show, woven
from fabric_cad.model.solved import read_solved
from fabric_cad.weave.weaves import Weave

SOLVED = "build/satin8/solved.csv"


def cell(fabric):
    """The elementary cell of a solved fabric."""
    weave = Weave(over=1, under=fabric.weave.under, step=fabric.weave.step)
    return woven(fabric, weave.interlacement())


if "show_object" in globals():
    show(cell(read_solved(SOLVED)), show_object)  # noqa: F821
