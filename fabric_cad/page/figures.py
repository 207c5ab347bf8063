"""What is told of a fabric at once, from closed forms: thickness, crimps, volumes, mass, expected elements."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..model.plausibility import implausible
from ..model.scatter import propagate
from ..study.table_figures import identified_figures
from ..support.errors import InputError
from ..weave.directions import DIRECTIONS
from ..yarn.edges import allowed_over
from ..yarn.tessellation import swept_tiles
from .edited import Solution


@dataclass(frozen=True)
class Figure:
    """One figure of a fabric: ``std`` is its standard deviation, None where the row gives no scatter."""

    key: str
    label: str
    value: float
    unit: str = ""
    std: float | None = None

    @property
    def text(self) -> str:
        """The value in four digits, its scatter and its unit."""
        spread = "" if self.std is None else f" \u00b1 {self.std:.2g}"
        return f"{self.value:.4g}{spread}{' ' * bool(self.unit)}{self.unit}"


_SHOWN = (  # key of a study's figures, label, unit, factor, column of the solved table
    ("identified.fabric_thickness_mm", "fabric thickness", "mm", 1.0, "fabric_thickness_mm"),
    *(
        (f"identified.{d}.{key}", f"{d} {label}", unit, factor, f"{d}_{key}")
        for key, label, unit, factor in (
            ("crimp", "crimp", "%", 100.0),
            ("thickness_mm", "thickness", "mm", 1.0),
            ("slope", "slope", "", 1.0),
        )
        for d in DIRECTIONS
    ),
    ("volumes.yarn_volume_fraction", "yarn volume fraction", "%", 100.0, ""),
    ("volumes.areal_density_g_m2", "areal density", "g/m\u00b2", 1.0, ""),
    *((f"volumes.{d}_fibre_fraction", f"fibres in the {d}", "%", 100.0, "") for d in DIRECTIONS),
)


def figures(solution: Solution) -> tuple[Figure, ...]:
    """The figures of a fabric that are known: those of ``report.json`` before there is any CAD.

    Volumes of round sections have no closed form and are left out. An expected scaled Jacobian is
    not among them (:func:`expected_quality`).
    """
    found, std = identified_figures(solution.table, solution.identified), _spread(solution)
    known = []
    for key, label, unit, factor, column in _SHOWN:
        value = float(found[key][0]) if key in found else math.nan
        if not math.isnan(value):
            spread = factor * std[column] if column in std else None
            known.append(Figure(key, label, factor * value, unit, spread))
    return tuple(known)


def expected_quality(solution: Solution) -> Figure:
    """The least scaled Jacobian that the yarns' edges allow any mesh of hexahedra."""
    value = allowed_over(swept_tiles(solution.fabric))
    return Figure("mesh.scaled_jacobian_edges_allow", "elements at the edges, at best", value)


def warnings(solution: Solution) -> tuple[str, ...]:
    """Sentences on what is seldom true of a fabric."""
    return tuple(
        problem.message for problem in implausible(solution.table, solution.identified.columns)
    )


def comparisons(solution: Solution) -> tuple[tuple[str, float, float], ...]:
    """(column, measured, model) of what was measured beyond need."""
    return solution.solved.comparisons[0]


def _spread(solution: Solution) -> dict[str, float]:
    """Standard deviations of solved columns.

    None where the row gives no scatter, or it leaves the fabrics.
    """
    if not solution.table.scattered[0]:
        return {}
    try:
        return propagate(solution.table, solution.solved).row(0)
    except InputError:
        return {}
