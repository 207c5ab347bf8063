"""What a case of loads is seen by: the series for ParaView, curves, and the deformed cell."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from ..weave.directions import Direction
from .job import Reached, transverse_strains
from .report import Case
from .stress import UNITS, yarn_stress

_UNITS = {
    "points": "mm, deformed",
    "displacement": "mm",
    "contact_pressure_MPa": "MPa, on the wefts' contact surfaces",
    **UNITS,
}
_CRUSH = 0.2  # of a yarn's thickness: how large its greatest displacement in a cut is drawn


def write_states(
    case: Case, times: Iterable[float], labels: Sequence[str], reached: Sequence[Reached], rows: Sequence[dict]
) -> None:
    """Every state as ``<case>.pvd`` and the files it names, with the numbers of its ``rows`` as field data."""
    from ..pictures import State, write_series

    mesh, law = case.cell.mesh, case.settings.yarn
    with case.stages("write states"):
        states = (
            State(
                time,
                label,
                state.displacement,
                {"contact_pressure_MPa": state.pressure},
                yarn_stress(mesh, state.displacement, law).columns(),
                {"row": case.cell.fabric.name, "case": case.kind, **row},
            )
            for time, label, state, row in zip(times, labels, reached, rows)
        )
        write_series(mesh, states, case.path(".pvd"), _UNITS)


def draw_tension(case: Case, rows: list[dict]) -> None:
    """Curves and, where the states span one, the surface."""
    from ..pictures.plots import plot_tension_curves, plot_tension_surface, save_figure

    columns = {name: [row[name] for row in rows] for name in rows[0]}
    columns |= {name: columns[f"{name}_N_per_yarn"] for name in ("T11", "T22")}
    with case.stages("curves"):
        save_figure(plot_tension_curves(columns), case.path("_curves.png"), case.cell.fabric.name)
        if np.linalg.matrix_rank(np.array([columns["E11"], columns["E22"]]), tol=1e-9) == 2:  # rest is among them
            save_figure(plot_tension_surface(columns), case.path("_surface.png"), case.cell.fabric.name)


def draw_shear(case: Case, rows: list[dict]) -> None:
    """Moment and force against the angle."""
    from ..pictures.plots import plot_shear_curve, save_figure

    columns = {name: [row[name] for row in rows] for name in rows[0]}
    with case.stages("curves"):
        figure = plot_shear_curve(columns, allowed=case.penetration_bound)
        save_figure(figure, case.path("_curve.png"), case.cell.fabric.name)


def draw_state(case: Case, state: Reached, label: str) -> None:
    """The deformed cell of Fig. 22b and d, coloured by what is known of it."""
    from ..pictures import draw_deformed

    mesh, title = case.cell.mesh, f"{case.cell.fabric.name}: {label}"
    _, through = transverse_strains(mesh, state.strain)
    warps = [yarn.name for yarn in mesh.yarns if yarn.direction is Direction.WARP]
    pictures = [
        ("_normal", state.displacement[:, 2], "displacement in z, mm", ("weft_1",)),
        ("_strain", through, "strain through the yarn (negative: crushed)", ()),
        ("_pressure", state.pressure, "contact pressure on the wefts, MPa", warps),
    ]
    with case.stages("pictures"):
        for ending, values, bar, hidden in pictures:
            if not np.isnan(values).all():
                path = case.path(f"{ending}.png")
                draw_deformed(mesh, state.displacement, path, values, bar, hide=hidden, title=title)


def draw_crushing(case: Case, state: Reached, label: str) -> None:
    """Cuts along a weft and a warp at rest and under load (Fig. 22c), displacements drawn larger."""
    from ..pictures import cut_along
    from ..pictures.plots import plot_crushing, save_figure

    mesh = case.cell.mesh
    with case.stages("cuts"):
        cuts = {name: cut_along(mesh, state.displacement, name) for name in ("weft_1", "warp_1")}
        shifts = [np.abs(cut.deformed - cut.rest)[:, 1].max() for outlines in cuts.values() for cut in outlines]
        thickness = min(way.thickness for way in case.cell.fabric.directions.values())
        figure = plot_crushing(cuts, _magnified(max(shifts), _CRUSH * thickness))
        save_figure(figure, case.path("_crushing.png"), f"{case.cell.fabric.name}: {label}")


def _magnified(largest: float, wanted: float) -> float:
    """A round factor, at least 1, that makes the largest displacement at most ``wanted``, both mm."""
    if not 0 < largest < wanted:
        return 1.0
    power = 10.0 ** math.floor(math.log10(wanted / largest))
    return max(step * power for step in (1, 2, 5) if step * power <= wanted / largest)
