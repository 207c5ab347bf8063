"""What a stiffness says, as figures by name, as a table, and as a few lines for a person."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from .report import COMPONENTS, StiffnessReport

FIGURES = (
    *("Ex", "Ey", "Ez", "Gxy", "Gxz", "Gyz", "nu_xy", "nu_xz", "nu_yz", "nu_yx", "nu_zx", "nu_zy"),
    *(f"expansion_{axis}_per_K" for axis in "xyz"),
    *(f"conductivity_{axis}_W_per_mK" for axis in "xyz"),
    *("density_g_cm3", "yarn_volume_fraction", "fibre_volume_fraction"),
)
"""All names that :func:`figures` may have."""


def figures(report: StiffnessReport) -> dict[str, float]:
    """The numbers of a report by their names, for a table of many.

    Those that are not known are not there.
    """
    found = dict(report.constants)
    if report.expansion_per_K:
        found |= {
            f"expansion_{axis}_per_K": value for axis, value in zip("xyz", report.expansion_per_K)
        }

    if report.conductivity_W_per_mK:
        diagonal = np.diag(report.conductivity_W_per_mK).tolist()
        found |= {f"conductivity_{axis}_W_per_mK": value for axis, value in zip("xyz", diagonal)}

    known = {"density_g_cm3": report.density_g_cm3}
    known |= {name: report.mesh[name] for name in ("yarn_volume_fraction", "fibre_volume_fraction")}

    return found | {name: value for name, value in known.items() if value is not None}


def write_table(report: StiffnessReport, path: Path) -> None:
    """The properties as CSV: quantity, value, unit."""
    units = {"E": "MPa", "G": "MPa"}
    lines = [(name, value, units.get(name[0], "")) for name, value in report.constants.items()]
    if report.expansion_per_K:
        lines += [
            (f"expansion_{c}", value, "1/K") for c, value in zip(COMPONENTS, report.expansion_per_K)
        ]

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
    fibre = (
        ""
        if mesh["fibre_volume_fraction"] is None
        else f", {100 * mesh['fibre_volume_fraction']:.1f} % fibre"
    )
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

    lines.append(
        f"  solver          {solver['iterations']} iterations, residual {solver['residual']:.1e}"
    )
    lines.append(f"  seconds         {sum(report.seconds.values()):.1f}")

    return "\n".join(lines)
