"""The cell as an assembly of named, coloured solids: written as STEP, read back from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cadquery as cq
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from ..colours import COLOURS
from ..errors import BuildError
from ..weaves import direction_of


@dataclass(frozen=True)
class Cell:
    """The elementary cell as CAD: an assembly ``cell`` with one named, coloured solid a yarn."""

    assembly: cq.Assembly

    @property
    def solids(self) -> dict[str, cq.Solid]:
        """Yarn name to solid, wefts first."""
        return {child.name: child.obj for child in self.assembly.children}

    def write_step(self, path: str | Path) -> None:
        """Write the cell as STEP AP214, mm. Raises :class:`BuildError` where OCCT cannot."""
        self.assembly.export(str(path), exportType="STEP", write_pcurves=False)
        if not Path(path).exists():
            raise BuildError(f"{path}: OCCT wrote no STEP file")


def assemble(yarns: dict[str, cq.Solid]) -> Cell:
    """The cell of named yarns (``weft_1``, ..., ``warp_1``, ...)."""
    assembly = cq.Assembly(name="cell")
    for name, solid in yarns.items():
        assembly.add(solid, name=name, color=cq.Color(*COLOURS[direction_of(name)]))
    return Cell(assembly)


def read_step(path: str | Path) -> dict[str, cq.Solid]:
    """Yarn name to solid from a STEP file of a cell, in file order.

    Raises :class:`BuildError` where the file does not hold one named solid a yarn.
    """
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    if reader.ReadFile(str(path)) != IFSelect_RetDone:
        raise BuildError(f"{path}: cannot be read as STEP")
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    try:
        if not reader.Transfer(document):
            raise BuildError(f"{path}: cannot be read as STEP")
        solids: dict[str, cq.Solid] = {}
        for name, shape in _parts(document):
            found = shape.Solids()
            if len(found) != 1 or name in solids:
                raise BuildError(f"{path}: {name} is not one solid of its own name")
            solids[name] = found[0]
    finally:
        document.Main().Root().ForgetAllAttributes(True)  # else every file read stays in memory
    if not solids:
        raise BuildError(f"{path}: holds no assembly of solids")
    return solids


def _parts(document: TDocStd_Document) -> Iterator[tuple[str, cq.Shape]]:
    """Name and shape, in its place, of every part of the assemblies in a document."""
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    roots = TDF_LabelSequence()
    shapes.GetFreeShapes(roots)
    for root in (roots.Value(k) for k in range(1, roots.Length() + 1)):
        parts = TDF_LabelSequence()
        shapes.GetComponents_s(root, parts, True)
        for part in (parts.Value(k) for k in range(1, parts.Length() + 1)):
            name = TDataStd_Name()
            named = part.FindAttribute(TDataStd_Name.GetID_s(), name)
            yield name.Get().ToExtString() if named else "", cq.Shape.cast(shapes.GetShape_s(part))
