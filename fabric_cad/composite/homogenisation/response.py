"""How a periodic cell answers prescribed mean fields: the fluctuations that keep it in equilibrium.

The strain of a load is P0 + z P1, z the height above the middle of the cell, plus that of a
periodic displacement u (free on faces that do not repeat). With F the nodal forces of C (P0 + z P1)
and K the cell's matrix, K u = -F, and what two loads do on each other is

    W = integral of P^T C P  +  F^T u + u^T F + u^T K u,

the energy of the total fields: an error of u enters it squared.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...support.iterative import Operator
from ..transverse import FIRST, SECOND
from .assembly import VOIGT, Integrals, assemble, elastic_coefficients, forces
from .conjugate_gradients import solve
from .elements import Elements
from .preconditioners import block_jacobi, product, vertical_lines


@dataclass(frozen=True, eq=False)
class Response:
    """A cell under several loads.

    ``work`` (loads, loads), N mm where strains are plain numbers; ``fluctuations`` (unknowns,
    components, loads), mm; ``integrals`` of the elements; ``residual`` and ``iterations`` of the
    solution; ``asymmetry``, by how much F_m^T u_n and F_n^T u_m differ, over the largest of
    ``work``.
    """

    work: np.ndarray
    fluctuations: np.ndarray
    integrals: Integrals
    residual: float
    iterations: int
    asymmetry: float


def elastic_response(elements: Elements, stiffness: np.ndarray, strains: np.ndarray) -> Response:
    """Answer of a cell of ``stiffness`` (elements, 6, 6) to ``strains`` (2, 6, loads): P0 and P1 of every load.

    Raises :class:`~fabric_cad.support.errors.SolverError` where the equations are not solved.
    """
    uniform, rate = strains
    matrix, integrals = assemble(elements, elastic_coefficients(stiffness))
    stresses = stiffness @ uniform
    total = forces(integrals.gradients, stresses, integrals.corners, elements.count)
    scale = _force_scale(integrals, stresses)
    work = uniform.T @ np.tensordot(integrals.volumes[0], stresses, 1)
    if rate.any():
        rates = stiffness @ rate
        total += forces(integrals.moments, rates, integrals.corners, elements.count)
        mixed = uniform.T @ np.tensordot(integrals.volumes[1], rates, 1)
        work += mixed + mixed.T + rate.T @ np.tensordot(integrals.volumes[2], rates, 1)
        scale = max(scale, _force_scale(integrals, rates) * elements.mesh.vectors[2, 2])

    return _solved(matrix, total, scale, work, integrals, vertical_lines(matrix, elements.places))


def conduction_response(elements: Elements, conductivity: np.ndarray) -> Response:
    """Answer of a cell of ``conductivity`` (elements, 3, 3) to unit gradients along x, y and z.

    Fluctuations are temperatures; else as :func:`elastic_response`.
    """
    matrix, integrals = assemble(elements, conductivity[:, None, None])
    local = np.einsum("naj,njm->nam", integrals.gradients, conductivity)
    corners = integrals.corners.ravel()
    total = np.stack(
        [np.bincount(corners, local[..., m].ravel(), minlength=elements.count) for m in range(3)],
        axis=-1,
    )
    work = np.tensordot(integrals.volumes[0], conductivity, 1)

    return _solved(
        matrix, total[:, None], float(np.linalg.norm(local)), work, integrals, block_jacobi(matrix)
    )


def mean_strains(response: Response, strains: np.ndarray, load: int) -> np.ndarray:
    """Mean of the total strain (elements, 6) in every element under one of the loads ``strains`` (2, 6, loads)."""
    integrals = response.integrals
    moved = response.fluctuations[integrals.corners, :, load]
    gradient = (
        np.einsum("naj,nai->nij", integrals.gradients, moved) / integrals.volumes[0][:, None, None]
    )
    fluctuation = gradient[:, FIRST, SECOND] + np.where(
        np.arange(6) < 3, 0.0, gradient[:, SECOND, FIRST]
    )
    heights = integrals.volumes[1] / integrals.volumes[0]
    return fluctuation + strains[0, :, load] + heights[:, None] * strains[1, :, load]


def work_of_stress(response: Response, stress: np.ndarray, strains: np.ndarray) -> np.ndarray:
    """Integral (loads,) of a ``stress`` (elements, 6) times the total strain of each of ``strains`` (2, 6, loads)."""
    integrals = response.integrals
    own = forces(
        integrals.gradients, stress[..., None], integrals.corners, len(response.fluctuations)
    )[..., 0]
    means = [weight @ stress for weight in integrals.volumes[:2]]
    return (
        means[0] @ strains[0]
        + means[1] @ strains[1]
        + np.einsum("ni,nim->m", own, response.fluctuations)
    )


def _solved(
    matrix,
    total: np.ndarray,
    scale: float,
    work: np.ndarray,
    integrals: Integrals,
    precondition: Operator,
) -> Response:
    """The response to nodal forces ``total`` (unknowns, components, loads)."""
    loads = total.reshape(-1, total.shape[-1])
    multiply = product(matrix, loads.shape[1])
    solution = solve(multiply, -loads, scale, precondition)
    moved = solution.values
    crossed = loads.T @ moved
    work = work + crossed + crossed.T + moved.T @ multiply(moved)

    moved = moved.reshape(total.shape)
    moved = moved - moved.mean(axis=0)
    asymmetry = float(np.abs(crossed - crossed.T).max() / np.abs(work).max())
    return Response(work, moved, integrals, solution.residual, solution.iterations, asymmetry)


def _force_scale(integrals: Integrals, stresses: np.ndarray) -> float:
    """Norm of the elements' own forces, before they cancel at the nodes."""
    squares = (
        np.linalg.norm(np.einsum("naj,njm->nam", integrals.gradients, stresses[:, VOIGT[i]]))
        for i in range(3)
    )
    return float(np.sqrt(sum(square**2 for square in squares)))
