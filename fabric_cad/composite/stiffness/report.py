"""What a stiffness says: its report as a value, which is a dict only when it is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ...cell.traces import trace
from ...model.plausibility import implausible
from ..homogenisation.conjugate_gradients import TOLERANCE
from ..homogenisation.homogenise import constants
from ..micromechanics import METHOD
from ..substances import ELASTIC
from .computation import CompositeStiffness

_DENSITIES = 0.02  # by which the fibre's density in a table and in the constituents may differ

COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")


@dataclass(frozen=True, eq=False)
class StiffnessReport:
    """The content of ``stiffness.json``; fields are called as its keys, which hold plain numbers, lists and texts.

    6 x 6 matrices are in the order xx yy zz yz xz xy with engineering shear; ``plate`` is None
    where not asked for.
    """

    row: str
    C_MPa: list[list[float]]
    S_per_MPa: list[list[float]]  # noqa: N815 (as in the file)
    constants: dict[str, float]
    expansion_per_K: list[float] | None  # noqa: N815 (as in the file)
    conductivity_W_per_mK: list[list[float]] | None  # noqa: N815 (as in the file)
    density_g_cm3: float | None
    voigt_MPa: list[list[float]]  # noqa: N815 (as in the file)
    reuss_MPa: list[list[float]]  # noqa: N815 (as in the file)
    plate: dict[str, Any] | None
    yarn: dict[str, Any]
    matrix: dict[str, Any]
    mesh: dict[str, Any]
    solver: dict[str, Any]
    warnings: list[str]
    seconds: dict[str, float]
    origin: dict[str, Any]

    def content(self) -> dict[str, Any]:
        """What is written, but for the digests of other files."""
        found = asdict(self)
        origin = found.pop("origin")
        if self.plate is None:
            del found["plate"]

        return found | origin


def stiffness_report(computed: CompositeStiffness, seconds: Mapping[str, float]) -> StiffnessReport:
    """The report of a computation; ``seconds`` by stage."""
    effective = computed.effective
    table = computed.model.row
    return StiffnessReport(
        row=computed.model.fabric.name,
        C_MPa=effective.stiffness.tolist(),
        S_per_MPa=np.linalg.inv(effective.stiffness).tolist(),
        constants=constants(effective.stiffness),
        expansion_per_K=_listed(effective.expansion),
        conductivity_W_per_mK=_listed(effective.conductivity),
        density_g_cm3=effective.density,
        voigt_MPa=effective.voigt.tolist(),
        reuss_MPa=effective.reuss.tolist(),
        plate=_plate(computed),
        yarn=_yarn(computed),
        matrix=asdict(computed.model.constituents.matrix),
        mesh=_mesh(computed),
        solver=_solver(computed),
        warnings=_warnings(computed),
        seconds={name: round(value, 4) for name, value in seconds.items()},
        origin=trace(table, computed.model.options),
    )


def _listed(values: np.ndarray | None) -> list | None:
    return None if values is None else values.tolist()


def _plate(computed: CompositeStiffness) -> dict[str, Any] | None:
    plate = computed.plate
    if plate is None:
        return None

    return {
        "A_N_per_mm": plate.A.tolist(),
        "B_N": plate.B.tolist(),
        "D_N_mm": plate.D.tolist(),
        "thickness_mm": plate.thickness,
        "iterations": plate.response.iterations,
        "residual": plate.response.residual,
    }


def _yarn(computed: CompositeStiffness) -> dict[str, Any]:
    """What the yarns were taken to be, and where from."""
    constituents = computed.model.constituents
    given = {
        key: value for key, value in asdict(constituents.yarn).items() if value not in (None, "")
    }
    given.pop("own_fraction")
    fractions = computed.model.fractions[~computed.model.cell.in_matrix]
    known = not np.isnan(fractions).any()

    return {
        "constants_by": f"given: {', '.join(ELASTIC)}" if constituents.yarn.law else METHOD,
        "given": given,
        "fibre": asdict(constituents.fibre) if constituents.fibre else None,
        "fibre_fraction": {"least": float(fractions.min()), "greatest": float(fractions.max())}
        if known
        else None,
        "file": constituents.path,
    }


def _mesh(computed: CompositeStiffness) -> dict[str, Any]:
    cell, volumes = computed.model.cell, computed.effective.response.integrals.volumes[0]
    matrix = cell.in_matrix
    fibre = float(volumes @ computed.model.fractions / volumes.sum())
    return {
        "hexahedra": len(cell.mesh.hexahedra),
        "nodes": len(cell.mesh.points),
        "min_scaled_jacobian": {
            "matrix": float(computed.model.quality[matrix].min()),
            "yarns": float(computed.model.quality[~matrix].min()),
        },
        "box_mm": cell.size.tolist(),
        "margin_mm": cell.margin,
        "closed_wedge_mm": cell.closed_wedge,
        "yarn_volume_fraction": float(volumes[~matrix].sum() / volumes.sum()),
        "fibre_volume_fraction": None if np.isnan(fibre) else fibre,
    }


def _solver(computed: CompositeStiffness) -> dict[str, Any]:
    response = computed.effective.response
    return {
        "method": "trilinear hexahedra, periodic; conjugate gradients, vertical lines as preconditioner",
        "unknowns": int(response.fluctuations[..., 0].size),
        "iterations": response.iterations,
        "residual": response.residual,
        "tolerance": TOLERANCE,
        "asymmetry": response.asymmetry,
    }


def _warnings(computed: CompositeStiffness) -> list[str]:
    constituents, row = computed.model.constituents, computed.model.row
    warnings = list(map(str, implausible(row, computed.model.solved.columns)))
    own, fibre = float(row.measured["fibre_density_g_cm3"][0]), constituents.fibre
    if fibre and fibre.density_g_cm3 and abs(own / fibre.density_g_cm3 - 1) > _DENSITIES:
        told = (
            f"the table gives its fibres {own:g} g/cm3, {constituents.path} {fibre.density_g_cm3:g}"
        )
        warnings.append(f"{row.names[0]}: {told}: are they of one material?")

    return warnings
