"""Master of all other weaves: a pattern tells, weft by weft, which warps it passes over.

Open this file in CQ-editor, let SOLVED name a row that `fabric-cad cell` has solved, and run.
A control plane is a cq.Plane, a control section a cq.Wire, a trajectory a cq.Edge, a yarn a cq.Solid.
"""

import cadquery as cq

from fabric_cad.masters.woven import colour_of, draw, solved_row, woven

SOLVED = "build/basket22/solved.csv"
SWEEP = "exact"  # or "multisection": CadQuery's own sweep through the wires, which is near the exact skin only


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


if "show_object" in globals():
    fabric = solved_row(SOLVED)
    solids = cell(fabric).solids

    for name, yarn in draw(fabric, rule(fabric.weave), section).items():
        path: cq.Edge = yarn.path  # M11 ... M16 or M21 ... M26, over the whole cell
        show_object(path, name=f"{name} trajectory")  # noqa: F821

        for number in range(len(yarn.planes)):
            plane: cq.Plane = yarn.planes[number]  # origin on the trajectory, x across, y upwards
            wire: cq.Wire = yarn.wires[number]  # the control section in it
            frame = cq.Workplane(plane).rect(*yarn.frame)
            show_object(frame, name=f"{name} plane {number}")  # noqa: F821
            show_object(wire, name=f"{name} section {number}")  # noqa: F821

        solid: cq.Solid = solids[name]
        show_object(solid, name=name, options={"color": colour_of(name)})  # noqa: F821
