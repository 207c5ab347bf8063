"""What is known of a cell's volumes and of its mesh, as frozen values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..measured.tables import Family
from ..model.solved import SolvedFabric
from ..weave.bodies import Body
from ..weave.directions import DIRECTIONS, Direction
from .pairing import contact_pairing, end_pairing

if TYPE_CHECKING:
    from ..cad import Consistency
    from .pipeline import Meshed

YARN_DATA = ("weft_linear_density_tex", "warp_linear_density_tex", "fibre_density_g_cm3")
"""Columns that say how much fibre a yarn holds."""


def yarn_data(table: Family, row: int) -> dict[str, float | None]:
    """Linear densities and fibre density of a row, None where not given.

    A balanced row's warp has its weft's.
    """
    values = {name: float(table.measured[name][row]) for name in YARN_DATA}
    if table.balanced[row]:
        values["warp_linear_density_tex"] = values["weft_linear_density_tex"]
    return {name: None if np.isnan(value) else value for name, value in values.items()}


@dataclass(frozen=True)
class Volumes:
    """Volumes of a cell, mm3, and what its fibres weigh and fill.

    None where the row does not say.
    """

    yarn_mm3: float
    cell_mm3: float
    areal_density_g_m2: float | None = None
    weft_fibre_fraction: float | None = None
    warp_fibre_fraction: float | None = None

    @property
    def yarn_volume_fraction(self) -> float:
        """Share of the cell that yarns take."""
        return self.yarn_mm3 / self.cell_mm3

    @property
    def fibre_fractions(self) -> dict[Direction, float]:
        """Share of the yarns' volume that fibres take, where it is known."""
        shares = zip(DIRECTIONS, (self.weft_fibre_fraction, self.warp_fibre_fraction))
        return {direction: share for direction, share in shares if share is not None}

    def content(self) -> dict[str, float]:
        """What the report holds: the figures that are known."""
        known = {
            "yarn_mm3": self.yarn_mm3,
            "cell_mm3": self.cell_mm3,
            "yarn_volume_fraction": self.yarn_volume_fraction,
        }
        if self.areal_density_g_m2 is not None:
            known["areal_density_g_m2"] = self.areal_density_g_m2
        return known | {f"{d}_fibre_fraction": share for d, share in self.fibre_fractions.items()}


def cell_volumes(
    fabric: SolvedFabric, consistency: Consistency, data: Mapping[str, float | None]
) -> Volumes:
    """The volumes of a cell's solids, with ``data`` of :func:`yarn_data`."""
    x, y = fabric.period
    given = {d: data.get(f"{d}_linear_density_tex") for d in DIRECTIONS}
    tex = {d: linear for d, linear in given.items() if linear}
    fibre = data.get("fibre_density_g_cm3")

    areal = None
    if len(tex) == len(DIRECTIONS):  # tex is g/km; yarns per mm times g/km is g/m2
        areal = sum(
            tex[d] * (1 + fabric.directions[d].crimp) / fabric.crossed(d).crossed_spacing
            for d in DIRECTIONS
        )

    shares: dict[Direction, float | None] = dict.fromkeys(DIRECTIONS)
    counts, extents = (fabric.weave.wefts, fabric.weave.warps), (x, y)
    for d, count, extent in zip(DIRECTIONS, counts, extents):
        if d in tex and fibre:
            section = tex[d] / fibre * 1e-3  # mm2 of solid fibre
            length = count * extent * (1 + fabric.directions[d].crimp)
            alike = (
                v for name, v in consistency.yarn_volumes.items() if Body.named(name).direction is d
            )
            shares[d] = section * length / sum(alike)

    return Volumes(
        yarn_mm3=sum(consistency.yarn_volumes.values()),
        cell_mm3=x * y * consistency.thickness,
        areal_density_g_m2=areal,
        weft_fibre_fraction=shares[Direction.WEFT],
        warp_fibre_fraction=shares[Direction.WARP],
    )


@dataclass(frozen=True)
class MeshFigures:
    """What was measured on a cell's mesh file; its fields are the keys of the report."""

    nodes: int
    hexahedra: int
    other_elements: int
    min_scaled_jacobian: float
    median_scaled_jacobian: float
    scaled_jacobian_edges_allow: float
    min_opposite_edge_ratio: float
    min_corner_angle_deg: float
    max_corner_angle_deg: float
    max_aspect: float
    contact_nodes: int
    coincident_contact_nodes: int
    end_nodes: int
    matching_end_nodes: int

    def content(self) -> dict[str, float]:
        """What the report holds."""
        return asdict(self)


def mesh_figures(fabric: SolvedFabric, meshed: Meshed) -> MeshFigures:
    """Count and measure a mesh as it was read from its file."""
    mesh, quality = meshed.mesh, meshed.quality
    contact, ends = contact_pairing(mesh), end_pairing(mesh, fabric.lattice)
    return MeshFigures(
        nodes=len(mesh.points),
        hexahedra=len(mesh.hexahedra),
        other_elements=mesh.other_elements,
        min_scaled_jacobian=float(quality.scaled_jacobian.min()),
        median_scaled_jacobian=float(np.median(quality.scaled_jacobian)),
        scaled_jacobian_edges_allow=meshed.allowed,
        min_opposite_edge_ratio=float(quality.opposite_edge_ratio.min()),
        min_corner_angle_deg=float(quality.least_angle.min()),
        max_corner_angle_deg=float(quality.greatest_angle.max()),
        max_aspect=float(quality.aspect.max()),
        contact_nodes=contact.nodes,
        coincident_contact_nodes=contact.paired,
        end_nodes=ends.nodes,
        matching_end_nodes=ends.paired,
    )
