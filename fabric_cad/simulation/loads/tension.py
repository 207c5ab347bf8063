"""Biaxial tension of a cell: the states asked for, and what they say of the fabric.

Forces and strains are those of Hivet and Boisse's Figs. 3, 4 and 22: E11 and E22 the relative
extension of the cell along the wefts and along the warps, T11 and T22 the tension of one yarn.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ...decks.model import Load
from ...measured.settings_files import Check
from ...weave.lattice import Lattice
from ..checks import is_number, whole
from ..laws import ContactLaw
from ..reached import Deformed, tension_per_yarn, thickness, widths
from .case import CONDITION, Line, LoadCase

if TYPE_CHECKING:
    from ..case_run import CaseRun
    from ..case_table import CaseTable
    from ..report import CaseReport

Strains = tuple[float, float]
"""E11 and E22."""

_SAME = 1e-9  # by which two strains may differ and be one state
_SIZES = ("thickness", "weft_width", "warp_width")
_MEASURES = (
    "T11_N_per_yarn",
    "T22_N_per_yarn",
    "T11_N_per_mm",
    "T22_N_per_mm",
    *(f"{size}_mm" for size in _SIZES),
    *(f"{size}_change_percent" for size in _SIZES),
)


@dataclass(frozen=True)
class Curve:
    """One strain ratio k = E22/E11 and its states (E11, E22), from the smallest strain up."""

    ratio: float
    states: tuple[Strains, ...]


@dataclass(frozen=True)
class TensionCase(LoadCase[Strains]):
    """Biaxial tension to a strain, on curves of the given ratios E22/E11 and on a grid."""

    strain: float
    ratios: tuple[float, ...]
    points: int
    grid: int

    name: ClassVar[str] = "tension"
    text: ClassVar[str] = (
        "stretch a row's cell biaxially with CalculiX: curves and surfaces of tension"
    )
    checks: ClassVar[Mapping[str, Check]] = MappingProxyType(
        {
            "strain": (float, lambda strain: 0 < strain <= 0.1, "is not above 0 and up to 0.1"),
            "ratios": (
                list,
                lambda ratios: bool(ratios) and all(is_number(k) and k >= 0 for k in ratios),
                "is not a list of numbers from 0 to inf",
            ),
            "points": whole(1, 100),
            "grid": whole(0, 50),
        }
    )
    is_studied: ClassVar[bool] = True
    headline: ClassVar[tuple[str, ...]] = ("k=0.T11_N_per_yarn", "k=1.T11_N_per_yarn")

    def __post_init__(self) -> None:
        object.__setattr__(self, "ratios", tuple(map(float, self.ratios)))

    def paths(self, contact: ContactLaw) -> Sequence[Sequence[Strains]]:
        """Every state to compute, as few paths as the contact allows; each starts from rest.

        Without friction a state does not depend on how it was reached, and one path winds through
        all of them. With friction a curve is a path of its own, and a row of the grid (one E22)
        another.
        """
        levels = (
            [self.strain * step / (self.grid - 1) for step in range(self.grid)]
            if self.grid > 1
            else []
        )
        rays = [curve.states for curve in curves(self)]
        if contact.friction:
            rows = [tuple((weft, warp) for weft in levels if weft or warp) for warp in levels]
            return (*rays, *rows)

        grid = [(weft, warp) for weft in levels for warp in levels if weft or warp]
        return (_winding([*grid, *(state for states in rays for state in states)]),)

    def load(self, state: Strains, lattice: Lattice) -> Load:
        """The cell's periods longer by E11 and E22."""
        return Load.of(
            f"E11 = {state[0]:.6g}, E22 = {state[1]:.6g}",
            np.array(state)[:, None] * lattice.vectors,
        )

    def at_rest(self) -> Strains:
        """No strain."""
        return 0.0, 0.0

    def lines(self, states: Sequence[Strains]) -> Sequence[Line]:
        """States on no curve with k NaN, then those of every curve with its k.

        One on two curves comes twice.
        """
        on_curves = [
            (number, curve.ratio)
            for curve in curves(self)
            for wanted in curve.states
            if (
                number := next(
                    (n for n, state in enumerate(states) if math.dist(wanted, state) <= _SAME), None
                )
            )
            is not None
        ]
        used = {number for number, _ in on_curves}
        others = [(number, math.nan) for number in range(len(states)) if number not in used]

        return [
            Line(number, place, {"k": ratio, "E11": states[number][0], "E22": states[number][1]})
            for place, (number, ratio) in enumerate([*others, *on_curves])
        ]

    def measures(self, state: Strains, deformed: Deformed) -> dict[str, float]:
        """Tensions of a yarn and per mm of fabric, the fabric's thickness and the yarns' widths, and their changes."""
        mesh, forces = deformed.mesh, deformed.reached.forces
        pulls = np.array([forces[0, 0], forces[1, 1]])
        length, width = np.linalg.norm(deformed.lattice.vectors, axis=1)
        before, after = (
            (thickness(points), *widths(mesh, points)) for points in (mesh.points, deformed.points)
        )

        return {
            **tension_per_yarn(mesh, pulls),
            "T11_N_per_mm": pulls[0] / width,
            "T22_N_per_mm": pulls[1] / length,
            **{f"{name}_mm": value for name, value in zip(_SIZES, after)},
            **{
                f"{name}_change_percent": 100 * (new / old - 1)
                for name, new, old in zip(_SIZES, after, before)
            },
        }

    def label(self, row: Mapping[str, float]) -> str:
        """Its k where it has one, E11 and E22."""
        ratio = "" if math.isnan(row["k"]) else f"k = {row['k']:g}, "
        return f"{ratio}E11 = {100 * row['E11']:.4g} %, E22 = {100 * row['E22']:.4g} %"

    def draw(self, run: CaseRun, table: CaseTable) -> None:
        """Curves, the surface where the states span one, and the valid state of the largest strains."""
        from ..pictures import draw_crushing, draw_state

        loaded = [
            line for line in table.valid if table.rows[line]["E11"] or table.rows[line]["E22"]
        ]
        if not loaded:
            return

        _draw_curves(run, table)
        largest = max(
            loaded, key=lambda line: sorted((table.rows[line]["E11"], table.rows[line]["E22"]))
        )
        draw_state(run, table.reached[largest], table.labels[largest])
        draw_crushing(run, table.reached[largest], table.labels[largest])

    def findings(self, run: CaseRun, table: CaseTable) -> dict[str, Any]:
        """``largest``: the last line of every curve."""
        from ..report import plain

        ends = {row["k"]: row for row in table.rows if not math.isnan(row["k"])}
        return {"largest": [plain(row) for row in ends.values()]}

    def summary(self, report: CaseReport) -> list[str]:
        """The end of every curve."""
        lines = [
            f"  {'k':>6}{'E11 %':>9}{'E22 %':>9}{'T11 N per yarn':>16}{'T22 N per yarn':>16}{'thickness %':>13}"
        ]
        for end in report.findings["largest"]:
            lines.append(
                f"  {end['k']!s:>6}{100 * end['E11']:9.3g}{100 * end['E22']:9.3g}{end['T11_N_per_yarn']:16.5g}"
                f"{end['T22_N_per_yarn']:16.5g}{end['thickness_change_percent']:+13.2f}"
            )
        return lines

    def figure_names(self) -> tuple[str, ...]:
        """``k=1.T11_N_per_yarn`` and so on, of the end of every curve."""
        columns = ("E11", "E22", *_MEASURES, *CONDITION)
        return tuple(f"k={ratio:g}.{column}" for ratio in self.ratios for column in columns)

    def figures(self, findings: Mapping[str, Any]) -> dict[str, Any]:
        """The ends of curves."""
        return {
            f"k={float(end['k']):g}.{column}": value
            for end in findings["largest"]
            for column, value in end.items()
            if column != "k"
        }


def curves(case: TensionCase) -> tuple[Curve, ...]:
    """The states of every ratio, evenly spaced until the larger strain is the case's."""
    rays = []
    for ratio in case.ratios:
        weft, warp = (1.0, ratio) if ratio <= 1 else (1 / ratio, 1.0)
        steps = [case.strain * step / case.points for step in range(1, case.points + 1)]
        rays.append(Curve(ratio, tuple((weft * strain, warp * strain) for strain in steps)))
    return tuple(rays)


def _winding(states: Sequence[Strains]) -> tuple[Strains, ...]:
    """Every state once: those of one E11 up in E22, those of the next one down, and so on."""
    distinct: list[Strains] = []
    for state in sorted(states):
        if not distinct or math.dist(state, distinct[-1]) > _SAME:
            distinct.append(state)

    columns: list[list[Strains]] = []
    for state in distinct:
        if columns and abs(state[0] - columns[-1][0][0]) <= _SAME:
            columns[-1].append(state)
        else:
            columns.append([state])

    return tuple(
        state
        for number, column in enumerate(columns)
        for state in (column[::-1] if number % 2 else column)
    )


def _draw_curves(run: CaseRun, table: CaseTable) -> None:
    """Curves and, where the states span one, the surface."""
    from ...pictures.plots import plot_tension_curves, plot_tension_surface, save_figure

    columns = table.columns()
    columns |= {name: columns[f"{name}_N_per_yarn"] for name in ("T11", "T22")}
    with run.stages("curves"):
        save_figure(plot_tension_curves(columns), run.path("_curves.png"), run.cell.fabric.name)
        if (
            np.linalg.matrix_rank(np.array([columns["E11"], columns["E22"]]), tol=1e-9) == 2
        ):  # rest is among them
            save_figure(
                plot_tension_surface(columns), run.path("_surface.png"), run.cell.fabric.name
            )
