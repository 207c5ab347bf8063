"""What tests of the command put in the place of a cell that takes seconds to make."""

HEADER = "name,over,under,weft_density_per_mm,weft_width_mm,weft_crimp"


def small_report():
    direction = dict.fromkeys(("crimp", "width_mm", "thickness_mm", "amplitude_mm", "slope"), 0.1)
    return {
        "row": "plain",
        "family": "plain",
        "section": "lenticular",
        "float_gap": "symmetric",
        "parameters": 3,
        "weave": {"over": 1, "under": 1, "step": 1, "wefts": 2, "warps": 2},
        "identified": {"weft": direction, "warp": direction},
        "measured_vs_model": [],
        "consistency": dict.fromkeys(
            (
                "max_penetration_mm",
                "max_contact_gap_mm",
                "overlap_volume_mm3",
                "contact_area_mm2",
                "thickness_mm",
            ),
            0.0,
        ),
        "volumes": {"yarn_mm3": 1.0, "cell_mm3": 2.0, "yarn_volume_fraction": 0.5},
        "mesh": dict.fromkeys(
            (
                "nodes",
                "hexahedra",
                "contact_nodes",
                "coincident_contact_nodes",
                "min_scaled_jacobian",
                "median_scaled_jacobian",
                "scaled_jacobian_edges_allow",
                "min_opposite_edge_ratio",
                "min_corner_angle_deg",
                "max_corner_angle_deg",
                "max_aspect",
            ),
            1,
        ),
        "seconds": {},
        "warnings": [],
    }
