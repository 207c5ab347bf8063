"""What a yarn's mesh will be before there is any: layers along, nodes around, and which faces touch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..sections import Frame
from ..solved import SolvedFabric
from ..sweeps import Skin, contact_segment, control_planes, control_sections, skin, trajectory
from ..weaves import Yarn
from .options import MeshOptions
from .templates import Template, flat_template, lenticular_template, round_template


@dataclass(frozen=True, eq=False)
class Plan:
    """The mesh of one yarn, planned.

    ``places`` of its control planes along the cell (mm) and ``counts`` of elements between
    them; ``strips`` maps each side of the skin to the places of its nodes in the section's
    outline, in the strip's own order; ``contacts`` lists (segment, side) of the faces that
    touch; ``middles`` per segment the sides and their middles (v, z), mm; ``centre`` is the
    coordinate of the axis.
    """

    yarn: Yarn
    places: np.ndarray
    counts: tuple[int, ...]
    template: Template
    strips: dict[str, np.ndarray]
    contacts: tuple[tuple[int, str], ...]
    middles: tuple[tuple[list[str], np.ndarray], ...]
    centre: float

    @property
    def along_axis(self) -> int:
        """0 for a weft, which runs along x, 1 for a warp."""
        return 0 if self.yarn.direction == "weft" else 1

    @property
    def rows(self) -> np.ndarray:
        """Number of the layer of nodes in which each control plane lies."""
        return np.concatenate([[0], np.cumsum(self.counts)])


def plan_yarn(fabric: SolvedFabric, yarn: Yarn, options: MeshOptions) -> Plan:
    """Plan the mesh of one yarn so that its contact nodes will coincide with those of the yarns it crosses."""
    planes = control_planes(fabric, yarn)
    path = trajectory(fabric, yarn, planes)
    surface = skin(path, control_sections(fabric, yarn, planes))
    frame, crossed = fabric.frame(yarn.direction), "warp" if yarn.direction == "weft" else "weft"
    across = {"weft": options.across, "warp": options.crossing}
    counts = []
    for high in yarn.high:
        # along a crossing lie as many elements as across the side of the crossed yarn that is touched
        side = "top" if high else "bottom"
        parts = _partition(fabric.frame(crossed), side, across[crossed])
        counts += [options.gap // 2, *(part for part in parts if part), options.gap // 2]
    template, strips = _outline(frame, across[yarn.direction], options.through)
    contacts = [(contact_segment(planes, k), "bottom" if high else "top") for k, high in enumerate(yarn.high)]
    return Plan(
        yarn=yarn,
        places=np.array([plane.place for plane in planes]),
        counts=tuple(counts),
        template=template,
        strips=strips,
        contacts=tuple(contacts),
        middles=_middles(surface, len(counts)),
        centre=path.axis,
    )


def _partition(frame: Frame, side: str, across: int) -> tuple[int, int, int]:
    """Elements across a side of a yarn: left of its contact chord, on it, right of it."""
    if not frame.has_laterals(side):
        return 0, across, 0
    outside = 1 - 2 * frame.splits[side][0] / frame.width
    lateral = max(1, round(across * outside / 2))
    return lateral, across if frame.form == "round" else across - 2 * lateral, lateral


def _outline(frame: Frame, across: int, through: int) -> tuple[Template, dict[str, np.ndarray]]:
    """A section's template and each strip's places in its outline."""
    if frame.form == "round":
        upright = through - 2  # the template adds a layer below and above
        template = round_template(across, upright)
    elif frame.form == "flat":
        upright, template = through, flat_template(across, through)
    else:
        upright, template = 0, lenticular_template(across, through)
    around = np.arange(template.outline + 1) % template.outline
    bottom, right = around[: across + 1], around[across : across + upright + 1]
    top = around[across + upright : 2 * across + upright + 1][::-1]
    left = around[2 * across + upright :][::-1]
    if frame.form == "round":
        half = upright // 2
        strips = {"bottom": bottom, "top": top, "right_lower": right[: half + 1], "right_upper": right[half:][::-1]}
        return template, strips | {"left_lower": left[: half + 1][::-1], "left_upper": left[half:]}
    strips = {} if frame.form == "lenticular" else {"left": left, "right": right}
    for side, level, nodes in (("bottom", "lower", bottom), ("top", "upper", top)):
        lateral, _, _ = _partition(frame, side, across)
        if lateral:
            strips[f"left_{level}"], strips[f"right_{level}"] = nodes[: lateral + 1], nodes[-lateral - 1 :]
        strips[side] = nodes[lateral : len(nodes) - lateral]
    return template, strips


def _middles(surface: Skin, segments: int) -> tuple[tuple[list[str], np.ndarray], ...]:
    """Per segment, its sides and the points (v, z) at the middle of their parameters."""
    from scipy.interpolate import BSpline

    found: list[tuple[list[str], list]] = [([], []) for _ in range(segments)]
    for patch in surface.patches:
        homogeneous = patch.poles * np.where(np.arange(4) < 3, patch.poles[..., 3:], 1.0)
        (ku, du), (kv, dv) = patch.along, patch.across
        point = BSpline(kv, BSpline(ku, homogeneous, du)((ku[0] + ku[-1]) / 2), dv)((kv[0] + kv[-1]) / 2)
        sides, middles = found[patch.segment]
        sides.append(patch.side)
        middles.append(point[1:3] / point[3])
    return tuple((sides, np.array(middles)) for sides, middles in found)
