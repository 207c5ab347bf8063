"""The permeability of a row's cell, with every file of it in the row's folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..cell.pipeline import Stages
from ..cell.traces import renew_digests, write_traced
from ..composite.options import Margin
from ..measured.tables import Family, expect_row
from ..model.identification import identify
from ..model.solved import SolvedFabric
from ..support.interrupts import uninterrupted
from ..support.staging import staged
from .computation import CellFlow, cell_flow
from .fineness import Fineness, fineness
from .permeability import Permeability, permeability
from .pores import Pores, pores_of
from .report import PermeabilityReport, permeability_report, write_table
from .space import Top

NAME = "permeability"
"""The stem of every file."""

KINDS = ("json", "csv", "vtu", "png", "pdf")


def make_permeability(
    row: Family,
    families: str | Path,
    out: str | Path,
    *,
    mesh: Mapping[str, Any] | None = None,
    margin: Margin | None = None,
    layers: int | None = None,
    grading: float | None = None,
    top: Top = Top.PERIODIC,
    margin_study: bool = False,
    fibre_diameter: float | None = None,
    stages: Stages | None = None,
) -> PermeabilityReport:
    """Solve the flow through the cell of a table of one row; files in ``out/<row name>``, the report is returned.

    ``mesh`` are keywords of :func:`~fabric_cad.composite.spacing.composite_mesh_options`,
    ``layers`` of ``grading`` lie between the yarns and the box; with a ``fibre_diameter``
    (micrometres) the yarns are porous, their fibre fraction as the ``composite.toml`` in
    ``families`` or the row's linear densities say; with ``margin_study`` the tensor at half and
    twice the margin is there too. Raises :class:`FabricCadError`; earlier results are then as they
    were.
    """
    expect_row(row)
    stages = stages or Stages()
    (name,) = row.names

    with staged(Path(out) / name, renew_digests) as folder:
        with stages("identify"):
            table = identify(row)
            fabric = table[name]
            pores = None if fibre_diameter is None else pores_of(row, families, fibre_diameter)
            fine = fineness(
                fabric, mesh or {}, top=top, margin=margin, layers=layers, grading=grading
            )

        solved = permeability(
            fabric, fine, _told(stages, pores), top=top, margin_study=margin_study
        )
        _write(solved, folder, stages)
        report = permeability_report(row, table, solved, stages.seconds)
        write_table(report, folder / f"{NAME}.csv")
        write_traced(report.content(), folder / f"{NAME}.json")

    return report


def _told(stages: Stages, pores: Pores | None) -> Callable[[SolvedFabric, Fineness, Top], CellFlow]:
    """:func:`cell_flow` as stages of their own."""
    names = iter(("flow", "coarser mesh", "half the margin", "twice the margin"))

    def solve(fabric: SolvedFabric, fine: Fineness, top: Top) -> CellFlow:
        with stages(next(names)):
            return cell_flow(fabric, fine, top, pores)

    return solve


def _write(solved: Permeability, folder: Path, stages: Stages) -> None:
    """The files that take long."""
    with stages("write vtu"):
        with uninterrupted():
            from .files import draw_flow, write_flow

        write_flow(solved.solved, folder / f"{NAME}.vtu")
    with stages("picture"):
        draw_flow(solved.solved, folder / f"{NAME}.png", solved.solved.fabric.name)
