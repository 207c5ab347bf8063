"""The report of a cell: what its files hold, measured on them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..measured.tables import Family
from ..meshing.mesh import Mesh
from ..model.plausibility import LEAST_JACOBIAN
from ..model.solved import Direction, SolvedFabric, point_columns
from ..support.errors import BuildError
from ..weave.bodies import Body, SurfaceKind
from ..weave.directions import DIRECTIONS
from ..weave.lattice import Lattice
from ..weave.weaves import Weave

COINCIDENT = 1e-9
"""Distance (mm) up to which two nodes, or two faces, count as at the same place."""


@dataclass(frozen=True)
class Pairing:
    """How nodes of a mesh pair up: of ``nodes``, ``paired`` have exactly one partner in place."""

    nodes: int
    paired: int


def contact_pairing(mesh: Mesh) -> Pairing:
    """Nodes on contact faces, and those that coincide with exactly one of the other direction."""
    from scipy.spatial import cKDTree

    weft, warp = (
        np.concatenate([mesh.nodes_of(yarn, SurfaceKind.CONTACT) for yarn in mesh.yarns if yarn.direction is direction])
        for direction in DIRECTIONS
    )
    paired = 0
    for nodes, others in ((weft, warp), (warp, weft)):
        partners = cKDTree(mesh.points[others]).query_ball_point(mesh.points[nodes], COINCIDENT, return_length=True)
        paired += int(np.count_nonzero(partners == 1))
    return Pairing(len(weft) + len(warp), paired)


def end_pairing(mesh: Mesh, lattice: Lattice) -> Pairing:
    """Nodes on the yarns' start sections, and those that match one on the end, a period further."""
    from scipy.spatial import cKDTree

    count = paired = 0
    for yarn in mesh.yarns:
        start, end = (mesh.points[mesh.nodes_of(yarn, kind)] for kind in (SurfaceKind.START, SurfaceKind.END))
        shift = lattice.vectors[yarn.direction.axis]
        partners = cKDTree(end).query_ball_point(start + shift, COINCIDENT, return_length=True)
        count += len(start)
        paired += int(np.count_nonzero(partners == 1)) if len(start) == len(end) else 0
    return Pairing(count, paired)


def cell_report(
    fabric: SolvedFabric,
    row: Mapping[str, object],
    comparisons,
    consistency,
    meshed,
    yarn_data: Mapping[str, float | None],
    seconds: Mapping[str, float],
    std: Mapping[str, float] | None = None,
) -> dict:
    """The content of ``report.json``; lengths mm.

    ``consistency`` is what :func:`fabric_cad.cad.inspect_cell` measured on the STEP,
    ``meshed`` (None: no mesh was made) what :func:`fabric_cad.cell.pipeline.make_mesh` read from the mesh file,
    ``yarn_data`` holds
    ``weft_linear_density_tex``, ``warp_linear_density_tex`` and ``fibre_density_g_cm3``,
    ``std`` the standard deviations of the columns of ``row`` where its measurements have any.
    """
    identified = {name: _identified(name, fabric.directions[name]) for name in DIRECTIONS}
    identified["fabric_thickness_mm"] = fabric.fabric_thickness
    if std is not None:
        scattered = SolvedFabric.from_row({**row, **std})  # a fabric whose numbers are standard deviations
        for name, direction in scattered.directions.items():
            identified[name]["std"] = _identified(name, direction)
        identified["fabric_thickness_std_mm"] = scattered.fabric_thickness
    identified["identified_by"] = str(row["identified_by"]).split()
    if row["other_weft_thickness_mm"] != "":
        identified["other_solution"] = {
            "weft_thickness_mm": float(row["other_weft_thickness_mm"]),
            "warp_thickness_mm": float(row["other_warp_thickness_mm"]),
        }
    return {
        "row": fabric.name,
        "family": fabric.family,
        "weave": _weave(fabric.weave),
        "section": fabric.section,
        "float_gap": fabric.float_gap,
        "parameters": int(row["parameters"]),
        "identified": identified,
        "measured_vs_model": [
            {
                "quantity": quantity,
                "measured": measured,
                "model": model,
                "difference_percent": 100 * (model - measured) / measured,
            }
            for quantity, measured, model in comparisons
        ],
        "consistency": {
            "max_penetration_mm": consistency.max_penetration,
            "max_contact_gap_mm": consistency.max_contact_gap,
            "overlap_volume_mm3": consistency.overlap_volume,
            "contact_area_mm2": consistency.contact_area,
            "thickness_mm": consistency.thickness,
        },
        "volumes": _volumes(fabric, consistency, yarn_data),
        **({} if meshed is None else {"mesh": _mesh(fabric, meshed)}),
        "seconds": dict(seconds),
    }


def yarn_data(table: Family, at: int) -> dict[str, float | None]:
    """Linear densities and fibre density of a row, None where not given; a balanced row's warp has its weft's."""
    values = {name: float(table.measured[name][at]) for name in YARN_DATA}
    if table.balanced[at]:
        values["warp_linear_density_tex"] = values["weft_linear_density_tex"]
    return {name: None if np.isnan(value) else value for name, value in values.items()}


YARN_DATA = ("weft_linear_density_tex", "warp_linear_density_tex", "fibre_density_g_cm3")
"""Columns that say how much fibre a yarn holds."""


def _mesh(fabric: SolvedFabric, meshed) -> dict:
    mesh, quality = meshed.mesh, meshed.quality
    contact, ends = contact_pairing(mesh), end_pairing(mesh, fabric.lattice)
    return {
        "nodes": len(mesh.points),
        "hexahedra": len(mesh.hexahedra),
        "other_elements": mesh.other_elements,
        "min_scaled_jacobian": float(quality.scaled_jacobian.min()),
        "median_scaled_jacobian": float(np.median(quality.scaled_jacobian)),
        "scaled_jacobian_edges_allow": meshed.allowed,
        "min_opposite_edge_ratio": float(quality.opposite_edge_ratio.min()),
        "min_corner_angle_deg": float(quality.least_angle.min()),
        "max_corner_angle_deg": float(quality.greatest_angle.max()),
        "max_aspect": float(quality.aspect.max()),
        "contact_nodes": contact.nodes,
        "coincident_contact_nodes": contact.paired,
        "end_nodes": ends.nodes,
        "matching_end_nodes": ends.paired,
    }


def _weave(weave: Weave) -> dict:
    counts = {"wefts": weave.wefts, "warps": weave.warps}
    if weave.pattern:
        return {"over": None, "under": None, "step": None, **counts, "pattern": list(weave.pattern)}
    return {"over": weave.over, "under": weave.under, "step": weave.step, **counts}


def _identified(name: str, solved: Direction) -> dict:
    return {
        "slope": solved.slope,
        "p_low": solved.p_low,
        "p_high": solved.p_high,
        "amplitude_mm": solved.amplitude,
        "thickness_mm": solved.thickness,
        "width_mm": solved.width,
        "spacing_mm": solved.crossed_spacing,
        "crimp": solved.crimp,
        "control_points": {point: list(place) for (point, _, _), place in zip(point_columns(name), solved.points)},
    }


def _volumes(fabric: SolvedFabric, consistency, yarn_data: Mapping[str, float | None]) -> dict:
    x, y = fabric.period
    cell = x * y * consistency.thickness
    total = sum(consistency.yarn_volumes.values())
    volumes = {"yarn_mm3": total, "cell_mm3": cell, "yarn_volume_fraction": total / cell}
    tex = {name: yarn_data.get(f"{name}_linear_density_tex") for name in ("weft", "warp")}
    fibre = yarn_data.get("fibre_density_g_cm3")
    if all(tex.values()):  # tex is g/km; yarns per mm times g/km is g/m2
        volumes["areal_density_g_m2"] = sum(
            tex[name] * (1 + fabric.directions[name].crimp) / fabric.crossed(name).crossed_spacing for name in tex
        )
    for name, count, extent in (("weft", fabric.weave.wefts, x), ("warp", fabric.weave.warps, y)):
        if tex[name] and fibre:
            section = tex[name] / fibre * 1e-3  # mm2 of solid fibre
            length = count * extent * (1 + fabric.directions[name].crimp)
            yarns = sum(v for yarn, v in consistency.yarn_volumes.items() if Body.named(yarn).direction == name)
            volumes[f"{name}_fibre_fraction"] = section * length / yarns
    return volumes


def check_report(report: dict) -> None:
    """Raise :class:`BuildError` where a report shows a cell that is not consistent."""
    consistency, mesh = report["consistency"], report.get("mesh")
    wrong = []
    for key in ("max_penetration_mm", "max_contact_gap_mm"):
        if not consistency[key] <= COINCIDENT:
            wrong.append(f"{key} is {consistency[key]:.3g}, above {COINCIDENT:g}")
    if mesh is not None:
        wrong += _wrong_mesh(mesh)
    if wrong:
        raise BuildError(f"{report['row']}: the cell is not consistent: " + "; ".join(wrong))


def _wrong_mesh(mesh: dict) -> list[str]:
    wrong = []
    if mesh["other_elements"]:
        wrong.append(f"{mesh['other_elements']} elements are no hexahedra")
    if not mesh["min_scaled_jacobian"] > LEAST_JACOBIAN:
        least = f"{mesh['min_scaled_jacobian']:.3g}, not above {LEAST_JACOBIAN:g}"
        wrong.append(f"min_scaled_jacobian is {least}: the mesh has elements no solver takes")
    for nodes, paired in (("contact_nodes", "coincident_contact_nodes"), ("end_nodes", "matching_end_nodes")):
        if mesh[nodes] != mesh[paired]:
            wrong.append(f"only {mesh[paired]} of {mesh[nodes]} {nodes} are paired")
    return wrong


def summary(report: dict) -> str:
    """A short table of a report for a person."""
    weave, found, mesh = report["weave"], report["identified"], report["mesh"]
    touch, volumes = report["consistency"], report["volumes"]
    if weave["over"] is None:
        kind = report["family"]
    else:
        kind = f"{report['family']} {weave['over']}*{weave['under']}" + (
            f" step {weave['step']}," if report["family"] == "satin" else ","
        )
    lines = [
        f"{report['row']}: {kind} {weave['wefts']} wefts x {weave['warps']} warps, "
        f"{report['section']} sections, "
        + ("flat float gaps, " if report["float_gap"] == "flat" else "")
        + f"{report['parameters']} parameters",
        f"  {'':22}{'weft':>12}{'warp':>12}",
    ]
    for label, key, form in (
        ("crimp %", "crimp", lambda v: f"{100 * v:.4g}"),
        ("width mm", "width_mm", lambda v: f"{v:.4g}"),
        ("thickness mm", "thickness_mm", lambda v: f"{v:.4g}"),
        ("amplitude mm", "amplitude_mm", lambda v: f"{v:.4g}"),
        ("slope", "slope", lambda v: f"{v:.4g}"),
    ):
        lines.append(f"  {label:22}{form(found['weft'][key]):>12}{form(found['warp'][key]):>12}")
    lines.append(f"  fabric thickness      {touch['thickness_mm']:.4g} mm")
    if "other_solution" in found:
        other = found["other_solution"]
        lines.append(
            "  two solutions         the fabric thickness also allows yarns of "
            f"{other['weft_thickness_mm']:.4g} (weft) and {other['warp_thickness_mm']:.4g} mm (warp); "
            "column thicker = weft or warp chooses"
        )
    for each in report["measured_vs_model"]:
        lines.append(
            f"  measured, model       {each['quantity']} {each['measured']:.4g}, {each['model']:.4g} "
            f"({each['difference_percent']:+.2f} %)"
        )
    lines += [
        f"  contact               gap {touch['max_contact_gap_mm']:.1e} mm, "
        f"penetration {touch['max_penetration_mm']:.1e} mm, "
        f"overlap {touch['overlap_volume_mm3']:.1e} mm3, area {touch['contact_area_mm2']:.4g} mm2",
        f"  yarn volume           {volumes['yarn_mm3']:.5g} mm3, fraction {volumes['yarn_volume_fraction']:.3f}"
        + (f", areal density {volumes['areal_density_g_m2']:.4g} g/m2" if "areal_density_g_m2" in volumes else ""),
        f"  mesh                  {mesh['hexahedra']} hexahedra, {mesh['nodes']} nodes, "
        f"{mesh['coincident_contact_nodes']} of {mesh['contact_nodes']} contact nodes coincide",
        f"  scaled Jacobian       min {mesh['min_scaled_jacobian']:.3f}, median {mesh['median_scaled_jacobian']:.3f}; "
        f"the yarns' edges allow {mesh['scaled_jacobian_edges_allow']:.3f}",
        f"  element shape         edges at least {mesh['min_opposite_edge_ratio']:.2g} of the opposite ones, corners "
        f"{mesh['min_corner_angle_deg']:.0f} to {mesh['max_corner_angle_deg']:.0f} deg, "
        f"aspect to {mesh['max_aspect']:.3g}",
        f"  seconds               {sum(report['seconds'].values()):.1f}",
    ]
    return "\n".join(lines)
