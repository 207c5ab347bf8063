"""The permeability of a row's cell: the tensor, its error bar, and what closes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..composite.options import Margin
from ..model.solved import SolvedFabric
from .computation import CellFlow, cell_flow
from .files import name_of
from .fineness import Fineness
from .space import Top

_NONE = 1e-12  # of the largest principal value: less is a closed direction


@dataclass(frozen=True, eq=False)
class Permeability:
    """Permeability of a cell under a unit margin.

    ``principal`` (3,), mm2, from the largest to the least, along the rows of ``axes`` (3, 3);
    ``error`` (3,) is by how much, in per cent, each differs on a mesh of half the layers, 0 where
    it is 0. ``study`` maps other margins (mm) to their tensors, mm2.
    """

    solved: CellFlow
    coarse: CellFlow
    principal: np.ndarray
    axes: np.ndarray
    error: np.ndarray
    study: dict[float, np.ndarray]

    @property
    def tensor(self) -> np.ndarray:
        """K (3, 3), mm2."""
        return self.solved.flow.permeability

    @property
    def closed(self) -> list[str]:
        """A sentence for every direction in which nothing flows, which says why."""
        open_ways = self.solved.flow.directions
        others = np.eye(3) - open_ways.T @ open_ways
        values, ways = np.linalg.eigh(others)
        return [
            _why(name_of(way), self.solved.top) for value, way in zip(values, ways.T) if value > 0.5
        ]


def permeability(
    fabric: SolvedFabric,
    fineness: Fineness,
    solve: Callable[[SolvedFabric, Fineness, Top], CellFlow] = cell_flow,
    *,
    top: Top = Top.PERIODIC,
    margin_study: bool = False,
) -> Permeability:
    """The permeability of a fabric's cell; ``solve`` gives the flow for a fineness.

    With ``margin_study`` at half and at twice the margin as well. Raises what ``solve`` raises.
    """
    solved = solve(fabric, fineness, top)
    coarse = solve(fabric, fineness.halved(fabric), top)
    values, vectors = np.linalg.eigh(solved.flow.permeability)
    principal, axes = values[::-1], vectors.T[::-1]
    axes = (
        axes * np.where(axes[np.arange(3), np.argmax(np.abs(axes), axis=1)] < 0, -1.0, 1.0)[:, None]
    )
    principal = np.where(principal > _NONE * max(principal[0], 0.0), principal, 0.0)

    other = np.einsum("ni,ij,nj->n", axes, coarse.flow.permeability, axes)
    error = 100 * np.abs(np.divide(other, principal, out=np.ones(3), where=principal > 0) - 1)
    study = {}

    for factor in (0.5, 2.0) if margin_study else ():
        margin = Margin(factor * solved.cell.margin, is_share=False)
        flow = solve(fabric, replace(fineness, box=replace(fineness.box, margin=margin)), top).flow
        study[margin.amount] = flow.permeability

    return Permeability(solved, coarse, principal, axes, error, study)


def _why(name: str, top: Top) -> str:
    """Why nothing flows in a direction."""
    walls = {
        Top.PERIODIC: "the yarns close it",
        Top.PLATES: "plates close the cell below and above",
        Top.OPEN: "a plate closes the cell below and the surface is level",
    }
    reason = walls[top] if name == "z" else walls[Top.PERIODIC]
    return f"K is 0 along {name}: no path leads through the space between the yarns from cell to cell; {reason}"
