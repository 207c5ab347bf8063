"""A cell's report as a short table for a person."""

from __future__ import annotations

from collections.abc import Mapping

_QUANTITIES = (
    # label, key, factor
    ("crimp %", "crimp", 100),
    ("width mm", "width_mm", 1),
    ("thickness mm", "thickness_mm", 1),
    ("amplitude mm", "amplitude_mm", 1),
    ("slope", "slope", 1),
)


def summary(report: Mapping) -> str:
    """A short table of the content of a ``report.json``."""
    return "\n".join(
        [
            *_fabric(report),
            *_thicknesses(report),
            *_measured(report),
            *_solids(report),
            *_mesh(report["mesh"]),
            f"  seconds               {sum(report['seconds'].values()):.1f}",
        ]
    )


def _fabric(report: Mapping) -> list[str]:
    weave, identified = report["weave"], report["identified"]
    kind = report["family"]
    if weave["over"] is not None:
        kind += f" {weave['over']}*{weave['under']}"
        kind += f" step {weave['step']}," if report["family"] == "satin" else ","

    gaps = "flat float gaps, " if report["float_gap"] == "flat" else ""
    lines = [
        f"{report['row']}: {kind} {weave['wefts']} wefts x {weave['warps']} warps, "
        f"{report['section']} sections, {gaps}{report['parameters']} parameters",
        f"  {'':22}{'weft':>12}{'warp':>12}",
    ]
    for label, key, factor in _QUANTITIES:
        weft, warp = (f"{factor * identified[name][key]:.4g}" for name in ("weft", "warp"))
        lines.append(f"  {label:22}{weft:>12}{warp:>12}")

    return lines


def _thicknesses(report: Mapping) -> list[str]:
    lines = [f"  fabric thickness      {report['consistency']['thickness_mm']:.4g} mm"]
    if other := report["identified"].get("other_solution"):
        lines.append(
            "  two solutions         the fabric thickness also allows yarns of "
            f"{other['weft_thickness_mm']:.4g} (weft) and {other['warp_thickness_mm']:.4g} mm (warp); "
            "column thicker = weft or warp chooses"
        )
    return lines


def _measured(report: Mapping) -> list[str]:
    return [
        f"  measured, model       {compared['quantity']} {compared['measured']:.4g}, "
        f"{compared['model']:.4g} ({compared['difference_percent']:+.2f} %)"
        for compared in report["measured_vs_model"]
    ]


def _solids(report: Mapping) -> list[str]:
    touch, volumes = report["consistency"], report["volumes"]
    areal = ""
    if "areal_density_g_m2" in volumes:
        areal = f", areal density {volumes['areal_density_g_m2']:.4g} g/m2"
    return [
        f"  contact               gap {touch['max_contact_gap_mm']:.1e} mm, "
        f"penetration {touch['max_penetration_mm']:.1e} mm, "
        f"overlap {touch['overlap_volume_mm3']:.1e} mm3, area {touch['contact_area_mm2']:.4g} mm2",
        f"  yarn volume           {volumes['yarn_mm3']:.5g} mm3, fraction {volumes['yarn_volume_fraction']:.3f}{areal}",
    ]


def _mesh(mesh: Mapping) -> list[str]:
    return [
        f"  mesh                  {mesh['hexahedra']} hexahedra, {mesh['nodes']} nodes, "
        f"{mesh['coincident_contact_nodes']} of {mesh['contact_nodes']} contact nodes coincide",
        f"  scaled Jacobian       min {mesh['min_scaled_jacobian']:.3f}, "
        f"median {mesh['median_scaled_jacobian']:.3f}; "
        f"the yarns' edges allow {mesh['scaled_jacobian_edges_allow']:.3f}",
        f"  element shape         edges at least {mesh['min_opposite_edge_ratio']:.2g} "
        f"of the opposite ones, corners {mesh['min_corner_angle_deg']:.0f} to "
        f"{mesh['max_corner_angle_deg']:.0f} deg, aspect to {mesh['max_aspect']:.3g}",
    ]
