"""Biaxial tension of a cell: the states asked for, and what they say of the fabric.

Forces and strains are those of Hivet and Boisse's Figs. 3, 4 and 22: E11 and E22 the relative
extension of the cell along the wefts and along the warps, T11 and T22 the tension of one yarn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..decks.model import Load
from ..meshing.mesh import Mesh
from .job import Job, widths
from .settings import ContactLaw, TensionCase

_SAME = 1e-9  # by which two strains may differ and be one state


@dataclass(frozen=True)
class Curve:
    """One strain ratio k = E22/E11 and its states (E11, E22), from the smallest strain up."""

    ratio: float
    states: tuple[tuple[float, float], ...]


def curves(case: TensionCase) -> tuple[Curve, ...]:
    """The states of every ratio, evenly spaced until the larger strain is the case's."""
    found = []
    for ratio in case.ratios:
        weft, warp = (1.0, ratio) if ratio <= 1 else (1 / ratio, 1.0)
        steps = [case.strain * at / case.points for at in range(1, case.points + 1)]
        found.append(Curve(ratio, tuple((weft * strain, warp * strain) for strain in steps)))
    return tuple(found)


def paths(case: TensionCase, contact: ContactLaw) -> tuple[tuple[tuple[float, float], ...], ...]:
    """Every state to compute, as few paths as the contact allows; each starts from rest.

    Without friction a state does not depend on how it was reached, and one path winds through all
    of them. With friction a curve is a path of its own, and a row of the grid (one E22) another.
    """
    levels = [case.strain * at / (case.grid - 1) for at in range(case.grid)]
    rays = [curve.states for curve in curves(case)]
    if contact.friction:
        rows = [tuple((weft, warp) for weft in levels if weft or warp) for warp in levels]
        return tuple(rays) + tuple(rows)
    wanted = [(weft, warp) for weft in levels for warp in levels if weft or warp]
    wanted += [state for states in rays for state in states]
    distinct: list[tuple[float, float]] = []
    for state in sorted(wanted):
        if not distinct or math.dist(state, distinct[-1]) > _SAME:
            distinct.append(state)
    columns: list[list[tuple[float, float]]] = []
    for state in distinct:
        if columns and abs(state[0] - columns[-1][0][0]) <= _SAME:
            columns[-1].append(state)
        else:
            columns.append([state])
    return (tuple(state for at, column in enumerate(columns) for state in (column[::-1] if at % 2 else column)),)


def tension_loads(period: tuple[float, float], states: tuple[tuple[float, float], ...]) -> tuple[Load, ...]:
    """The cell's change for every (E11, E22); ``period`` mm."""
    return tuple(
        Load(f"E11 = {weft:.6g}, E22 = {warp:.6g}", (weft * period[0], 0.0, 0.0), (0.0, warp * period[1], 0.0))
        for weft, warp in states
    )


def tension_rows(
    mesh: Mesh,
    period: tuple[float, float],
    case: TensionCase,
    computed: list[tuple[tuple[float, float], ...]],
    jobs: list[Job],
    depths: list[list[float]],
) -> list[dict[str, float]]:
    """The lines of ``tension.csv``, one a state and curve: rest, the curves, then what only the grid has.

    ``computed`` are the paths of ``jobs``; ``depths`` the geometric penetration (mm) of every state reached.
    """
    yarns = [sum(name.startswith(direction) for name in mesh.yarns) for direction in ("weft", "warp")]
    rest = np.ptp(mesh.points[:, 2]), *widths(mesh, mesh.points)
    rows = []
    for path, job, job_depths in zip(computed, jobs, depths):
        for (weft, warp), reached, depth in zip(path, job.reached, job_depths):
            points = mesh.points + reached.displacement
            pulls = reached.forces[0, 0], reached.forces[1, 1]
            wide = widths(mesh, points)
            rows.append(
                {
                    "k": float("nan"),
                    "E11": weft,
                    "E22": warp,
                    "T11_N_per_yarn": pulls[0] / yarns[0],
                    "T22_N_per_yarn": pulls[1] / yarns[1],
                    "T11_N_per_mm": pulls[0] / period[1],
                    "T22_N_per_mm": pulls[1] / period[0],
                    "thickness_mm": float(np.ptp(points[:, 2])),
                    "weft_width_mm": wide[0],
                    "warp_width_mm": wide[1],
                    "thickness_change_percent": 100 * (float(np.ptp(points[:, 2])) / rest[0] - 1),
                    "weft_width_change_percent": 100 * (wide[0] / rest[1] - 1),
                    "warp_width_change_percent": 100 * (wide[1] / rest[2] - 1),
                    "contact_penetration_mm": reached.overclosure,
                    "penetration_mm": depth,
                    "contact_share": reached.share,
                    "strain_energy_N_mm": reached.energy,
                }
            )
    return _by_curve(rows, case, dict(zip(rows[0], [float("nan"), *[0.0] * 6, *rest, *[0.0] * 7])) if rows else {})


def _by_curve(rows: list[dict[str, float]], case: TensionCase, rest: dict[str, float]) -> list[dict[str, float]]:
    """Rows in the order of the curves they lie on, with their k; a state on two curves comes twice."""
    found, used = [rest] if rest else [], set()
    for curve in curves(case):
        for state in curve.states:
            for at, row in enumerate(rows):
                if math.dist(state, (row["E11"], row["E22"])) <= _SAME:
                    found.append(row | {"k": curve.ratio})
                    used.add(at)
                    break
    return found + [row for at, row in enumerate(rows) if at not in used]
