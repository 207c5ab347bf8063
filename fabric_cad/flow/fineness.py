"""How fine a mesh for flow is, and the one half as fine against which it is checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil
from typing import Any

from ..composite.options import CompositeOptions, Margin
from ..composite.spacing import composite_mesh_options
from ..meshing.options import MeshOptions
from ..meshing.section_mesh import section_mesh
from ..model.solved import SolvedFabric
from .space import Top

USUAL = {"across": 6}
"""The mesh where nothing is said of it; elements are quadratic and follow the yarns' faces."""

LAYERS = 6
"""Layers of the space between the yarns and either face of the box where nothing is said of them."""

GRADINGS = {Top.PERIODIC: 32.0, Top.PLATES: 1.0, Top.OPEN: 1.0}
"""Height of the layer at the box over that at the yarns where nothing is said of it: flow through the layer turns
round the yarns' sharp edges, which asks for thin layers there; plates are walls like the yarns."""


@dataclass(frozen=True)
class Fineness:
    """Elements of the yarns, and the box with its layers."""

    yarns: MeshOptions
    box: CompositeOptions

    def halved(self, fabric: SolvedFabric) -> Fineness:
        """Half as fine in every direction, as far as the section can be filled so."""
        yarns, box = self.yarns, self.box
        least = section_mesh(fabric.form).least_across(yarns.through)
        asked: dict[str, int] = {
            "across": max(least, ceil(yarns.across / 2)),
            "crossing": max(least, ceil(yarns.crossing / 2)),
            "through": yarns.through,
        }
        if fabric.section == "lenticular":  # beside others a gap has what the strips of resin need
            asked["gap"] = max(2, 2 * ceil(yarns.gap / 4))

        layers = ceil(box.layers / 2)
        grading = box.grading ** (2 * (layers - 1) / (box.layers - 1)) if box.layers > 1 else 1.0
        coarse = replace(box, layers=layers, grading=min(max(grading, 1e-3), 1e3))
        return Fineness(composite_mesh_options(fabric, **asked), coarse)


def fineness(
    fabric: SolvedFabric,
    mesh: Mapping[str, Any],
    *,
    top: Top = Top.PERIODIC,
    margin: Margin | None = None,
    layers: int | None = None,
    grading: float | None = None,
) -> Fineness:
    """The fineness for a fabric from what is asked for.

    ``mesh`` are keywords of :func:`~fabric_cad.composite.spacing.composite_mesh_options`. Raises
    :class:`InputError`.
    """
    used = composite_mesh_options(fabric, **(mesh if "size" in mesh else USUAL | dict(mesh)))
    box = CompositeOptions(
        margin=margin or Margin(),
        layers=LAYERS if layers is None else layers,
        grading=GRADINGS[top] if grading is None else grading,
    )

    return Fineness(used, box)
