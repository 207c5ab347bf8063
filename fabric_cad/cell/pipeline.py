"""The stages of a cell, from a measured row to the files of its folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..measured.table_files import stray_tables
from ..measured.tables import Family, expect_row, read_families
from ..model.identification import identify
from ..model.scatter import propagate
from ..model.solved import SolvedFabric, SolvedTable, read_solved
from ..support.errors import InputError, Problem, did_you_mean, quoted
from ..support.interrupts import uninterrupted
from ..support.staging import staged
from ..yarn.planes import contact_patches

if TYPE_CHECKING:
    from ..cad import Consistency
    from ..meshing import Mesh, MeshOptions
    from ..meshing.quality import Quality
    from .report import CellReport


@dataclass
class Stages:
    """Times the stages of a run and tells ``listen`` of each: (name, None) at its start, (name, seconds) at its end."""

    listen: Callable[[str, float | None], None] = lambda _name, _seconds: None
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        """Time the stage of that name, as long as the block lasts."""
        self.listen(name, None)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start
        self.listen(name, self.seconds[name])


def find_row(folder: str | Path, name: str) -> tuple[Family, tuple[InputError, ...]]:
    """The table of one row, from the family tables of a folder, and the errors of other rows and tables.

    Raises :class:`InputError` with the problems of the row where it has any, and with those that
    may be its own (of tables that cannot be read, rows without a proper name, files that are nearly
    called as tables are) where no row is called so.
    """
    read = read_families(folder, partial=True).values()
    tables = [table for table in read if isinstance(table, Family)]
    unread = [table for table in read if isinstance(table, InputError)]
    if problems := [problem for table in tables for problem in table.problems_of(name)]:
        raise InputError(problems)

    for table in tables:
        if name in table:
            others = [InputError(other.refused) for other in tables if other.refused]
            return table[name], (*unread, *others)

    names = [
        *(row for table in tables for row in table.names),
        *(p.row for t in tables for p in t.refused if p.row),
    ]
    message = f"no row is called {quoted(name)}{did_you_mean(name, names)} ('fabric-cad list' shows them all)"
    unnamed = [problem for table in tables for problem in table.refused if not problem.row]
    perhaps = [
        *(problem for error in unread for problem in error.problems),
        *unnamed,
        *stray_tables(Path(folder)),
    ]
    raise InputError([Problem(message, str(folder)), *perhaps])


@dataclass(frozen=True, eq=False)
class Made:
    """A row's cell up to its STEP file, measured: what :func:`make_step` hands on.

    ``std`` holds the standard deviations of the columns of ``table``, None where the row gives
    none.
    """

    row: Family
    table: SolvedTable
    std: dict[str, float] | None
    fabric: SolvedFabric
    step: Path
    consistency: Consistency


@dataclass(frozen=True, eq=False)
class Meshed:
    """The mesh of a cell as read from its file, its quality, and the scaled Jacobian that the yarns' edges allow."""

    mesh: Mesh
    quality: Quality
    allowed: float


def make_step(row: Family, folder: Path, stages: Stages) -> Made:
    """Identify a table of one row, write ``solved.csv`` and the STEP to a folder, and measure the STEP."""
    (name,) = row.names
    with stages("identify"):
        table = identify(row)
        std = propagate(row, table).row(0) if row.scattered[0] else None
        table.write(folder / "solved.csv")
        fabric = read_solved(folder / "solved.csv")

    with stages("load CadQuery"), uninterrupted():
        from ..cad import inspect_cell, read_step
        from ..masters import build_cell

    step = folder / f"{name}.step"
    with stages("solids"):
        cell = build_cell(fabric)
    with stages("write STEP"):
        cell.write_step(step)
    with stages("inspect STEP"):
        consistency = inspect_cell(read_step(step), contact_patches(fabric))

    return Made(row, table, std, fabric, step, consistency)


def make_mesh(made: Made, options: MeshOptions, stages: Stages) -> Meshed:
    """Mesh the STEP into the ``.msh`` beside it, and measure that."""
    msh = made.step.with_suffix(".msh")
    with stages("mesh"):
        with uninterrupted():
            from ..meshing import mesh_cell, read_mesh

        mesh_cell(made.step, made.fabric, options, msh)
        mesh = read_mesh(msh)
    with stages("quality"):
        with uninterrupted():
            from ..meshing.quality import mesh_quality
            from ..yarn.edges import allowed_scaled_jacobian

        return Meshed(mesh, mesh_quality(mesh), allowed_scaled_jacobian(made.fabric))


def checked_report(made: Made, meshed: Meshed | None, stages: Stages) -> CellReport:
    """The report of what was made. Raises :class:`BuildError` where it shows a cell that is not consistent."""
    with uninterrupted():
        from ..model.plausibility import implausible
        from .checks import check_report, doubts
        from .figures import cell_volumes, mesh_figures, yarn_data
        from .report import CellReport, Identification

    row = made.table.row(made.fabric.name)
    report = CellReport(
        fabric=made.fabric,
        identification=Identification.of_row(row, made.table.comparisons[0], made.std),
        consistency=made.consistency,
        volumes=cell_volumes(made.fabric, made.consistency, yarn_data(made.row, 0)),
        mesh=None if meshed is None else mesh_figures(made.fabric, meshed),
        seconds={stage: round(seconds, 4) for stage, seconds in stages.seconds.items()},
    )
    check_report(report)
    warnings = [*map(str, implausible(made.row, made.table.columns)), *doubts(report)]

    return replace(report, warnings=tuple(warnings))


def write_report(report: dict, folder: Path) -> None:
    """Write ``report.json``, which takes the digests of all that is beside it."""
    with uninterrupted():
        from .traces import REPORT, write_traced

    write_traced(report, folder / REPORT)


def make_cell(
    row: Family,
    out: str | Path,
    mesh: dict | None = None,
    dialect: str = "calculix",
    stages: Stages | None = None,
) -> dict:
    """Make every file of one row's cell in the folder ``out/<row name>`` and return its report.

    ``row`` is a table of one row; ``mesh`` holds keywords of
    :func:`fabric_cad.meshing.mesh_options`. Raises :class:`FabricCadError`; the folder then
    is as it was.
    """
    from ..meshing.options import mesh_options
    from .traces import trace

    expect_row(row)
    stages = stages or Stages()
    (name,) = row.names
    options = mesh_options(identify(row)[name], **(mesh or {}))
    report: dict = {}

    with staged(Path(out) / name, partial(write_report, report)) as folder:
        made = make_step(row, folder, stages)
        meshed = make_mesh(made, options, stages)
        with stages("write deck"):
            with uninterrupted():
                from ..decks.cell import write_deck

            write_deck(meshed.mesh, folder / f"{name}.inp", f"elementary cell of {name}", dialect)

        with uninterrupted():
            from ..pictures import draw_cell, write_vtu

        with stages("write vtu"):
            write_vtu(meshed.mesh, meshed.quality, folder / f"{name}.vtu")
        with stages("picture"):
            draw_cell(meshed.mesh, folder / f"{name}.png", name)
        report |= checked_report(made, meshed, stages).content() | trace(row, options)

    return report
