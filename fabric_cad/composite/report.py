"""The report of a composite cell: what its files hold, measured on them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..meshing.hexahedron import hexahedra_volumes
from ..meshing.mesh import Mesh
from ..meshing.quality import hexahedra_quality
from ..model.plausibility import LEAST_JACOBIAN, LOW_JACOBIAN
from ..model.solved import SolvedFabric
from ..support.errors import BuildError
from .cell import MATRIX, CompositeCell
from .options import CompositeOptions

_VOLUME = 1e-12
"""Relative error of the sum of all volumes up to which a mesh counts as filling its box."""


@dataclass(frozen=True, eq=False)
class Figures:
    """Figures (elements,) of a composite's hexahedra: volume in mm3, scaled Jacobian, fibre volume fraction.

    The fraction is 0 in the matrix, NaN where it is not known.
    """

    volumes: np.ndarray
    scaled_jacobian: np.ndarray
    fibre_fraction: np.ndarray


def figures_of(mesh: Mesh, fibre_fraction: np.ndarray) -> Figures:
    """The figures of a composite's mesh."""
    volumes = hexahedra_volumes(mesh.points[mesh.hexahedra])
    quality = hexahedra_quality(mesh.points, mesh.hexahedra)
    return Figures(volumes, quality.scaled_jacobian, fibre_fraction)


def composite_report(
    fabric: SolvedFabric,
    options: CompositeOptions,
    cell: CompositeCell,
    written: Mesh,
    figures: Figures,
) -> dict:
    """The content of ``composite.json``, lengths mm; ``written`` is the mesh as read from its file.

    Raises :class:`BuildError` where the mesh does not fill the box, or no solver would take it.
    """
    box = float(cell.size.prod())
    volumes, in_matrix = figures.volumes, written.body == written.bodies.index(MATRIX)
    error = float(volumes.sum() / box - 1)
    _check(fabric.name, error, figures)

    fibre = float((figures.fibre_fraction * volumes).sum() / box)
    jacobian = figures.scaled_jacobian
    return {
        "row": fabric.name,
        "family": fabric.family,
        "section": fabric.section,
        "box_mm": cell.size.tolist(),
        "margin_mm": cell.margin,
        "raised_mm": cell.shift,
        "layers": options.layers,
        "grading": options.grading,
        "contact": options.contact,
        "nodes": len(written.points),
        "hexahedra": len(written.hexahedra),
        "matrix_hexahedra": int(np.count_nonzero(in_matrix)),
        "other_elements": written.other_elements,
        "volume_error": error,
        "min_scaled_jacobian": {
            "matrix": float(jacobian[in_matrix].min()),
            "yarns": float(jacobian[~in_matrix].min()),
        },
        "median_scaled_jacobian": {
            "matrix": float(np.median(jacobian[in_matrix])),
            "yarns": float(np.median(jacobian[~in_matrix])),
        },
        "closed_wedge_mm": cell.closed_wedge,
        "yarn_volume_fraction": float(volumes[~in_matrix].sum() / box),
        "fibre_volume_fraction": None if np.isnan(fibre) else fibre,
    }


def _check(row: str, error: float, figures: Figures) -> None:
    """Raise where volumes are more than rounding off the box, or elements are as good as folded."""
    least, bad = (
        figures.scaled_jacobian.min(),
        np.count_nonzero(figures.scaled_jacobian <= LEAST_JACOBIAN),
    )
    if abs(error) > _VOLUME or not figures.volumes.min() > 0:
        raise BuildError(
            f"{row}: the hexahedra do not fill the box: their volumes are {error:.3g} of it off, "
            f"the least is {figures.volumes.min():.3g} mm3"
        )

    if bad:
        raise BuildError(
            f"{row}: {bad} hexahedra of the composite cell have a scaled Jacobian not above {LEAST_JACOBIAN:g}, "
            f"{least:.3g} at least, which no solver takes: the gaps are too narrow, or the yarns too steep, for "
            "strips of resin beside flat and round sections"
        )


def doubts(report: Mapping) -> list[str]:
    """Sentences on elements of low quality that a ``composite.json`` tells of."""
    return [
        f"the smallest scaled Jacobian of the {part} is {least:.2g}, below {LOW_JACOBIAN:g}: a solver may lose "
        f"accuracy there (row {report['row']})"
        for part, least in report["min_scaled_jacobian"].items()
        if least < LOW_JACOBIAN
    ]


def solids_report(volumes: Mapping[str, float], cell: CompositeCell) -> dict:
    """What the report tells of the solids, from their volumes by name, mm3."""
    box = float(cell.size.prod())
    return {
        "solids": {
            "matrix_mm3": volumes[MATRIX.name],
            "yarns_mm3": sum(volume for name, volume in volumes.items() if name != MATRIX.name),
            "volume_error": sum(volumes.values()) / box - 1,
        }
    }


def summary(report: dict) -> str:
    """The report as a few lines for a person."""
    x, y, z = report["box_mm"]
    least, fibre = report["min_scaled_jacobian"], report["fibre_volume_fraction"]
    lines = [
        f"{report['row']}: composite cell {x:.5g} x {y:.5g} x {z:.4g} mm, margin {report['margin_mm']:.4g} mm, "
        f"contact {report['contact']}",
        f"  hexahedra             {report['hexahedra']}, of which {report['matrix_hexahedra']} of the matrix",
        f"  scaled Jacobian       matrix {least['matrix']:.3f}, yarns {least['yarns']:.3f} at least",
        f"  volumes - box         {report['volume_error']:.1e} of it",
        f"  wedges closed         {report['closed_wedge_mm']:.3g} mm at most",
        f"  yarn volume fraction  {report['yarn_volume_fraction']:.4f}",
    ]
    if fibre is not None:
        lines.append(f"  fibre volume fraction {fibre:.4f}")
    lines.append(f"  seconds               {sum(report['seconds'].values()):.1f}")

    return "\n".join(lines)
