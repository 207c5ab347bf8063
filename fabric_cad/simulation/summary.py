"""A few lines of a load case's report for a person."""

from __future__ import annotations

from typing import Any

from .loads import LoadCase
from .report import CaseReport


def summary(report: CaseReport, case: LoadCase[Any]) -> str:
    """Text of the report of a case."""
    lines = [_heading(report), *case.summary(report), *_contact(report)]
    lines.append(f"  seconds         {sum(report.seconds.values()):.1f}")
    return "\n".join(lines)


def _heading(report: CaseReport) -> str:
    solver = report.solver
    return (
        f"{report.row}: {report.case}, {report.mesh['hexahedra']} hexahedra, {solver.states} states in "
        f"{solver.jobs} job{'s' * (solver.jobs != 1)} of CalculiX {solver.version}, "
        f"{solver.seconds:.1f} s"
        + f", {solver.peak_memory_MB:.0f} MB"
        * (solver.peak_memory_MB > 0)
    )


def _contact(report: CaseReport) -> list[str]:
    contact, lines = report.contact, []
    if contact.max_contact_penetration_mm is not None:
        lines.append(
            f"  penetration     at most {contact.max_contact_penetration_mm:.2e} mm between the contact surfaces, "
            f"{contact.max_penetration_mm:.2e} mm anywhere"
        )

    if contact.min_contact_share is not None:
        share = 100 * contact.min_contact_share
        lines.append(f"  contact         at least {share:.0f} % of the patches under pressure")

    if contact.states_beyond:
        lines.append(
            f"  NOT VALID       {contact.states_beyond} states: their yarns penetrate by more than "
            f"{contact.valid_penetration_mm:.2g} mm"
        )

    return lines
