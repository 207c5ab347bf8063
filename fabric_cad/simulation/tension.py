"""Biaxial tension of a cell: the states asked for, and what they say of the fabric.

Forces and strains are those of Hivet and Boisse's Figs. 3, 4 and 22: E11 and E22 the relative
extension of the cell along the wefts and along the warps, T11 and T22 the tension of one yarn.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..decks.model import Load
from ..meshing.mesh import Mesh
from .job import Reached, tension_per_yarn, widths
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
    levels = [case.strain * at / (case.grid - 1) for at in range(case.grid)] if case.grid > 1 else []
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


def tension_row(
    mesh: Mesh, period: tuple[float, float], state: tuple[float, float], reached: Reached, condition: dict[str, float]
) -> dict[str, float]:
    """The line of ``tension.csv`` for one (E11, E22), its k still open; ``condition`` as of :func:`.job.condition`."""
    pulls = reached.forces[0, 0], reached.forces[1, 1]
    points = mesh.points + reached.displacement
    before, after = ((float(np.ptp(places[:, 2])), *widths(mesh, places)) for places in (mesh.points, points))
    sizes = ("thickness", "weft_width", "warp_width")
    return {
        "k": math.nan,
        "E11": state[0],
        "E22": state[1],
        **tension_per_yarn(mesh, pulls),
        "T11_N_per_mm": pulls[0] / period[1],
        "T22_N_per_mm": pulls[1] / period[0],
        **{f"{name}_mm": value for name, value in zip(sizes, after)},
        **{f"{name}_change_percent": 100 * (new / old - 1) for name, new, old in zip(sizes, after, before)},
        **condition,
    }


def by_curve(states: Sequence[tuple[float, float]], case: TensionCase) -> list[tuple[int, float]]:
    """The order of the table: numbers of states on no curve with k NaN, then those of every curve with its k.

    A state on two curves comes twice.
    """
    on_curves = [
        (number, curve.ratio)
        for curve in curves(case)
        for wanted in curve.states
        if (number := next((n for n, state in enumerate(states) if math.dist(wanted, state) <= _SAME), None))
        is not None
    ]
    used = {number for number, _ in on_curves}
    return [(number, math.nan) for number in range(len(states)) if number not in used] + on_curves


def state_label(row: Mapping[str, float]) -> str:
    """A line of ``tension.csv`` in words: its k where it has one, E11 and E22."""
    ratio = "" if math.isnan(row["k"]) else f"k = {row['k']:g}, "
    return f"{ratio}E11 = {100 * row['E11']:.4g} %, E22 = {100 * row['E22']:.4g} %"
