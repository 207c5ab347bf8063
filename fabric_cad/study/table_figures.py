"""Figures of all fabrics of a study before there is any CAD, named as :mod:`.figures` names those of a report."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..cell.figures import YARN_DATA
from ..measured.tables import Family
from ..model.closing import CLOSING
from ..model.identification import Identified
from ..model.plausibility import DENSEST, implausible, overfull_yarns
from ..model.solved import point_columns
from ..weave.directions import DIRECTIONS, Direction
from ..weave.weaves import Weave
from ..yarn.volumes import yarn_volumes

Columns = dict[str, Any]
"""Arrays or lists by name, shape (fabrics,)."""


def identified_figures(table: Family, found: Identified) -> Columns:
    """The figures of all fabrics of a table: arrays or lists, shape (fabrics,).

    Volumes are those of :mod:`fabric_cad.yarn.volumes`, in a cell as thick as the model's fabric.
    """
    solved, rows = found.columns, found.rows.tolist()
    weaves = tuple(table.weaves[row] for row in rows) if len(rows) < len(table) else table.weaves
    counts = {id(weave): (weave.wefts, weave.warps) for weave in weaves}
    wefts, warps = np.array([counts[id(weave)] for weave in weaves], dtype=int).reshape(-1, 2).T

    figures = _weave(solved, wefts, warps)
    for direction in DIRECTIONS:
        figures |= _direction(solved, direction)
    figures["identified.fabric_thickness_mm"] = solved["fabric_thickness_mm"]
    figures["identified.identified_by"] = solved["identified_by"]
    figures |= _other_solutions(solved) | _compared(found)

    volumes = _volumes(table, found, weaves, wefts, warps)
    return figures | volumes | _warnings(table, found, volumes)


def _weave(solved: Mapping[str, Any], wefts: np.ndarray, warps: np.ndarray) -> Columns:
    """The weave, whose numbers are empty where a pattern is given, and what stands beside it."""
    patterned = np.array([bool(text) for text in solved["pattern"]], dtype=bool)
    figures: Columns = {f"weave.{name}": solved[name] for name in ("over", "under", "step")}
    if patterned.any():
        for name, column in figures.items():
            figures[name] = [None if given else value for given, value in zip(patterned, column)]

    figures |= {"weave.wefts": wefts, "weave.warps": warps}
    if patterned.any():
        figures["weave.pattern"] = solved["pattern"]
    return figures | {name: solved[name] for name in ("section", "float_gap", "parameters")}


def _direction(solved: Mapping[str, Any], d: Direction) -> Columns:
    """What is identified of the yarns of a direction."""
    p_first, p_second = (np.abs(solved[f"p{1 + d.axis}{k}"]) for k in (1, 2))
    low, high = (p_first, p_second) if d is Direction.WEFT else (p_second, p_first)
    figures: Columns = {
        f"identified.{d}.slope": solved[f"{d}_slope"],
        f"identified.{d}.p_low": low,
        f"identified.{d}.p_high": high,
        f"identified.{d}.amplitude_mm": solved[f"{d}_amplitude_mm"],
        f"identified.{d}.thickness_mm": solved[f"{d}_thickness_mm"],
        f"identified.{d}.width_mm": solved[f"{d}_width_mm"],
        f"identified.{d}.spacing_mm": solved[f"{d}_crossed_spacing_mm"],
        f"identified.{d}.crimp": solved[f"{d}_crimp"],
    }
    for _, *place in point_columns(d):
        figures |= {f"identified.{d}.control_points.{column}": solved[column] for column in place}

    return figures


def _other_solutions(solved: Mapping[str, Any]) -> Columns:
    """Thicknesses of the other solution, of directions that have one in any fabric."""
    figures: Columns = {}
    for d in DIRECTIONS:
        others = solved[f"other_{d}_thickness_mm"]
        if any(value != "" for value in others):
            figures[f"identified.other_solution.{d}_thickness_mm"] = [
                None if v == "" else v for v in others
            ]
    return figures


def _compared(found: Identified) -> Columns:
    """What was measured beyond what identification takes, beside the model's."""
    figures: Columns = {}
    for name, measured, beyond in zip(CLOSING, found.closing, found.beyond):
        if beyond.any():
            given = np.where(beyond, measured, np.nan)
            model = np.where(beyond, found.columns[name], np.nan)
            figures |= {
                f"measured_vs_model.{name}.measured": given,
                f"measured_vs_model.{name}.model": model,
                f"measured_vs_model.{name}.difference_percent": 100 * (model - given) / given,
            }
    return figures


def _warnings(
    table: Family, found: Identified, volumes: Mapping[str, np.ndarray]
) -> dict[str, list[str | None]]:
    """The warnings of every fabric as one text, where any has some."""
    told: dict[str | None, list[str]] = {}
    for problem in implausible(table.take(found.rows.tolist()), found.columns):
        told.setdefault(problem.row, []).append(str(problem))

    fractions: dict[str, np.ndarray] = {
        d: volumes[f"volumes.{d}_fibre_fraction"]
        for d in DIRECTIONS
        if f"volumes.{d}_fibre_fraction" in volumes
    }
    overfull = np.any([share > DENSEST for share in fractions.values()], axis=0)
    for number in np.flatnonzero(overfull).tolist() if fractions else ():
        name = found.columns["name"][number]
        shares: dict[str, float] = {d: float(share[number]) for d, share in fractions.items()}
        told.setdefault(name, []).extend(overfull_yarns(name, shares))

    texts = ["; ".join(told[name]) if name in told else None for name in found.columns["name"]]
    return {"warnings": texts} if told else {}


def _volumes(
    table: Family,
    found: Identified,
    weaves: tuple[Weave, ...],
    wefts: np.ndarray,
    warps: np.ndarray,
) -> dict[str, np.ndarray]:
    solved: Mapping[str, Any] = found.columns
    volumes = yarn_volumes(solved, weaves)
    x, y = warps * solved["weft_crossed_spacing_mm"], wefts * solved["warp_crossed_spacing_mm"]
    cell, total = x * y * solved["fabric_thickness_mm"], volumes["weft"] + volumes["warp"]
    figures = {
        "volumes.yarn_mm3": total,
        "volumes.cell_mm3": cell,
        "volumes.yarn_volume_fraction": total / cell,
    }
    data = {
        name: np.array([np.nan if each is None else each for each in column], dtype=float)
        for name, column in _yarn_data(table, found.rows).items()
    }
    tex = {d: data[f"{d}_linear_density_tex"] for d in DIRECTIONS}
    lengths = {d: 1 + solved[f"{d}_crimp"] for d in DIRECTIONS}
    across = {d: solved[f"{d.other}_crossed_spacing_mm"] for d in DIRECTIONS}
    weft, warp = (tex[d] * lengths[d] / across[d] for d in DIRECTIONS)
    areal = weft + warp
    if not np.isnan(areal).all():
        figures["volumes.areal_density_g_m2"] = areal
    for d, count, extent in zip(DIRECTIONS, (wefts, warps), (x, y)):
        section = tex[d] / data["fibre_density_g_cm3"] * 1e-3
        fraction = section * count * extent * lengths[d] / volumes[d]
        if not np.isnan(fraction).all():
            figures[f"volumes.{d}_fibre_fraction"] = fraction

    return figures


def _yarn_data(table: Family, rows: np.ndarray) -> dict[str, np.ndarray]:
    """:func:`fabric_cad.cell.figures.yarn_data` of many rows, NaN where not given."""
    found = {name: table.measured[name][rows] for name in YARN_DATA}
    weft, warp = (found[f"{d}_linear_density_tex"] for d in DIRECTIONS)
    return found | {"warp_linear_density_tex": np.where(table.balanced[rows], weft, warp)}
