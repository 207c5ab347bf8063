"""What a cell's report must show for the cell to be delivered, and what a person should look at."""

from __future__ import annotations

from ..model.plausibility import LEAST_JACOBIAN, LOW_JACOBIAN, overfull_yarns
from ..support.errors import BuildError
from .figures import MeshFigures
from .pairing import COINCIDENT
from .report import CellReport


def check_report(report: CellReport) -> None:
    """Raise :class:`BuildError` where a report shows a cell that is not consistent."""
    found = report.consistency
    wrong = []
    for key, value in (
        ("max_penetration_mm", found.max_penetration),
        ("max_contact_gap_mm", found.max_contact_gap),
    ):
        if not value <= COINCIDENT:
            wrong.append(f"{key} is {value:.3g}, above {COINCIDENT:g}")

    if report.mesh is not None:
        wrong += _wrong_mesh(report.mesh)
    if wrong:
        raise BuildError(f"{report.fabric.name}: the cell is not consistent: " + "; ".join(wrong))


def _wrong_mesh(mesh: MeshFigures) -> list[str]:
    wrong = []
    if mesh.other_elements:
        wrong.append(f"{mesh.other_elements} elements are no hexahedra")

    if not mesh.min_scaled_jacobian > LEAST_JACOBIAN:
        least = f"{mesh.min_scaled_jacobian:.3g}, not above {LEAST_JACOBIAN:g}"
        wrong.append(f"min_scaled_jacobian is {least}: the mesh has elements no solver takes")

    for name, nodes, paired in (
        ("contact_nodes", mesh.contact_nodes, mesh.coincident_contact_nodes),
        ("end_nodes", mesh.end_nodes, mesh.matching_end_nodes),
    ):
        if nodes != paired:
            wrong.append(f"only {paired} of {nodes} {name} are paired")

    return wrong


def doubts(report: CellReport) -> list[str]:
    """Sentences on what a cell's report shows: fibres that do not fit their yarn, elements of low quality."""
    row, mesh = report.fabric.name, report.mesh
    told = overfull_yarns(
        row, {str(d): share for d, share in report.volumes.fibre_fractions.items()}
    )

    if mesh is not None and mesh.min_scaled_jacobian < LOW_JACOBIAN:
        allowed = f"the yarns' edges allow {mesh.scaled_jacobian_edges_allow:.2g}"
        told.append(
            f"the smallest scaled Jacobian of the mesh is {mesh.min_scaled_jacobian:.2g}, "
            f"below {LOW_JACOBIAN:g} ({allowed}): a solver may lose accuracy there (row {row})"
        )
    return told
