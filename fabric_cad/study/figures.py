"""Figures of a study's table: those of ``report.json``, named by their place in it."""

from __future__ import annotations

from collections.abc import Mapping

from ..model.solved import point_columns
from ..simulation.loads import load_cases
from ..weave.directions import DIRECTIONS

STIFFNESS = "stiffness"
"""The depth of a study that goes as far as the composite's stiffness, and the first word of its figures."""

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
    "stiffness.Ex",
    "stiffness.Ey",
    "stiffness.Ez",
    "stiffness.Gxy",
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
                row |= {
                    f"{key}.{each['quantity']}.{k}": v for k, v in each.items() if k != "quantity"
                }
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
            row |= {
                f"identified.{name}.{k}": v
                for k, v in value.items()
                if k not in ("control_points", "std")
            }
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
