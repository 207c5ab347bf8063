"""Names of the figures that a study of each depth can have, known before any of its units has run."""

from __future__ import annotations

from dataclasses import fields

from ..cell.figures import MeshFigures
from ..cell.report import CONSISTENCY
from ..composite.stiffness.summary import FIGURES
from ..model.closing import CLOSING
from ..model.solved import point_columns
from ..simulation.loads import load_cases
from ..simulation.report import ContactReport
from ..simulation.settings import Settings
from ..support.errors import did_you_mean, quoted
from ..weave.directions import DIRECTIONS
from .figures import STIFFNESS

_WEAVE = ("over", "under", "step", "wefts", "warps")
_DIRECTION = (
    "slope",
    "p_low",
    "p_high",
    "amplitude_mm",
    "thickness_mm",
    "width_mm",
    "spacing_mm",
    "crimp",
)
_COMPARED = ("measured", "model", "difference_percent")
_VOLUMES = (
    "yarn_mm3",
    "cell_mm3",
    "yarn_volume_fraction",
    "areal_density_g_m2",
    "weft_fibre_fraction",
    "warp_fibre_fraction",
)


def figure_names(depth: str, settings: Settings | None = None) -> tuple[str, ...]:
    """Every figure, a number, that a study of a depth may have; ``settings`` tell those of a load case.

    Not every fabric has all of them (an areal density needs linear densities).
    """
    names = ["parameters", *(f"weave.{name}" for name in _WEAVE)]
    for direction in DIRECTIONS:
        names += [f"identified.{direction}.{name}" for name in _DIRECTION]
        for _, *place in point_columns(direction):
            names += [f"identified.{direction}.control_points.{column}" for column in place]
        names.append(f"identified.other_solution.{direction}_thickness_mm")

    names.append("identified.fabric_thickness_mm")
    names += [f"measured_vs_model.{quantity}.{name}" for quantity in CLOSING for name in _COMPARED]
    names += [f"volumes.{name}" for name in _VOLUMES]

    if depth != "identify":
        names += [f"consistency.{name}" for name in CONSISTENCY]
    if depth not in ("identify", "cell", STIFFNESS):
        names += [f"mesh.{field.name}" for field in fields(MeshFigures)]
    if depth in load_cases():
        known = settings.case(depth).figure_names() if settings is not None else ()
        contact = [field.name for field in fields(ContactReport)]
        names += [f"{depth}.{name}" for name in (*contact, *known)]

    if depth == STIFFNESS:
        names += [f"{depth}.{name}" for name in FIGURES]

    return tuple(names)


def figure_fault(name: str, depth: str, settings: Settings | None = None) -> str | None:
    """Why a name is that of no figure at a depth, None where it is one."""
    known = figure_names(depth, settings)
    if name in known:
        return None
    deeper = next((more for more in ("cell", "mesh") if name in figure_names(more)), None)
    case = name.partition(".")[0]
    if case != depth and case in load_cases() and load_cases()[case].is_studied:
        deeper = case
    if name in figure_names(STIFFNESS):
        deeper = deeper or STIFFNESS
    if deeper:
        return f"{quoted(name)} is a figure of depth {deeper}, this study is of depth {depth}"

    hint = (
        did_you_mean(name, known, 0.5)
        or f"; there are {', '.join(known[-12:])} and others, as in table.csv"
    )
    return f"{quoted(name)} is no figure of depth {depth}{hint}"
