"""Creeping flow through a periodic cell under unit pressure gradients, and the permeability it gives.

The permeability of a solution (u, p) of the saddle system S under the loads b is taken from

    K_mn V = b_m . x_n  +  b_n . x_m  -  x_m . S x_n,

in which an error of the solution enters squared.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import splu

from ..support.iterative import Operator
from .equations import Equations
from .lines import line_inverse
from .minres import solve

_PINNED = 1e-6  # of the least seepage: a pressure has no level
TOLERANCE = 1e-5
"""Residual over load at which a direction is solved; a permeability is then right to some 1e-8."""


@dataclass(frozen=True, eq=False)
class Flow:
    """Flow under unit pressure gradients along ``directions`` (directions, 3).

    ``velocity`` (nodes, 3, directions), mm2, and ``pressure`` (corners, directions), mm, in the
    numbers of the equations, per unit of gradient over viscosity; ``permeability`` (3, 3), mm2.
    ``work``, by how much dissipation and work differ, and ``divergence``, the root mean square of
    the volume made over that of velocity gradients: both the largest of a direction; ``iterations``
    and ``residual`` of the solution.
    """

    directions: np.ndarray
    velocity: np.ndarray
    pressure: np.ndarray
    permeability: np.ndarray
    work: float
    divergence: float
    iterations: int
    residual: float


def stokes_flow(
    equations: Equations, directions: np.ndarray, volume: float, tolerance: float = TOLERANCE
) -> Flow:
    """The flow along ``directions`` (directions, 3), orthonormal, in a cell of ``volume`` (mm3, solids included).

    Raises :class:`~fabric_cad.support.errors.SolverError` where the equations are not solved.
    """
    nodes, corners, count = len(equations.free), len(equations.masses), len(directions)
    if not count:
        nothing = np.zeros((nodes, 3, 0))
        return Flow(directions, nothing, np.zeros((corners, 0)), np.zeros((3, 3)), 0.0, 0.0, 0, 0.0)

    free = equations.free[:, :, None].astype(float)
    loads = (equations.weights[:, None, None] * directions.T * free).reshape(-1, count)
    whole = np.concatenate([loads, np.zeros((corners, count))])
    multiply = _saddle(equations, count)
    solution = solve(multiply, whole, _preconditioner(equations, count), tolerance)

    found = solution.values
    crossed = whole.T @ found
    energy = found.T @ multiply(found)
    permeability = directions.T @ ((crossed + crossed.T - energy) / volume) @ directions

    moving = found[: 3 * nodes]
    dissipated = np.einsum("nl,nl->l", moving, _friction(equations, moving))
    made = np.einsum("cl,c->l", (equations.divergence @ moving) ** 2, 1 / equations.masses)
    return Flow(
        directions=directions,
        velocity=moving.reshape(nodes, 3, count),
        pressure=found[3 * nodes :],
        permeability=(permeability + permeability.T) / 2,
        work=float(np.max(np.abs(dissipated / np.diag(crossed) - 1))),
        divergence=float(np.sqrt(np.max(made / dissipated))),
        iterations=solution.iterations,
        residual=solution.residual,
    )


def _saddle(equations: Equations, count: int) -> Operator:
    """The saddle system of velocities and pressures, for ``count`` loads."""
    nodes, free = len(equations.free), equations.free[:, :, None].astype(float)
    divergence, gradient = equations.divergence, equations.divergence.T.tocsr()

    def multiply(values: np.ndarray) -> np.ndarray:
        moving, pressure = values[: 3 * nodes], values[3 * nodes :]
        force = _friction(equations, moving) - gradient @ pressure
        held = force.reshape(nodes, 3, count) * free
        return np.concatenate([held.reshape(-1, count), -(divergence @ moving)])

    return multiply


def _preconditioner(equations: Equations, count: int) -> Operator:
    """Vertical lines of the Laplacian for velocities, masses and seepage for pressures."""
    nodes, free = len(equations.free), equations.free[:, :, None].astype(float)
    masses = equations.masses
    inverses, through_pores = _inverses(equations), _seepage_inverse(equations)

    def precondition(values: np.ndarray) -> np.ndarray:
        moved = values[: 3 * nodes].reshape(nodes, 3, count) * free
        for components, inverse in inverses:
            solved = inverse @ moved[:, components].reshape(nodes, -1)
            moved[:, components] = solved.reshape(nodes, -1, count)
        moved *= free

        given = values[3 * nodes :]
        pressure = given / masses[:, None] + through_pores(given)
        pressure -= masses @ pressure / masses.sum()  # its mean means nothing
        return np.concatenate([moved.reshape(-1, count), pressure])

    return precondition


def _friction(equations: Equations, moving: np.ndarray) -> np.ndarray:
    """Forces of viscosity and drag on velocities (3 nodes, directions)."""
    velocity = moving.reshape(len(equations.free), 3, -1)
    force = (equations.laplacian @ moving.reshape(len(velocity), -1)).reshape(velocity.shape)
    for (i, j), matrix in equations.drag.items():
        force[:, i] += matrix @ velocity[:, j]
        if i != j:
            force[:, j] += matrix @ velocity[:, i]
    return force.reshape(moving.shape)


def _seepage_inverse(equations: Equations) -> Operator:
    """The inverse of what pressure drives through pores: there it, and no longer the mass, is what the saddle sees.

    J. Cahouet and J.-P. Chabard, Int. J. Numer. Methods Fluids 8 (1988) 869-895.
    """
    if equations.seepage is None:
        return np.zeros_like

    scale = equations.seepage.diagonal().min() / equations.masses.max()
    whole = equations.seepage + _PINNED * scale * diags_array(equations.masses)
    return splu(whole.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve


def _inverses(equations: Equations) -> list[tuple[list[int], csr_array]]:
    """Velocity's components that are held at the same nodes, and the Laplacian of all others inverted on lines."""
    free = equations.free
    groups: list[list[int]] = []

    for component in range(3):
        alike = [group for group in groups if np.array_equal(free[:, group[0]], free[:, component])]
        same = [] if equations.drag else alike
        if same:
            same[0].append(component)
        else:
            groups.append([component])

    alone = equations.line.max() + 1 + np.arange(len(free))  # a held node stands on no line
    return [
        (
            group,
            line_inverse(
                _diagonal_block(equations, group[0]),
                np.where(free[:, group[0]], equations.line, alone),
            ),
        )
        for group in groups
    ]


def _diagonal_block(equations: Equations, component: int) -> csr_array:
    """What a velocity component's viscosity and drag do to itself."""
    drag = equations.drag.get((component, component))
    return equations.laplacian if drag is None else equations.laplacian + drag
