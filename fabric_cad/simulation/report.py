"""What a load case says: its report as a value, which is a dict when it is written."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..cell.traces import trace, write_traced
from ..measured.tables import Family

if TYPE_CHECKING:
    from .case_run import CaseRun
    from .case_table import CaseTable
    from .job import Job


@dataclass(frozen=True)
class SolverReport:
    """How the solver went through the jobs of a case.

    ``states`` were reached, ``cutbacks`` are increments that failed and were tried again smaller.
    """

    version: str
    finished: bool
    reason: str
    jobs: int
    states: int
    cutbacks: int
    seconds: float
    peak_memory_MB: float  # noqa: N815 (as in the file)
    warnings: list[str]


@dataclass(frozen=True)
class ContactReport:
    """How yarns touch, over all states; None where nothing is known, as of yarns that are glued."""

    max_contact_penetration_mm: float | None
    max_penetration_mm: float | None
    valid_penetration_mm: float
    states_beyond: int
    min_contact_share: float | None
    least_volume_ratio: float | None


@dataclass(frozen=True, eq=False)
class CaseReport:
    """The report of a load case on one row.

    ``case`` is its name; ``settings`` are the tables it took; ``consistency``, ``mesh`` and
    ``warnings`` those of the cell; ``findings`` what this case alone has; ``seconds`` by stage;
    ``origin`` what made it; ``files`` the digests of all others, by name.
    """

    row: str
    case: str
    settings: Mapping[str, Any]
    consistency: Mapping[str, Any]
    mesh: Mapping[str, Any]
    warnings: Sequence[str]
    solver: SolverReport
    contact: ContactReport
    findings: Mapping[str, Any]
    seconds: Mapping[str, float]
    origin: Mapping[str, Any]
    files: Mapping[str, str] = field(default_factory=dict)

    def content(self) -> dict[str, Any]:
        """The report as it is written."""
        return {
            "row": self.row,
            "case": self.case,
            "settings": dict(self.settings),
            "consistency": self.consistency,
            "mesh": self.mesh,
            "warnings": self.warnings,
            "solver": asdict(self.solver),
            "contact": asdict(self.contact),
            **self.findings,
            "seconds": dict(self.seconds),
            **self.origin,
            **({"files": dict(self.files)} if self.files else {}),
        }

    def written(self, path: Path) -> CaseReport:
        """Write the report; it, with the digests of the files beside."""
        content = self.content()
        write_traced(content, path)
        return replace(self, files=content["files"])


def case_report(run: CaseRun, row: Family, jobs: Sequence[Job], table: CaseTable) -> CaseReport:
    """The report of a case whose ``jobs`` gave a ``table``; ``row`` is a table of one row."""
    cell, settings = run.cell.report.content(), run.settings
    tables = {"yarn": settings.yarn, "contact": settings.contact, run.case.name: run.case}
    return CaseReport(
        row=row.names[0],
        case=run.case.name,
        settings={name: _finite(asdict(values)) for name, values in tables.items()},  # type: ignore[call-overload]
        consistency=cell["consistency"],
        mesh=cell["mesh"],
        warnings=cell["warnings"],
        solver=_solver_report(jobs),
        contact=_contact_report(run, jobs, table),
        findings=run.case.findings(run, table),
        seconds={name: round(seconds, 4) for name, seconds in run.stages.seconds.items()},
        origin=trace(row, run.cell.options),
    )


def _solver_report(jobs: Sequence[Job]) -> SolverReport:
    runs = [job.run for job in jobs]
    return SolverReport(
        version=runs[0].version,
        finished=runs[-1].finished,
        reason=runs[-1].reason,
        jobs=len(runs),
        states=sum(len(job.reached) for job in jobs),
        cutbacks=sum(run.cutbacks for run in runs),
        seconds=round(sum(run.seconds for run in runs), 3),
        peak_memory_MB=round(max(run.peak_memory for run in runs) / 1e6, 1),
        warnings=sorted({warning for run in runs for warning in run.warnings}),
    )


def _contact_report(run: CaseRun, jobs: Sequence[Job], table: CaseTable) -> ContactReport:
    reached = [state for job in jobs for state in job.reached]
    depths = [row["penetration_mm"] for row in table.rows]
    return ContactReport(
        max_contact_penetration_mm=_extreme(max, (state.overclosure for state in reached)),
        max_penetration_mm=_extreme(max, depths),
        valid_penetration_mm=run.penetration_bound,
        states_beyond=sum(depth > run.penetration_bound for depth in depths),
        min_contact_share=_extreme(min, (state.share for state in reached)),
        least_volume_ratio=_extreme(min, (row["least_volume_ratio"] for row in table.rows)),
    )


def _extreme(choose: Callable[[list[float]], float], values: Iterable[float]) -> float | None:
    known = [value for value in values if not math.isnan(value)]
    return choose(known) if known else None


def plain(row: Mapping[str, float]) -> dict[str, float | str | None]:
    """A line of a table for JSON, which knows neither infinity nor NaN."""
    return {
        name: None if math.isnan(value) else _finite(float(value)) for name, value in row.items()
    }


def _finite(value: Any) -> Any:
    """Infinity as text, for JSON has none, also within lists and tables."""
    if isinstance(value, dict):
        return {name: _finite(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(inner) for inner in value]
    return "inf" if isinstance(value, float) and math.isinf(value) else value
