"""What a case of loads says: its table, its report, and a few lines of that for a person."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from ..cell.pipeline import Stages
from .cell import Cell
from .job import Job
from .settings import Settings


@dataclass(frozen=True, eq=False)
class Case:
    """What tension and shear have in common: the row, its settings and cell, and how decks are run.

    ``kind`` is ``tension`` or ``shear``, the stem of every file; ``folder`` takes them.
    """

    kind: str
    cell: Cell
    settings: Settings
    folder: Path
    stages: Stages

    @property
    def penetration_bound(self) -> float:
        """Penetration (mm) of yarns up to which a state is called valid."""
        thickness = min(each.thickness for each in self.cell.fabric.directions.values())
        return self.settings.contact.valid_penetration * thickness

    def path(self, ending: str) -> Path:
        """A file of this case, e.g. ``tension.csv`` or ``tension_curves.png``."""
        return self.folder / f"{self.kind}{ending}"


def case_report(case: Case, name: str, jobs: list[Job], rows: list[dict], found: dict) -> dict:
    """The content of ``tension.json`` or ``shear.json``, but for where it comes from."""
    reached = [each for job in jobs for each in job.reached]
    settings = asdict(case.settings)
    settings["yarn"]["compaction_strain"] = _finite(settings["yarn"]["compaction_strain"])
    settings["tension"]["ratios"] = [_finite(ratio) for ratio in settings["tension"]["ratios"]]
    return {
        "row": name,
        "case": case.kind,
        "settings": {key: settings[key] for key in ("yarn", "contact", case.kind)},
        "consistency": case.cell.report["consistency"],
        "mesh": case.cell.report["mesh"],
        "warnings": case.cell.report["warnings"],
        "solver": {
            "version": jobs[0].run.version,
            "finished": jobs[-1].run.finished,
            "reason": jobs[-1].run.reason,
            "jobs": len(jobs),
            "states": len(reached),
            "cutbacks": sum(job.run.cutbacks for job in jobs),
            "seconds": round(sum(job.run.seconds for job in jobs), 3),
            "peak_memory_MB": round(max(job.run.peak_memory for job in jobs) / 1e6, 1),
            "warnings": sorted({warning for job in jobs for warning in job.run.warnings}),
        },
        "contact": {
            "max_contact_penetration_mm": _extreme(max, [each.overclosure for each in reached]),
            "max_penetration_mm": _extreme(max, [row["penetration_mm"] for row in rows]),
            "valid_penetration_mm": case.penetration_bound,
            "states_beyond": sum(row["penetration_mm"] > case.penetration_bound for row in rows),
            "min_contact_share": _extreme(min, [each.share for each in reached]),
            "least_volume_ratio": _extreme(min, [row["least_volume_ratio"] for row in rows]),
        },
        **found,
        "seconds": {key: round(value, 4) for key, value in case.stages.seconds.items()},
    }


def _finite(value: float) -> float | str:
    """Infinity as text, for JSON has none."""
    return "inf" if math.isinf(value) else value


def _extreme(choose: Callable, values: list[float]) -> float | None:
    known = [value for value in values if not math.isnan(value)]
    return choose(known) if known else None


def write_rows(path: Path, rows: list[dict]) -> None:
    """Rows as CSV; an empty cell where there is no number."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        if rows:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(rows[0])
            writer.writerows([[_cell_text(value) for value in row.values()] for row in rows])


def _cell_text(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.9g}"


def plain(row: dict[str, float]) -> dict:
    """A row for JSON, which knows neither infinity nor NaN."""
    return {key: None if math.isnan(value) else _finite(float(value)) for key, value in row.items()}


def summary(report: Mapping) -> str:
    """Text of a report of :func:`fabric_cad.simulation.run.make_tension` or ``make_shear``."""
    mesh, solver, contact = report["mesh"], report["solver"], report["contact"]
    lines = [
        f"{report['row']}: {report['case']}, {mesh['hexahedra']} hexahedra, {solver['states']} states in "
        f"{solver['jobs']} job{'s' * (solver['jobs'] != 1)} of CalculiX {solver['version']}, "
        f"{solver['seconds']:.1f} s" + f", {solver['peak_memory_MB']:.0f} MB" * (solver["peak_memory_MB"] > 0)
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
    lines = [f"  {'k':>6}{'E11 %':>9}{'E22 %':>9}{'T11 N per yarn':>16}{'T22 N per yarn':>16}{'thickness %':>13}"]
    for at in states:
        lines.append(
            f"  {at['k']!s:>6}{100 * at['E11']:9.3g}{100 * at['E22']:9.3g}{at['T11_N_per_yarn']:16.5g}"
            f"{at['T22_N_per_yarn']:16.5g}{at['thickness_change_percent']:+13.2f}"
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
