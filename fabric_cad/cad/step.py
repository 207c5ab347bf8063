"""The cell as an assembly of named, coloured solids: written as STEP, read back from it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cadquery as cq

from ..colours import COLOURS
from ..errors import BuildError


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
        assembly.add(solid, name=name, color=cq.Color(*COLOURS[name.split("_")[0]]))
    return Cell(assembly)


def read_step(path: str | Path) -> dict[str, cq.Solid]:
    """Yarn name to solid from a STEP file of a cell, in file order.

    Raises :class:`BuildError` where the file does not hold one named solid a yarn.
    """
    try:
        assembly = cq.Assembly.importStep(str(path))
    except (ValueError, RuntimeError) as error:
        raise BuildError(f"{path}: cannot be read as STEP: {error}") from error
    solids = {}
    for shape, name, _, _ in assembly:
        found = shape.Solids()
        key = name.split("/")[-1]
        if len(found) != 1 or key in solids:
            raise BuildError(f"{path}: {name} is not one solid of its own name")
        solids[key] = found[0]
    return solids
