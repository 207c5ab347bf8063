"""What a permeability says: its report, a dict only when written, its table and its summary."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..cell.traces import trace
from ..measured.tables import Family
from ..model.plausibility import implausible
from ..model.solved import SolvedTable
from .computation import CellFlow
from .permeability import Permeability
from .stokes import TOLERANCE

_NAMES = ("x", "y", "z")
_WIDE_BAR = 5.0  # per cent


@dataclass(frozen=True, eq=False)
class PermeabilityReport:
    """The content of ``permeability.json``; fields are called as its keys, which hold plain numbers, lists and texts.

    ``axes`` are the principal axes as rows; ``error_bar_percent`` is the largest of
    ``checks["error_percent"]``.
    """

    row: str
    K_mm2: list[list[float]]
    principal_mm2: list[float]
    axes: list[list[float]]
    margin_mm: float
    yarns: str
    fibre_diameter_um: float | None
    top: str
    error_bar_percent: float
    closed: list[str]
    margin_study: list[dict[str, Any]]
    checks: dict[str, Any]
    mesh: dict[str, Any]
    solver: dict[str, Any]
    warnings: list[str]
    seconds: dict[str, float]
    origin: dict[str, Any]

    def content(self) -> dict[str, Any]:
        """What is written, but for the digests of other files."""
        found = asdict(self)
        return found | found.pop("origin")


def permeability_report(
    row: Family, table: SolvedTable, solved: Permeability, seconds: Mapping[str, float]
) -> PermeabilityReport:
    """The report of a table of one row, solved as ``table``; ``seconds`` by stage."""
    flow = solved.solved.flow
    return PermeabilityReport(
        row=solved.solved.fabric.name,
        K_mm2=solved.tensor.tolist(),
        principal_mm2=solved.principal.tolist(),
        axes=solved.axes.tolist(),
        margin_mm=solved.solved.cell.margin,
        yarns="rigid" if solved.solved.pores is None else "porous",
        fibre_diameter_um=None
        if solved.solved.pores is None
        else 1000 * solved.solved.pores.diameter,
        top=str(solved.solved.top),
        error_bar_percent=float(solved.error.max()),
        closed=solved.closed,
        margin_study=[
            {"margin_mm": m, "K_mm2": tensor.tolist()} for m, tensor in sorted(solved.study.items())
        ],
        checks={
            "error_percent": solved.error.tolist(),
            "dissipation_less_work": flow.work,
            "divergence": flow.divergence,
            "coarse_K_mm2": solved.coarse.flow.permeability.tolist(),
        },
        mesh={"fine": _mesh(solved.solved), "coarse": _mesh(solved.coarse)},
        solver=_solver(solved.solved),
        warnings=_warnings(row, table, solved),
        seconds={name: round(value, 4) for name, value in seconds.items()},
        origin=trace(row, solved.solved.fineness.yarns),
    )


def write_table(report: PermeabilityReport, path: Path) -> None:
    """The tensor, principal values and what they hold for as CSV: quantity, value, unit."""
    lines = [
        (f"K_{a}{b}", report.K_mm2[i][j], "mm2")
        for i, a in enumerate(_NAMES)
        for j, b in enumerate(_NAMES)
    ]
    lines += [
        (f"K_{number}", value, "mm2") for number, value in enumerate(report.principal_mm2, start=1)
    ]
    lines += [("margin", report.margin_mm, "mm"), ("error_bar", report.error_bar_percent, "%")]
    lines.append(("porosity", report.mesh["fine"]["porosity"], ""))

    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("quantity", "value", "unit"))
        writer.writerows((name, f"{value:.9g}", unit) for name, value, unit in lines)


def summary(report: PermeabilityReport) -> str:
    """A few lines for a person; the clearance stands beside the result, which it decides."""
    mesh, solver = report.mesh["fine"], report.solver
    x, y, z = (report.K_mm2[i][i] for i in range(3))
    values = ", ".join(f"{value:.4g}" for value in report.principal_mm2)
    lines = [
        f"{report.row}: {mesh['hexahedra']} hexahedra, {100 * mesh['porosity']:.1f} % between {report.yarns} yarns",
        f"  permeability    Kx {x:.4g}, Ky {y:.4g}, Kz {z:.4g} mm2",
        f"  principal       {values} mm2",
        f"  holds for       a clearance of {report.margin_mm:.4g} mm, {report.top}",
        f"  error bar       {report.error_bar_percent:.2g} % (against a coarser mesh)",
    ]

    for other in report.margin_study:
        x, y, z = (other["K_mm2"][i][i] for i in range(3))
        lines.append(
            f"  at {other['margin_mm']:.4g} mm".ljust(18)
            + f"Kx {x:.4g}, Ky {y:.4g}, Kz {z:.4g} mm2"
        )

    lines += [f"  {sentence}" for sentence in report.closed]
    lines.append(
        f"  solver          {solver['iterations']} iterations, residual {solver['residual']:.1e}"
    )
    lines.append(f"  seconds         {sum(report.seconds.values()):.1f}")

    return "\n".join(lines)


def _mesh(solved: CellFlow) -> dict[str, Any]:
    options, box = solved.fineness.yarns, solved.fineness.box
    return {
        "hexahedra": len(solved.mesh.nodes),
        "nodes": len(solved.mesh.points),
        "across": options.across,
        "crossing": options.crossing,
        "gap": options.gap,
        "layers": box.layers,
        "grading": box.grading,
        "porosity": solved.porosity,
        "box_mm": solved.cell.size.tolist(),
        "closed_wedge_mm": solved.cell.closed_wedge,
    }


def _solver(solved: CellFlow) -> dict[str, Any]:
    return {
        "method": "triquadratic velocity, trilinear pressure; MINRES, preconditioned by vertical lines",
        "unknowns": int(solved.equations.free.sum() + len(solved.equations.masses)),
        "directions": solved.flow.directions.tolist(),
        "iterations": solved.flow.iterations,
        "residual": solved.flow.residual,
        "tolerance": TOLERANCE,
    }


def _warnings(row: Family, table: SolvedTable, solved: Permeability) -> list[str]:
    warnings = list(map(str, implausible(row, table.columns)))
    if (worst := float(np.max(solved.error))) > _WIDE_BAR:
        told = f"the permeability differs by {worst:.2g} % on a coarser mesh; ask for a finer one"
        warnings.append(f"{row.names[0]}: {told}")
    return warnings
