"""What every element of a composite cell is made of."""

from __future__ import annotations

import numpy as np

from ..meshing.mesh import Mesh
from ..model.solved import SolvedFabric
from ..support.errors import InputError, Problem
from ..weave.bodies import BodyKind
from ..yarn.swept import swept_yarns
from .fibres import FibreSections, fibre_fractions
from .homogenisation.homogenise import Materials
from .micromechanics import YarnProperties, yarn_properties
from .substances import Constituents
from .transverse import expansion_strain, second_order


def element_fractions(mesh: Mesh, fabric: SolvedFabric, sections: FibreSections) -> np.ndarray:
    """Fibre volume fraction (elements,) at the centres of a mesh's elements: 0 off the yarns, NaN where not known.

    Raises :class:`InputError` where a yarn would hold more fibre than can be packed.
    """
    fractions = np.zeros(len(mesh.hexahedra))
    for swept in swept_yarns(fabric):
        elements = mesh.elements_of(swept.yarn.body)
        centres = mesh.points[mesh.hexahedra[elements]].mean(axis=1)
        along = fabric.lattice.to_woven(centres)[:, swept.yarn.direction.axis]
        known = fibre_fractions(swept, sections, along)
        fractions[elements] = np.nan if known is None else known

    return fractions


def element_materials(mesh: Mesh, fractions: np.ndarray, constituents: Constituents) -> Materials:
    """Materials of a mesh's elements, with fibres along its yarns at ``fractions`` (elements,).

    Raises :class:`InputError` where a yarn's properties are those of no stable material.
    """
    yarn = np.array([body.kind is BodyKind.YARN for body in mesh.bodies])[mesh.body]
    matrix, axes = constituents.matrix, mesh.fibre_axes()
    known = None if np.isnan(fractions[yarn]).any() else fractions[yarn]
    properties = yarn_properties(constituents, known)
    _refuse_unstable(properties, constituents)

    stiffness = np.empty((len(yarn), 6, 6))
    stiffness[yarn] = properties.law.stiffness(axes[yarn])
    stiffness[~yarn] = matrix.law.stiffness(np.eye(3)[:1])

    expansion = conductivity = density = None
    if properties.expansion and matrix.expansion_per_K is not None:
        expansion = np.empty((len(yarn), 6))
        expansion[yarn] = expansion_strain(*properties.expansion, axes[yarn])
        expansion[~yarn] = expansion_strain(
            matrix.expansion_per_K, matrix.expansion_per_K, np.eye(3)[:1]
        )

    if properties.conductivity and matrix.conductivity_W_per_mK is not None:
        conductivity = np.empty((len(yarn), 3, 3))
        conductivity[yarn] = second_order(*properties.conductivity, axes[yarn])
        conductivity[~yarn] = matrix.conductivity_W_per_mK * np.eye(3)

    if properties.density is not None and matrix.density_g_cm3 is not None:
        density = np.full(len(yarn), matrix.density_g_cm3)
        density[yarn] = properties.density

    return Materials(stiffness, expansion, conductivity, density)


def _refuse_unstable(properties: YarnProperties, constituents: Constituents) -> None:
    law = properties.law
    nu23, margin = np.atleast_1d(law.nu23), np.atleast_1d(law.margin)
    if (np.abs(nu23) < 1).all() and (margin > 0).all():
        return

    worst = float(nu23[np.argmax(np.abs(nu23))])
    message = (
        f"fibre and matrix give a yarn that is not positive definite: 1 - nu23 - 2 nu12**2 E2 / E1 is "
        f"{margin.min():.3g}, nu23 is {worst:.3g}"
    )
    raise InputError(Problem(message, constituents.path, None, "fibre"))
