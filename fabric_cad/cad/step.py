"""The cell as an assembly of named, coloured solids: written as STEP, read back from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import cadquery as cq
from cadquery.occ_impl.assembly import toCAF
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color
from OCP.STEPCAFControl import STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.STEPConstruct import STEPConstruct, STEPConstruct_Styles
from OCP.STEPControl import STEPControl_AsIs
from OCP.StepRepr import StepRepr_HArray1OfRepresentationItem, StepRepr_NextAssemblyUsageOccurrence
from OCP.StepVisual import StepVisual_MechanicalDesignGeometricPresentationRepresentation
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_DocumentTool
from OCP.XSControl import XSControl_WorkSession

from .. import __version__
from ..support.errors import BuildError
from ..weave.bodies import Body
from ..weave.colours import colour_of

_NO_TIME = "1970-01-01T00:00:00"
"""The header's time: none, for the same cell makes the same file. ``report.json`` has the date."""


@dataclass(frozen=True)
class Cell:
    """The elementary cell as CAD: an assembly ``cell`` with one named, coloured solid a yarn.

    ``name`` is that of the fabric's row, "" where it is not known.
    """

    assembly: cq.Assembly
    name: str = ""

    @property
    def solids(self) -> dict[str, cq.Solid]:
        """Yarn name to solid, wefts first. Raises :class:`BuildError` where a part is none."""
        solids = {}
        for part in self.assembly.children:
            if not isinstance(part.obj, cq.Solid):
                raise BuildError(f"{part.name} is no solid")
            solids[part.name] = part.obj
        return solids

    def write_step(self, path: str | Path) -> None:
        """Write the cell as STEP AP214, mm.

        The same bytes for the same cell and version of this program and OCCT: the header names the
        row and the version; its time is a fixed one. Raises :class:`BuildError` where OCCT cannot.
        """
        session = XSControl_WorkSession()
        writer = STEPCAFControl_Writer(session, False)
        writer.SetNameMode(True)
        writer.SetColorMode(False)  # OCCT's own order of colours changes from run to run
        Interface_Static.SetIVal_s("write.surfacecurve.mode", 0)
        Interface_Static.SetIVal_s("write.precision.mode", 0)
        Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
        Interface_Static.SetCVal_s("write.step.unit", "MM")

        _, document = toCAF(self.assembly, True)
        writer.Transfer(document, STEPControl_AsIs)
        _number(session)
        _colour(session, self.solids)
        _write_header(session, self.name or Path(path).stem)
        if writer.Write(str(path)) != IFSelect_RetDone or not Path(path).exists():
            raise BuildError(f"{path}: OCCT wrote no STEP file")


def _number(session: XSControl_WorkSession) -> None:
    """Number the yarns' places in the assembly from 1.

    OCCT itself counts on from file to file of a process.
    """
    model, count = session.Model(), 0
    for index in range(1, model.NbEntities() + 1):
        entity = model.Value(index)
        if isinstance(entity, StepRepr_NextAssemblyUsageOccurrence):
            count += 1
            entity.SetId(_text(str(count)))


def _colour(session: XSControl_WorkSession, solids: Mapping[str, cq.Solid]) -> None:
    """Add a style for every solid, in the order of the yarns."""
    model, finder = session.Model(), session.TransferWriter().FinderProcess()
    for name, solid in solids.items():
        styles = STEPConstruct_Styles(session)
        item = STEPConstruct.FindEntity_s(finder, solid.wrapped)
        if item is None:
            raise BuildError(f"{name}: OCCT has not written it")

        colour = STEPConstruct_Styles.EncodeColor_s(_rgb(name))
        style = styles.MakeColorPSA(item, colour, None, None, 0.0)
        styled = StepRepr_HArray1OfRepresentationItem(1, 1)
        styled.SetValue(1, styles.AddStyle(item, style, None))

        presentation = StepVisual_MechanicalDesignGeometricPresentationRepresentation()
        presentation.Init(_text(""), styled, styles.FindContext(solid.wrapped))
        model.AddWithRefs(presentation)


def _rgb(name: str) -> Quantity_Color:
    """The colour of the yarn that is called so."""
    return cq.Color(*colour_of(Body.named(name))).wrapped.GetRGB()


def _write_header(session: XSControl_WorkSession, name: str) -> None:
    header = APIHeaderSection_MakeHeader(session.Model())
    header.SetName(_text(name))
    header.SetTimeStamp(_text(_NO_TIME))
    header.SetDescriptionValue(1, _text(f"Elementary cell of the fabric {name}"))
    header.SetOriginatingSystem(_text(f"fabric_cad {__version__}"))
    header.SetAuthorValue(1, _text(""))
    header.SetOrganizationValue(1, _text(""))
    header.SetAuthorisation(_text(""))


def _text(text: str) -> TCollection_HAsciiString:
    return TCollection_HAsciiString(text)


def assemble(yarns: dict[str, cq.Solid], name: str = "") -> Cell:
    """The cell of named yarns (``weft_1``, ..., ``warp_1``, ...) of the fabric ``name``."""
    assembly = cq.Assembly(name="cell")
    for yarn, solid in yarns.items():
        assembly.add(solid, name=yarn, color=cq.Color(*colour_of(Body.named(yarn))))
    return Cell(assembly, name)


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
            bodies = shape.Solids()
            if len(bodies) != 1 or name in solids:
                raise BuildError(f"{path}: {name} is not one solid of its own name")
            solids[name] = bodies[0]
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
