"""A simulation's report in a few lines for a person."""

from __future__ import annotations

from collections.abc import Mapping


def summary(report: Mapping) -> str:
    """Text of a report of :func:`fabric_cad.simulation.run.make_tension` or ``make_shear``."""
    mesh, solver, contact = report["mesh"], report["solver"], report["contact"]
    lines = [
        f"{report['row']}: {report['case']}, {mesh['hexahedra']} hexahedra, {solver['states']} states in "
        f"{solver['jobs']} job{'s' * (solver['jobs'] != 1)} of CalculiX {solver['version']}, "
        f"{solver['seconds']:.1f} s, {solver['peak_memory_MB']:.0f} MB"
    ]
    lines += _tension(report["largest"]) if report["case"] == "tension" else _shear(report)
    if contact["max_contact_penetration_mm"] is not None:
        lines += [
            f"  penetration     at most {contact['max_contact_penetration_mm']:.2e} mm between the contact surfaces, "
            f"{contact['max_penetration_mm']:.2e} mm anywhere",
            f"  contact         at least {100 * contact['min_contact_share']:.0f} % of the patches under pressure",
        ]
    if contact["states_beyond"]:
        lines.append(
            f"  NOT VALID       {contact['states_beyond']} states: their yarns penetrate by more than "
            f"{contact['valid_penetration_mm']:.2g} mm"
        )
    lines.append(f"  seconds         {sum(report['seconds'].values()):.1f}")
    return "\n".join(lines)


def _tension(states: list[Mapping]) -> list[str]:
    """The end of every curve."""
    lines = [f"  {'k':>6}{'E11 %':>9}{'E22 %':>9}{'T11 N/yarn':>13}{'T22 N/yarn':>13}{'thickness %':>13}"]
    for at in states:
        lines.append(
            f"  {at['k']!s:>6}{100 * at['E11']:9.3g}{100 * at['E22']:9.3g}{at['T11_N_per_yarn']:13.5g}"
            f"{at['T22_N_per_yarn']:13.5g}{at['thickness_change_percent']:+13.2f}"
        )
    return lines


def _shear(report: Mapping) -> list[str]:
    last = report["largest"]
    lines = [
        f"  at {last['angle_deg']:g} degrees   moment {last['moment_N_mm']:.4g} N mm a cell, "
        f"force {last['force_N_per_mm']:.4g} N/mm"
    ]
    until = "up to" if report["contact"]["states_beyond"] else "at least up to"
    lines.append(
        f"  contact valid   {until} {report['valid_up_to_deg']:.3g} degrees "
        f"(penetration within {report['contact']['valid_penetration_mm']:.2g} mm)"
    )
    return lines
