"""The stiffness of a row's composite, with every file of it in the row's folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...cell.pipeline import Stages
from ...cell.traces import renew_digests, write_traced
from ...measured.tables import Family, expect_row
from ...support.interrupts import uninterrupted
from ...support.staging import staged
from ..constituents import read_constituents
from ..options import USUAL, CompositeOptions
from ..substances import Constituents
from .computation import CompositeStiffness, composite_model, compute_stiffness, periodic_mesh
from .report import StiffnessReport, stiffness_report
from .summary import write_table

NAME = "stiffness"
"""The stem of every file."""

KINDS = ("json", "csv", "png", "pdf", "pvd")
"""Endings of the files of a stiffness; ``.pvd`` names one more a load case."""


def make_stiffness(
    row: Family,
    families: str | Path,
    out: str | Path,
    *,
    mesh: Mapping[str, Any] | None = None,
    options: CompositeOptions = USUAL,
    plate: bool = False,
    stages: Stages | None = None,
) -> StiffnessReport:
    """Homogenise the composite of a table of one row; its files are in ``out/<row name>``, its report is returned.

    ``families`` is the folder whose ``composite.toml`` holds, where it has one; ``mesh`` are
    keywords of :func:`~fabric_cad.composite.spacing.composite_mesh_options`; ``options`` say how
    the matrix fills the box; with ``plate`` the stiffness of the cell as a plate is there too.
    Raises :class:`FabricCadError`; earlier results are then as they were.
    """
    expect_row(row)
    stages = stages or Stages()

    with staged(Path(out) / row.names[0], renew_digests) as folder:
        return write_stiffness(
            row,
            read_constituents(families, row.names[0]),
            folder,
            mesh=mesh or {},
            options=options,
            plate=plate,
            stages=stages,
        )


def write_stiffness(
    row: Family,
    constituents: Constituents,
    folder: Path,
    *,
    mesh: Mapping[str, Any],
    options: CompositeOptions = USUAL,
    plate: bool = False,
    stages: Stages,
) -> StiffnessReport:
    """As :func:`make_stiffness`, of given constituents and into a folder that is there."""
    model = composite_model(row, constituents, mesh=mesh, options=options, stages=stages)
    computed = compute_stiffness(model, plate=plate, stages=stages)
    _write(computed, folder, stages)
    report = stiffness_report(computed, stages.seconds)
    write_table(report, folder / f"{NAME}.csv")
    write_traced(report.content(), folder / f"{NAME}.json")

    return report


def make_deck(
    row: Family,
    families: str | Path,
    out: str | Path,
    *,
    dialect: str,
    mesh: Mapping[str, Any] | None = None,
    options: CompositeOptions = USUAL,
    stages: Stages | None = None,
) -> Path:
    """Write the six load cases as ``stiffness.inp`` for CalculiX or Abaqus, and compute nothing; its place.

    Arguments as those of :func:`make_stiffness`.
    """
    from .deck import write_stiffness_deck

    expect_row(row)
    (name,) = row.names
    stages = stages or Stages()

    with staged(Path(out) / name, renew_digests) as folder:
        constituents = read_constituents(families, name)
        model = composite_model(row, constituents, mesh=mesh or {}, options=options, stages=stages)
        with stages("write deck"):
            write_stiffness_deck(
                model.cell,
                periodic_mesh(model.cell, model.fabric),
                model.fractions,
                model.constituents,
                folder / f"{NAME}.inp",
                title=f"stiffness of the composite cell of {name}",
                dialect=dialect,
            )

    return Path(out) / name / f"{NAME}.inp"


def _write(computed: CompositeStiffness, folder: Path, stages: Stages) -> None:
    """The files that take long: series and picture."""
    with stages("write states"):
        with uninterrupted():
            from .states import write_states

        write_states(computed, folder / f"{NAME}.pvd")

    with stages("picture"):
        with uninterrupted():
            from ...pictures.plots import plot_directions, save_figure

        save_figure(
            plot_directions(computed.effective.stiffness),
            folder / f"{NAME}.png",
            computed.model.fabric.name,
        )
