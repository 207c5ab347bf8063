"""Figures of a study's table: those of ``report.json``, named by their place in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..cell.figures import YARN_DATA
from ..measured.tables import Family
from ..model.closing import CLOSING
from ..model.identification import Identified
from ..model.plausibility import DENSEST, implausible, overfull_yarns
from ..model.solved import point_columns
from ..simulation.loads import load_cases
from ..weave.directions import DIRECTIONS
from ..yarn.volumes import yarn_volumes

_HEADLINE = (
    "identified.fabric_thickness_mm",
    "identified.weft.crimp",
    "identified.warp.crimp",
    "identified.weft.thickness_mm",
    "identified.warp.thickness_mm",
    "volumes.yarn_volume_fraction",
    "volumes.areal_density_g_m2",
    "volumes.weft_fibre_fraction",
    "volumes.warp_fibre_fraction",
    "mesh.min_scaled_jacobian",
)


def headline() -> tuple[str, ...]:
    """Figures whose sensitivity is computed where a study names none."""
    loaded = [f"{name}.{figure}" for name, case in load_cases().items() for figure in case.headline]
    return (*_HEADLINE, *loaded)


def flat(report: Mapping) -> dict[str, object]:
    """A report as one row: ``volumes.yarn_mm3``, ``identified.weft.control_points.M11_x_mm`` ..., without its times."""
    row: dict[str, object] = {}
    for key, value in report.items():
        if key in ("row", "family", "seconds", "options"):
            continue
        if key == "warnings":
            row |= {key: "; ".join(value)} if value else {}
        elif key == "measured_vs_model":
            for each in value:
                row |= {f"{key}.{each['quantity']}.{k}": v for k, v in each.items() if k != "quantity"}
        elif key == "identified":
            row |= _identified(value)
        elif isinstance(value, Mapping):
            row |= {f"{key}.{name}": _text(each) for name, each in value.items()}
        else:
            row[key] = value
    return row


def _identified(found: Mapping) -> dict[str, object]:
    row: dict[str, object] = {}
    for name, value in found.items():
        if name in DIRECTIONS:
            row |= {f"identified.{name}.{k}": v for k, v in value.items() if k not in ("control_points", "std")}
            for _, *place in point_columns(name):
                point = place[0].split("_")[0]
                for column, each in zip(place, value["control_points"][point]):
                    row[f"identified.{name}.control_points.{column}"] = each
        elif name == "other_solution":
            row |= {f"identified.{name}.{k}": v for k, v in value.items()}
        else:
            row[f"identified.{name}"] = _text(value)
    return row


def _text(value: object) -> object:
    return " ".join(value) if isinstance(value, list) else value


def identified_figures(table: Family, found: Identified) -> dict[str, Sequence]:
    """The same figures of all fabrics of a table before there is any CAD: arrays or lists, shape (fabrics,).

    Volumes are those of :mod:`fabric_cad.yarn.volumes`, in a cell as thick as the model's fabric.
    """
    solved, rows = found.columns, found.rows.tolist()
    weaves = tuple(table.weaves[at] for at in rows) if len(rows) < len(table) else table.weaves
    counts = {id(weave): (weave.wefts, weave.warps) for weave in weaves}
    wefts, warps = np.array([counts[id(weave)] for weave in weaves], dtype=int).reshape(-1, 2).T
    patterned = np.array([bool(text) for text in solved["pattern"]], dtype=bool)
    figures: dict[str, Sequence] = {
        f"weave.{name}": [None if given else value for given, value in zip(patterned, solved[name])]
        if patterned.any()
        else solved[name]
        for name in ("over", "under", "step")
    }
    figures |= {"weave.wefts": wefts, "weave.warps": warps}
    if patterned.any():
        figures["weave.pattern"] = solved["pattern"]
    figures |= {name: solved[name] for name in ("section", "float_gap", "parameters")}
    for d in DIRECTIONS:
        p_first, p_second = (np.abs(solved[f"p{1 + DIRECTIONS.index(d)}{k}"]) for k in (1, 2))
        low, high = (p_first, p_second) if d == "weft" else (p_second, p_first)
        figures |= {
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
    figures["identified.fabric_thickness_mm"] = solved["fabric_thickness_mm"]
    figures["identified.identified_by"] = solved["identified_by"]
    for d in DIRECTIONS:
        others = solved[f"other_{d}_thickness_mm"]
        if any(value != "" for value in others):
            figures[f"identified.other_solution.{d}_thickness_mm"] = [None if v == "" else v for v in others]
    for name, measured, beyond in zip(CLOSING, found.closing, found.beyond):
        if beyond.any():
            given = np.where(beyond, measured, np.nan)
            model = np.where(beyond, solved[name], np.nan)
            figures |= {
                f"measured_vs_model.{name}.measured": given,
                f"measured_vs_model.{name}.model": model,
                f"measured_vs_model.{name}.difference_percent": 100 * (model - given) / given,
            }
    volumes = _volumes(table, found, weaves, wefts, warps)
    return figures | volumes | _warnings(table, found, volumes)


def _warnings(table: Family, found: Identified, volumes: Mapping[str, np.ndarray]) -> dict[str, list[str | None]]:
    """The warnings of every fabric as one text, where any has some."""
    told: dict[str | None, list[str]] = {}
    for problem in implausible(table.take(found.rows.tolist()), found.columns):
        told.setdefault(problem.row, []).append(str(problem))

    fractions = {
        d: volumes[f"volumes.{d}_fibre_fraction"] for d in DIRECTIONS if f"volumes.{d}_fibre_fraction" in volumes
    }
    overfull = np.any([share > DENSEST for share in fractions.values()], axis=0)
    for number in np.flatnonzero(overfull) if fractions else ():
        name = found.columns["name"][number]
        shares = {d: float(share[number]) for d, share in fractions.items()}
        told.setdefault(name, []).extend(overfull_yarns(name, shares))

    texts = ["; ".join(told[name]) if name in told else None for name in found.columns["name"]]
    return {"warnings": texts} if told else {}


def _volumes(table: Family, found: Identified, weaves, wefts, warps) -> dict[str, np.ndarray]:
    solved, rows = found.columns, found.rows
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
        for name, column in _yarn_data(table, rows).items()
    }
    tex = {d: data[f"{d}_linear_density_tex"] for d in DIRECTIONS}
    lengths = {d: 1 + solved[f"{d}_crimp"] for d in DIRECTIONS}
    across = {d: solved[f"{crossed}_crossed_spacing_mm"] for d, crossed in zip(DIRECTIONS, reversed(DIRECTIONS))}
    areal = sum(tex[d] * lengths[d] / across[d] for d in DIRECTIONS)
    if not np.isnan(areal).all():
        figures["volumes.areal_density_g_m2"] = areal
    for d, count, extent in (("weft", wefts, x), ("warp", warps, y)):
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
