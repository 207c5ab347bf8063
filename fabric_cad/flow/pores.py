"""The pores of a cell's yarns: how much fibre, how thick, and the drag that makes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..composite.cell import CompositeCell
from ..composite.constituents import read_constituents
from ..composite.fibres import FibreSections, fibre_sections
from ..composite.materials import element_fractions
from ..measured.tables import Family
from ..model.solved import SolvedFabric
from ..support.errors import InputError, Problem
from . import gebart

FIBRE_DIAMETER = 7.0
"""Micrometres: of carbon; glass has 9 to 24."""

_DENSEST = 0.9
"""Fibre fraction above which nothing flows across fibres, near that at which they touch, 0.9069."""


@dataclass(frozen=True)
class Pores:
    """Fibres of ``diameter`` (mm) in the yarns; ``sections`` say how much of them."""

    diameter: float
    sections: FibreSections

    def resistance(self, cell: CompositeCell, fabric: SolvedFabric) -> np.ndarray:
        """The inverse of the permeability (elements, 3, 3), 1/mm2, of a cell's elements, 0 between the yarns.

        Raises :class:`InputError` where the fibre fraction is not known, or too high for anything
        to flow.
        """
        fractions = element_fractions(cell.mesh, fabric, self.sections)
        yarns = ~cell.in_matrix
        if np.isnan(fractions).any():
            message = "is not known, and porous yarns need it: from linear densities, or given in composite.toml"
            raise InputError(Problem(message, column="fibre_fraction", row=fabric.name))

        if (most := float(fractions.max())) > _DENSEST:
            message = (
                f"{most:.4g} is above {_DENSEST:g}: nothing flows between fibres that nearly touch"
            )
            raise InputError(Problem(message, column="fibre_fraction", row=fabric.name))

        tensors = np.zeros((len(fractions), 3, 3))
        tensors[yarns] = gebart.resistance(
            self.diameter / 2, fractions[yarns], cell.mesh.fibre_axes()[yarns]
        )
        return tensors


def pores_of(row: Family, families: str | Path, diameter: float) -> Pores:
    """The pores of a table of one row, whose fibres have a ``diameter`` in micrometres.

    Raises :class:`InputError` where that is none, or it is not known how much fibre there is.
    """
    if not (np.isfinite(diameter) and diameter > 0):
        raise InputError(
            Problem(
                f"{diameter:g} is not above 0 and finite (micrometres)", column="fibre-diameter"
            )
        )
    return Pores(diameter / 1000, fibre_sections(row, read_constituents(families, row.names[0])))
