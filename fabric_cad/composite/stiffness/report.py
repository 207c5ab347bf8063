"""What a stiffness says: its report as a value, which is a dict when it is written; its table; its summary."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...cell.traces import trace
from ...model.plausibility import implausible
from ..constituents import ELASTIC
from ..homogenisation.conjugate_gradients import TOLERANCE
from ..homogenisation.homogenise import constants
from ..micromechanics import METHOD
from .computation import CompositeStiffness

_DENSITIES = 0.02  # by which the fibre's density in a table and in the constituents may differ

COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")


@dataclass(frozen=True, eq=False)
class StiffnessReport:
    """The content of ``stiffness.json``; fields are called as its keys, which hold plain numbers, lists and texts.

    6 x 6 matrices are in the order xx yy zz yz xz xy with engineering shear; ``plate`` is None where not asked for.
    """

    row: str
    C_MPa: list[list[float]]
    S_per_MPa: list[list[float]]  # noqa: N815 (as in the file)
    constants: dict[str, float]
    expansion_per_K: list[float] | None  # noqa: N815 (as in the file)
    conductivity_W_per_mK: list[list[float]] | None  # noqa: N815 (as in the file)
    density_g_cm3: float | None
    voigt_MPa: list[list[float]]  # noqa: N815 (as in the file)
    reuss_MPa: list[list[float]]  # noqa: N815 (as in the file)
    plate: dict[str, Any] | None
    yarn: dict[str, Any]
    matrix: dict[str, Any]
    mesh: dict[str, Any]
    solver: dict[str, Any]
    warnings: list[str]
    seconds: dict[str, float]
    origin: dict[str, Any]

    def content(self) -> dict[str, Any]:
        """What is written, but for the digests of other files."""
        found = asdict(self)
        origin = found.pop("origin")
        if self.plate is None:
            del found["plate"]

        return found | origin


def figures(report: StiffnessReport) -> dict[str, float]:
    """The numbers of a report by their names, for a table of many; those that are not known are not there."""
    found = dict(report.constants)
    if report.expansion_per_K:
        found |= {f"expansion_{axis}_per_K": value for axis, value in zip("xyz", report.expansion_per_K)}
    if report.conductivity_W_per_mK:
        diagonal = np.diag(report.conductivity_W_per_mK).tolist()
        found |= {f"conductivity_{axis}_W_per_mK": value for axis, value in zip("xyz", diagonal)}
    known = {"density_g_cm3": report.density_g_cm3}
    known |= {name: report.mesh[name] for name in ("yarn_volume_fraction", "fibre_volume_fraction")}
    return found | {name: value for name, value in known.items() if value is not None}


FIGURES = (
    *("Ex", "Ey", "Ez", "Gxy", "Gxz", "Gyz", "nu_xy", "nu_xz", "nu_yz", "nu_yx", "nu_zx", "nu_zy"),
    *(f"expansion_{axis}_per_K" for axis in "xyz"),
    *(f"conductivity_{axis}_W_per_mK" for axis in "xyz"),
    *("density_g_cm3", "yarn_volume_fraction", "fibre_volume_fraction"),
)
"""All names that :func:`figures` may have."""


def stiffness_report(computed: CompositeStiffness, seconds: Mapping[str, float]) -> StiffnessReport:
    """The report of a computation; ``seconds`` by stage."""
    effective = computed.effective
    table = computed.model.row
    return StiffnessReport(
        row=computed.model.fabric.name,
        C_MPa=effective.stiffness.tolist(),
        S_per_MPa=np.linalg.inv(effective.stiffness).tolist(),
        constants=constants(effective.stiffness),
        expansion_per_K=_listed(effective.expansion),
        conductivity_W_per_mK=_listed(effective.conductivity),
        density_g_cm3=effective.density,
        voigt_MPa=effective.voigt.tolist(),
        reuss_MPa=effective.reuss.tolist(),
        plate=_plate(computed),
        yarn=_yarn(computed),
        matrix=asdict(computed.model.constituents.matrix),
        mesh=_mesh(computed),
        solver=_solver(computed),
        warnings=_warnings(computed),
        seconds={name: round(value, 4) for name, value in seconds.items()},
        origin=trace(table, computed.model.options),
    )


def write_table(report: StiffnessReport, path: Path) -> None:
    """The properties as CSV: quantity, value, unit."""
    units = {"E": "MPa", "G": "MPa"}
    lines = [(name, value, units.get(name[0], "")) for name, value in report.constants.items()]
    if report.expansion_per_K:
        lines += [(f"expansion_{c}", value, "1/K") for c, value in zip(COMPONENTS, report.expansion_per_K)]
    if report.conductivity_W_per_mK:
        diagonal = np.diag(report.conductivity_W_per_mK)
        lines += [(f"conductivity_{c}", value, "W/(m K)") for c, value in zip(COMPONENTS, diagonal)]
    if report.density_g_cm3 is not None:
        lines.append(("density", report.density_g_cm3, "g/cm3"))
    for key in ("yarn_volume_fraction", "fibre_volume_fraction"):
        if report.mesh[key] is not None:
            lines.append((key, report.mesh[key], ""))

    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("quantity", "value", "unit"))
        writer.writerows((name, f"{value:.9g}", unit) for name, value, unit in lines)


def summary(report: StiffnessReport) -> str:
    """A few lines for a person."""
    c, mesh, solver = report.constants, report.mesh, report.solver
    fibre = "" if mesh["fibre_volume_fraction"] is None else f", {100 * mesh['fibre_volume_fraction']:.1f} % fibre"
    lines = [
        f"{report.row}: {mesh['hexahedra']} hexahedra, {100 * mesh['yarn_volume_fraction']:.1f} % yarns{fibre}",
        f"  moduli          Ex {c['Ex'] / 1e3:.4g}, Ey {c['Ey'] / 1e3:.4g}, Ez {c['Ez'] / 1e3:.4g} GPa",
        f"  shear moduli    Gxy {c['Gxy'] / 1e3:.4g}, Gxz {c['Gxz'] / 1e3:.4g}, Gyz {c['Gyz'] / 1e3:.4g} GPa",
        f"  Poisson ratios  xy {c['nu_xy']:.3g}, xz {c['nu_xz']:.3g}, yz {c['nu_yz']:.3g}",
    ]
    if report.expansion_per_K:
        x, y, z = (1e6 * value for value in report.expansion_per_K[:3])
        lines.append(f"  expansion       x {x:.3g}, y {y:.3g}, z {z:.3g} 1e-6/K")
    if report.conductivity_W_per_mK:
        x, y, z = np.diag(report.conductivity_W_per_mK)
        lines.append(f"  conductivity    x {x:.3g}, y {y:.3g}, z {z:.3g} W/(m K)")
    if report.density_g_cm3 is not None:
        lines.append(f"  density         {report.density_g_cm3:.4g} g/cm3")
    if report.plate:
        a, d = report.plate["A_N_per_mm"], report.plate["D_N_mm"]
        lines.append(
            f"  plate           A11 {a[0][0]:.4g}, A22 {a[1][1]:.4g} N/mm, D11 {d[0][0]:.4g}, D22 {d[1][1]:.4g} N mm"
        )
    lines.append(f"  solver          {solver['iterations']} iterations, residual {solver['residual']:.1e}")
    lines.append(f"  seconds         {sum(report.seconds.values()):.1f}")
    return "\n".join(lines)


def _listed(values: np.ndarray | None) -> list | None:
    return None if values is None else values.tolist()


def _plate(computed: CompositeStiffness) -> dict[str, Any] | None:
    plate = computed.plate
    if plate is None:
        return None

    return {
        "A_N_per_mm": plate.A.tolist(),
        "B_N": plate.B.tolist(),
        "D_N_mm": plate.D.tolist(),
        "thickness_mm": plate.thickness,
        "iterations": plate.response.iterations,
        "residual": plate.response.residual,
    }


def _yarn(computed: CompositeStiffness) -> dict[str, Any]:
    """What the yarns were taken to be, and where from."""
    constituents = computed.model.constituents
    given = {key: value for key, value in asdict(constituents.yarn).items() if value not in (None, "")}
    given.pop("own_fraction")
    fractions = computed.model.fractions[~computed.model.cell.in_matrix]
    known = not np.isnan(fractions).any()
    return {
        "constants_by": f"given: {', '.join(ELASTIC)}" if constituents.yarn.law else METHOD,
        "given": given,
        "fibre": asdict(constituents.fibre) if constituents.fibre else None,
        "fibre_fraction": {"least": float(fractions.min()), "greatest": float(fractions.max())} if known else None,
        "file": constituents.path,
    }


def _mesh(computed: CompositeStiffness) -> dict[str, Any]:
    cell, volumes = computed.model.cell, computed.effective.response.integrals.volumes[0]
    matrix = cell.in_matrix
    fibre = float(volumes @ computed.model.fractions / volumes.sum())
    return {
        "hexahedra": len(cell.mesh.hexahedra),
        "nodes": len(cell.mesh.points),
        "min_scaled_jacobian": {
            "matrix": float(computed.model.quality[matrix].min()),
            "yarns": float(computed.model.quality[~matrix].min()),
        },
        "box_mm": cell.size.tolist(),
        "margin_mm": cell.margin,
        "closed_wedge_mm": cell.closed_wedge,
        "yarn_volume_fraction": float(volumes[~matrix].sum() / volumes.sum()),
        "fibre_volume_fraction": None if np.isnan(fibre) else fibre,
    }


def _solver(computed: CompositeStiffness) -> dict[str, Any]:
    response = computed.effective.response
    return {
        "method": "trilinear hexahedra, periodic; conjugate gradients, vertical lines as preconditioner",
        "unknowns": int(response.fluctuations[..., 0].size),
        "iterations": response.iterations,
        "residual": response.residual,
        "tolerance": TOLERANCE,
        "asymmetry": response.asymmetry,
    }


def _warnings(computed: CompositeStiffness) -> list[str]:
    constituents, row = computed.model.constituents, computed.model.row
    warnings = list(map(str, implausible(row, computed.model.solved.columns)))
    own, fibre = float(row.measured["fibre_density_g_cm3"][0]), constituents.fibre
    if fibre and fibre.density_g_cm3 and abs(own / fibre.density_g_cm3 - 1) > _DENSITIES:
        told = f"the table gives its fibres {own:g} g/cm3, {constituents.path} {fibre.density_g_cm3:g}"
        warnings.append(f"{row.names[0]}: {told}: are they of one material?")

    return warnings
