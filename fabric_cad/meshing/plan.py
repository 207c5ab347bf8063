"""What a yarn's mesh will be before there is any: layers along, nodes around, and which faces touch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..model.solved import SolvedFabric
from ..section.strips import Section
from ..weave.directions import DIRECTIONS, Direction
from ..weave.weaves import Yarn
from ..yarn.planes import contact_segment
from ..yarn.skin import Skin
from ..yarn.swept import SweptYarn
from .options import MeshOptions
from .section_mesh import StripNodes, section_mesh
from .templates import Template


@dataclass(frozen=True, eq=False)
class Plan:
    """The mesh of one yarn, planned.

    ``sections`` and ``places`` of its control planes along the cell (mm) and ``layers``, the shares
    from 0 to 1 at which nodes lie between two of them; ``strips`` maps each side of the skin to the
    places of its nodes in the section's outline and to their shares of the strip, in the strip's
    own order; ``contacts`` lists (segment, side) of the faces that touch; ``middles`` per segment
    the sides and their middles (v, z), mm; ``centre`` is the coordinate of the axis. ``moved``,
    (layers of nodes, inner, 2) in mm across and upwards, leads the inner nodes away from where the
    template puts them.
    """

    yarn: Yarn
    sections: tuple[Section, ...]
    places: np.ndarray
    layers: tuple[np.ndarray, ...]
    template: Template | None
    strips: Mapping[str, StripNodes]
    contacts: tuple[tuple[int, str], ...]
    middles: tuple[tuple[list[str], np.ndarray], ...]
    centre: float
    moved: np.ndarray | None = None

    @property
    def along_axis(self) -> int:
        """0 for a weft, which runs along x, 1 for a warp."""
        return self.yarn.direction.axis

    @property
    def rows(self) -> np.ndarray:
        """Number of the layer of nodes in which each control plane lies."""
        return np.concatenate([[0], np.cumsum([len(shares) - 1 for shares in self.layers])])


def plan_yarns(
    fabric: SolvedFabric,
    yarns: Sequence[Yarn],
    options: MeshOptions,
    gap: Mapping[Direction, np.ndarray] | None = None,
) -> list[Plan]:
    """Plan the meshes of yarns so that the contact nodes will coincide with those of the yarns they cross.

    ``gap`` gives for yarns of either direction the shares from 0, a crossing's end, to 1, mid-gap,
    at which nodes lie; evenly where it is None.
    """
    evenly = np.linspace(0.0, 1.0, options.gap // 2 + 1)
    gaps = dict.fromkeys(DIRECTIONS, (evenly, evenly))
    if gap is not None:
        gaps = {direction: (1.0 - shares[::-1], shares) for direction, shares in gap.items()}
    plans = [_plan_yarn(fabric, yarn, options, gaps[yarn.direction]) for yarn in yarns]

    return section_mesh(fabric.form).completed(plans, options)


def _plan_yarn(
    fabric: SolvedFabric, yarn: Yarn, options: MeshOptions, gaps: tuple[np.ndarray, np.ndarray]
) -> Plan:
    swept = SweptYarn(fabric, yarn)
    planes = swept.planes
    mesh, frame = section_mesh(fabric.form), fabric.frame(yarn.direction)
    crossed = "warp" if yarn.direction == "weft" else "weft"
    across = {"weft": options.across, "warp": options.crossing}

    layers: list[np.ndarray] = []
    for high in yarn.high:
        # along a crossing nodes lie as they do across the side of the crossed yarn that is touched
        side = "top" if high else "bottom"
        columns = mesh.columns(fabric.frame(crossed), side, across[crossed])
        layers += [gaps[0], *map(_shares, columns), gaps[1]]

    outline = mesh.outline(frame, across[yarn.direction], options.through)
    contacts = [
        (contact_segment(planes, k), "bottom" if high else "top")
        for k, high in enumerate(yarn.high)
    ]

    return Plan(
        yarn=yarn,
        sections=swept.sections,
        places=np.array([plane.place for plane in planes]),
        layers=tuple(layers),
        template=outline.template,
        strips=outline.strips,
        contacts=tuple(contacts),
        middles=_middles(swept.skin, len(layers)),
        centre=swept.trajectory.axis,
    )


def _shares(places: np.ndarray) -> np.ndarray:
    return (places - places[0]) / (places[-1] - places[0])


def _middles(surface: Skin, segments: int) -> tuple[tuple[list[str], np.ndarray], ...]:
    """Per segment, its sides and the points (v, z) at the middle of their parameters."""
    centre = np.array([0.5])
    found: list[tuple[list[str], list]] = [([], []) for _ in range(segments)]
    for patch in surface.patches:
        sides, middles = found[patch.segment]
        sides.append(patch.side)
        middles.append(patch.at(centre, centre)[0, 0, 1:])
    return tuple((sides, np.array(middles)) for sides, middles in found)
