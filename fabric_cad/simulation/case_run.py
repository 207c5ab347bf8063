"""A load case at work on one row's cell."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..cell.pipeline import Stages
from .cell import Cell
from .loads import LoadCase
from .settings import Settings


@dataclass(frozen=True, eq=False)
class CaseRun:
    """A load case, the cell it loads, and where its files go; ``stages`` times what is done."""

    case: LoadCase[Any]
    cell: Cell
    settings: Settings
    folder: Path
    stages: Stages

    @property
    def penetration_bound(self) -> float:
        """Penetration (mm) of yarns up to which a state is called valid."""
        thickness = min(way.thickness for way in self.cell.fabric.directions.values())
        return self.settings.contact.valid_penetration * thickness

    def path(self, ending: str) -> Path:
        """A file of this case, e.g. ``tension.csv`` or ``tension_curves.png``."""
        return self.folder / f"{self.case.name}{ending}"
