"""What a case of loads is seen by: the series for ParaView, curves, and the deformed cell."""

from __future__ import annotations

import math

import numpy as np

from ..weave.directions import Direction
from .case_run import CaseRun
from .case_table import CaseTable
from .reached import Reached, transverse_strains
from .stress import UNITS, yarn_stress

_UNITS = {
    "points": "mm, deformed",
    "displacement": "mm",
    "contact_pressure_MPa": "MPa, on the wefts' contact surfaces",
    **UNITS,
}
_CRUSH = 0.2  # of a yarn's thickness: how large its greatest displacement in a cut is drawn


def write_states(run: CaseRun, table: CaseTable) -> None:
    """Every line as a state of ``<case>.pvd`` and the files it names, with its numbers as field data."""
    from ..pictures import State, write_series

    mesh, law = run.cell.mesh, run.settings.yarn
    with run.stages("write states"):
        states = (
            State(
                time,
                label,
                reached.displacement,
                {"contact_pressure_MPa": reached.pressure},
                yarn_stress(mesh, reached.displacement, law).columns(),
                {"row": run.cell.fabric.name, "case": run.case.name, **row},
            )
            for time, label, reached, row in zip(
                table.times, table.labels, table.reached, table.rows
            )
        )
        write_series(mesh, states, run.path(".pvd"), _UNITS)


def draw_state(run: CaseRun, state: Reached, label: str) -> None:
    """The deformed cell of Fig. 22b and d, coloured by what is known of it."""
    from ..pictures import draw_deformed

    mesh, title = run.cell.mesh, f"{run.cell.fabric.name}: {label}"
    _, through = transverse_strains(mesh, state.strain)
    warps = [yarn.name for yarn in mesh.yarns if yarn.direction is Direction.WARP]
    pictures = [
        ("_normal", state.displacement[:, 2], "displacement in z, mm", ("weft_1",)),
        ("_strain", through, "strain through the yarn (negative: crushed)", ()),
        ("_pressure", state.pressure, "contact pressure on the wefts, MPa", warps),
    ]

    with run.stages("pictures"):
        for ending, values, bar, hidden in pictures:
            if not np.isnan(values).all():
                path = run.path(f"{ending}.png")
                draw_deformed(mesh, state.displacement, path, values, bar, hide=hidden, title=title)


def draw_crushing(run: CaseRun, state: Reached, label: str) -> None:
    """Cuts along a weft and a warp at rest and under load (Fig. 22c), displacements drawn larger."""
    from ..pictures import cut_along
    from ..pictures.plots import plot_crushing, save_figure

    mesh = run.cell.mesh
    with run.stages("cuts"):
        cuts = {name: cut_along(mesh, state.displacement, name) for name in ("weft_1", "warp_1")}
        shifts = [
            np.abs(cut.deformed - cut.rest)[:, 1].max()
            for outlines in cuts.values()
            for cut in outlines
        ]
        thickness = min(way.thickness for way in run.cell.fabric.directions.values())
        figure = plot_crushing(cuts, _magnified(max(shifts), _CRUSH * thickness))
        save_figure(figure, run.path("_crushing.png"), f"{run.cell.fabric.name}: {label}")


def _magnified(largest: float, wanted: float) -> float:
    """A round factor, at least 1, that makes the largest displacement at most ``wanted``, both mm."""
    if not 0 < largest < wanted:
        return 1.0
    power = 10.0 ** math.floor(math.log10(wanted / largest))
    return max(step * power for step in (1, 2, 5) if step * power <= wanted / largest)
