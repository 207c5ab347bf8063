"""Master of all other weaves: a pattern tells, weft by weft, which warps it passes over.

Open this file in CQ-editor, let SOLVED name a row that `fabric-cad cell` has solved, and run.
A control plane is a cq.Plane, a control section a cq.Wire, a trajectory a cq.Edge and a yarn a
cq.Solid; woven.py draws and sweeps them.
"""

from fabric_cad.masters.woven import parts, solved_row, woven

SOLVED = "build/basket22/solved.csv"
SWEEP = "exact"
# or "multisection": CadQuery's own sweep through the wires, which is near the exact skin only


def over(weft, warp, weave):
    """Whether a weft passes over a warp, both numbered from 0."""
    return weave.pattern[weft][warp] == "1"


def section(swept, number):
    """The section in a yarn's control plane of that number, from 0; return another to replace it.

    For example ``swept.sections[0]`` everywhere: the symmetric section in the middle of a gap.
    """
    return swept.sections[number]


def rule(weave):
    """Weft by weft, over which warps it passes."""
    return [[over(weft, warp, weave) for warp in range(weave.warps)] for weft in range(weave.wefts)]


def cell(fabric):
    """The elementary cell of a solved fabric."""
    return woven(fabric, rule(fabric.weave), section, SWEEP)


if show_object := globals().get("show_object"):  # CQ-editor runs this file
    fabric = solved_row(SOLVED)
    for part in parts(fabric, rule(fabric.weave), section, SWEEP):
        # of every yarn: trajectory, a cq.Edge; control planes, each a cq.Workplane with a frame in
        # it; control sections, a cq.Wire each; the yarn itself, a cq.Solid
        show_object(part.shape, name=part.name, options=part.options)
