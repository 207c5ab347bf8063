"""Master of the twills m*n: a weft passes over m warps, then under n; the next starts one warp on.

Open this file in CQ-editor, let SOLVED name a row that `fabric-cad cell` has solved, and run.
"""

from fabric_cad.masters.woven import show, woven
from fabric_cad.model.solved import read_solved
from fabric_cad.weave.weaves import Weave

SOLVED = "build/twill32/solved.csv"


def cell(fabric):
    """The elementary cell of a solved fabric."""
    weave = Weave(over=fabric.weave.over, under=fabric.weave.under, step=1)
    return woven(fabric, weave.interlacement())


if "show_object" in globals():
    show(cell(read_solved(SOLVED)), show_object)  # noqa: F821
