"""What the stages of a cell cost at the least: gmsh and OCCT without us. Prints the seconds, imports not among them.

``python tests/floors.py block HEXAHEDRA FILE.msh``: gmsh meshes a transfinite block of as many hexahedra and writes it.
``python tests/floors.py step FILE.step OUT.step``: OCCT writes the shape of a STEP file again.
"""

from __future__ import annotations

import sys
import time


def block(hexahedra: int, out: str) -> float:
    """Seconds of gmsh for a cube of about so many hexahedra, written as gmsh 4.1."""
    import gmsh

    gmsh.initialize(["-nopopup"], readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    start = time.perf_counter()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.setTransfiniteAutomatic()
    along = round(hexahedra ** (1 / 3)) + 1
    for _, curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve, along)
    gmsh.model.addPhysicalGroup(3, [1])
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(out)
    seconds = time.perf_counter() - start
    found = len(gmsh.model.mesh.getElementsByType(5)[0])
    if abs(found / hexahedra - 1) > 0.2:
        raise SystemExit(f"{found} hexahedra where {hexahedra} were asked for")
    return seconds


def step(source: str, out: str) -> float:
    """Seconds of OCCT to write a shape as STEP."""
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Reader, STEPControl_Writer

    reader = STEPControl_Reader()
    reader.ReadFile(source)
    reader.TransferRoots()
    shape = reader.OneShape()
    start = time.perf_counter()
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(out)
    return time.perf_counter() - start


if __name__ == "__main__":
    what, first, second = sys.argv[1:]
    print(block(int(first), second) if what == "block" else step(first, second))
