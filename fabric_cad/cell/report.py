"""The report of a cell: what its files hold, measured on them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from ..model.solved import SolvedDirection, SolvedFabric, point_columns
from ..weave.directions import Direction
from ..weave.weaves import Weave
from .figures import MeshFigures, Volumes

if TYPE_CHECKING:
    from ..cad import Consistency


CONSISTENCY: Mapping[str, str] = MappingProxyType(
    {
        "max_penetration_mm": "max_penetration",
        "max_contact_gap_mm": "max_contact_gap",
        "overlap_volume_mm3": "overlap_volume",
        "contact_area_mm2": "contact_area",
        "thickness_mm": "thickness",
    }
)
"""Keys of the report, and what :class:`fabric_cad.cad.Consistency` calls the same."""


@dataclass(frozen=True)
class Comparison:
    """A quantity that was measured beyond what identified the row, and the model's value of it."""

    quantity: str
    measured: float
    model: float

    def content(self) -> dict:
        """What the report holds."""
        return {
            "quantity": self.quantity,
            "measured": self.measured,
            "model": self.model,
            "difference_percent": 100 * (self.model - self.measured) / self.measured,
        }


@dataclass(frozen=True)
class Identification:
    """How a row was identified: by which columns, how many parameters, and what else they allow.

    ``std`` is a fabric whose numbers are standard deviations, None where the row gives none;
    ``other_thicknesses`` those of weft and warp (mm) in a second solution, None where there is
    none.
    """

    parameters: int
    identified_by: tuple[str, ...]
    comparisons: tuple[Comparison, ...] = ()
    std: SolvedFabric | None = None
    other_thicknesses: tuple[float, float] | None = None

    @classmethod
    def of_row(
        cls, row: Mapping, comparisons: tuple[tuple[str, float, float], ...], std: Mapping | None
    ) -> Identification:
        """From one row of a solved table, what it was compared with, and its standard deviations."""
        other = None
        if row["other_weft_thickness_mm"] != "":
            other = float(row["other_weft_thickness_mm"]), float(row["other_warp_thickness_mm"])
        return cls(
            parameters=int(row["parameters"]),
            identified_by=tuple(str(row["identified_by"]).split()),
            comparisons=tuple(Comparison(*compared) for compared in comparisons),
            std=None if std is None else SolvedFabric.from_row({**row, **std}),
            other_thicknesses=other,
        )


@dataclass(frozen=True, eq=False)
class CellReport:
    """All that was measured on a cell's files.

    ``mesh`` is None where none was made, ``seconds`` are per stage.
    """

    fabric: SolvedFabric
    identification: Identification
    consistency: Consistency
    volumes: Volumes
    mesh: MeshFigures | None
    seconds: Mapping[str, float]
    warnings: tuple[str, ...] = ()

    def content(self) -> dict:
        """What ``report.json`` holds of it; lengths mm."""
        fabric, found = self.fabric, self.consistency
        return {
            "row": fabric.name,
            "family": fabric.family,
            "weave": _weave(fabric.weave),
            "section": fabric.section,
            "float_gap": fabric.float_gap,
            "parameters": self.identification.parameters,
            "identified": self._identified(),
            "measured_vs_model": [
                compared.content() for compared in self.identification.comparisons
            ],
            "consistency": {key: getattr(found, name) for key, name in CONSISTENCY.items()},
            "volumes": self.volumes.content(),
            **({} if self.mesh is None else {"mesh": self.mesh.content()}),
            "seconds": dict(self.seconds),
            "warnings": list(self.warnings),
        }

    def _identified(self) -> dict:
        """What was identified of both directions, and of the fabric."""
        how, std = self.identification, self.identification.std
        identified: dict = {
            str(name): _parameters(name, solved) for name, solved in self.fabric.directions.items()
        }
        identified["fabric_thickness_mm"] = self.fabric.fabric_thickness

        if std is not None:
            for name, solved in std.directions.items():
                identified[name]["std"] = _parameters(name, solved)
            identified["fabric_thickness_std_mm"] = std.fabric_thickness

        identified["identified_by"] = list(how.identified_by)
        if how.other_thicknesses is not None:
            weft, warp = how.other_thicknesses
            identified["other_solution"] = {"weft_thickness_mm": weft, "warp_thickness_mm": warp}

        return identified


def _weave(weave: Weave) -> dict:
    counts = {"wefts": weave.wefts, "warps": weave.warps}
    if weave.pattern:
        return {"over": None, "under": None, "step": None, **counts, "pattern": list(weave.pattern)}
    return {"over": weave.over, "under": weave.under, "step": weave.step, **counts}


def _parameters(name: str | Direction, solved: SolvedDirection) -> dict:
    points = zip(point_columns(name), solved.points)
    return {
        "slope": solved.slope,
        "p_low": solved.p_low,
        "p_high": solved.p_high,
        "amplitude_mm": solved.amplitude,
        "thickness_mm": solved.thickness,
        "width_mm": solved.width,
        "spacing_mm": solved.crossed_spacing,
        "crimp": solved.crimp,
        "control_points": {point: list(place) for (point, _, _), place in points},
    }
