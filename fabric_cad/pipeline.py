"""The stages of a cell, from a measured row to the files of its folder."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from .errors import InputError
from .identification import identify
from .scatter import propagate
from .solved import read_solved
from .staging import staged
from .sweeps import contact_patches
from .tables import Family, read_families

_YARN_DATA = ("weft_linear_density_tex", "warp_linear_density_tex", "fibre_density_g_cm3")


@dataclass
class Stages:
    """Times the stages of a run and tells ``listen`` of each: (name, None) at its start, (name, seconds) at its end."""

    listen: Callable[[str, float | None], None] = lambda name, seconds: None
    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def __call__(self, name: str) -> Iterator[None]:
        self.listen(name, None)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start
        self.listen(name, self.seconds[name])


def find_row(folder: str | Path, name: str) -> tuple[Family, tuple[InputError, ...]]:
    """The table of one row, from the family tables of a folder, and the errors of other tables.

    Raises :class:`InputError` where no sound table has the row, or its own table has
    anything wrong.
    """
    from difflib import get_close_matches

    tables = read_families(folder)
    errors = {family: table for family, table in tables.items() if isinstance(table, InputError)}
    for family, table in tables.items():
        if family not in errors and name in table.names:
            return table[name], tuple(errors.values())
    if errors:
        problems = [problem for error in errors.values() for problem in error.problems]
        raise InputError(problems)
    names = [each for table in tables.values() for each in table.names]
    near = get_close_matches(name, names, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    raise InputError(f"{folder}: no row is called {name!r}{hint} ('fabric-cad list' shows them all)")


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
    stages = stages or Stages()
    (name,) = row.names
    with stages("identify"):
        table = identify(row)
        std = propagate(row, table).row(0) if row.scattered[0] else None
    with staged(Path(out) / name) as folder:
        path = {kind: folder / f"{name}.{kind}" for kind in ("step", "msh", "inp", "vtu", "png")}
        table.write(folder / "solved.csv")
        fabric = read_solved(folder / "solved.csv")
        from .meshing.options import mesh_options

        options = mesh_options(fabric, **(mesh or {}))
        with stages("load CadQuery"):
            from .cad import inspect_cell, read_step
            from .masters import build_cell
        with stages("solids"):
            cell = build_cell(fabric)
        with stages("write STEP"):
            cell.write_step(path["step"])
        with stages("inspect STEP"):
            consistency = inspect_cell(read_step(path["step"]), contact_patches(fabric))
        with stages("mesh"):
            from .meshing.mesher import mesh_cell, read_mesh

            mesh_cell(path["step"], fabric, options, path["msh"])
            cell_mesh = read_mesh(path["msh"])
        with stages("quality"):
            from .edges import allowed_scaled_jacobian
            from .views import draw_cell, scaled_jacobians, write_vtu

            quality = scaled_jacobians(cell_mesh)
            allowed = allowed_scaled_jacobian(fabric)
        with stages("write deck"):
            from .decks.cell import write_deck

            write_deck(cell_mesh, path["inp"], f"elementary cell of {name}", dialect)
        with stages("write vtu"):
            write_vtu(cell_mesh, quality, path["vtu"])
        with stages("picture"):
            draw_cell(cell_mesh, path["png"])
        from .report import cell_report, check_report

        measured = {key: float(row.measured[key][0]) for key in _YARN_DATA}
        yarn_data = {key: None if math.isnan(value) else value for key, value in measured.items()}
        if row.balanced[0]:
            yarn_data["warp_linear_density_tex"] = yarn_data["weft_linear_density_tex"]
        report = cell_report(
            fabric,
            table.row(name),
            table.comparisons[0],
            consistency,
            cell_mesh,
            quality,
            allowed,
            yarn_data,
            {key: round(value, 4) for key, value in stages.seconds.items()},
            std,
        )
        check_report(report)
        (folder / "report.json").write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    return report
