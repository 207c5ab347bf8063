"""What a yarn's mesh will be before there is any: layers along, nodes around, and which faces touch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..model.solved import SolvedFabric
from ..section.sections import Frame, Section
from ..weave.directions import DIRECTIONS
from ..weave.weaves import Yarn
from ..yarn.planes import contact_segment
from ..yarn.skin import Skin
from ..yarn.swept import SweptYarn
from .count import chord_ends, column_counts, lateral_count
from .options import MeshOptions
from .rings import Span, fill_rings
from .templates import Template, flat_template, lenticular_template


@dataclass(frozen=True, eq=False)
class Plan:
    """The mesh of one yarn, planned.

    ``sections`` and ``places`` of its control planes along the cell (mm) and ``layers``, the shares from 0 to 1
    at which nodes lie between two of them; ``strips`` maps each side of the skin to the places
    of its nodes in the section's outline and to their shares of the strip, in the strip's own
    order; ``contacts`` lists (segment, side) of the faces that touch; ``middles`` per segment
    the sides and their middles (v, z), mm; ``centre`` is the coordinate of the axis. ``moved``,
    (layers of nodes, inner, 2) in mm across and upwards, leads the inner nodes away from where the
    template puts them.
    """

    yarn: Yarn
    sections: tuple[Section, ...]
    places: np.ndarray
    layers: tuple[np.ndarray, ...]
    template: Template | None
    strips: dict[str, tuple[np.ndarray, np.ndarray]]
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


def plan_yarns(fabric: SolvedFabric, yarns: Sequence[Yarn], options: MeshOptions) -> list[Plan]:
    """Plan the meshes of yarns so that the contact nodes will coincide with those of the yarns they cross."""
    plans = [_plan_yarn(fabric, yarn, options) for yarn in yarns]
    if fabric.section != "round":
        return plans

    rings = {}
    for direction, across in zip(DIRECTIONS, (options.across, options.crossing)):
        alike = [plan for plan in plans if plan.yarn.direction == direction]
        spans = [list(map(Span, plan.sections, plan.sections[1:], plan.layers)) for plan in alike]
        if spans:
            template, moved = fill_rings(spans, alike[0].strips, across, options.through - 2)
            rings |= {plan.yarn: (template, shift) for plan, shift in zip(alike, moved)}
    return [replace(plan, template=rings[plan.yarn][0], moved=rings[plan.yarn][1]) for plan in plans]


def _plan_yarn(fabric: SolvedFabric, yarn: Yarn, options: MeshOptions) -> Plan:
    swept = SweptYarn(fabric, yarn)
    planes = swept.planes
    frame, crossed = fabric.frame(yarn.direction), "warp" if yarn.direction == "weft" else "weft"
    across = {"weft": options.across, "warp": options.crossing}
    gap = np.linspace(0.0, 1.0, options.gap // 2 + 1)
    layers = []
    for high in yarn.high:
        # along a crossing nodes lie as they do across the side of the crossed yarn that is touched
        columns = _columns(fabric.frame(crossed), "top" if high else "bottom", across[crossed])
        layers += [gap, *map(_shares, columns), gap]
    template, strips = _outline(frame, across[yarn.direction], options.through)
    contacts = [(contact_segment(planes, k), "bottom" if high else "top") for k, high in enumerate(yarn.high)]
    return Plan(
        yarn=yarn,
        sections=swept.sections,
        places=np.array([plane.place for plane in planes]),
        layers=tuple(layers),
        template=template,
        strips=strips,
        contacts=tuple(contacts),
        middles=_middles(swept.skin, len(layers)),
        centre=swept.trajectory.axis,
    )


def _shares(places: np.ndarray) -> np.ndarray:
    return (places - places[0]) / (places[-1] - places[0])


def _columns(frame: Frame, side: str, across: int) -> list[np.ndarray]:
    """Places v (mm) of the nodes across a side: left of its contact chord, on it, right of it.

    Top and bottom of a pointed or flat section have their nodes one above the other, at the
    ends of either contact chord among others (nearly so where the two chords are nearly equal).
    A round section has ``across`` elements on each chord, and its arcs follow.
    """
    edge, half = frame.width / 2, frame.splits[side][0]
    if frame.form == "round":
        outside = np.linspace(half, edge, lateral_count(frame, side, across) + 1)
        return [-outside[::-1], np.linspace(-half, half, across + 1), outside]
    typical, halves = chord_ends(frame, side, across)
    counts = column_counts(typical, across)
    middle = np.linspace(-halves[0], halves[0], counts[0] + 1)
    outer = [np.linspace(a, b, n // 2 + 1)[1:] for a, b, n in zip(halves, halves[1:], counts[1:])]
    right = np.concatenate([[halves[0]], *outer])
    places = np.concatenate([-right[:0:-1], middle, right[1:]])
    places = (places - places[::-1]) / 2  # symmetric to the last bit
    if not frame.has_laterals(side):
        return [places]
    first = int(np.abs(places + half).argmin())
    return [places[: first + 1], places[first : len(places) - first], places[len(places) - first - 1 :]]


def _outline(
    frame: Frame, across: int, through: int
) -> tuple[Template | None, dict[str, tuple[np.ndarray, np.ndarray]]]:
    """A section's template, and each strip's places in its outline with their shares of the strip.

    A round section's template is chosen later, for all yarns of a direction.
    """
    columns = {side: _columns(frame, side, across) for side in ("bottom", "top")}
    upright, template = 0, None
    if frame.form == "round":
        upright = through - 2  # the template adds a layer below and above
    else:
        places = np.unique(np.concatenate(columns["bottom"]))
        across = len(places) - 1
        if frame.form == "flat":
            upright, template = through, flat_template(across, through)
        else:
            k = through // 2
            template = lenticular_template(across, through, (places[k] - places[0]) / (places[2 * k] - places[0]))
    outline = 2 * (across + upright)
    around = np.arange(outline + 1) % outline
    bottom, right = around[: across + 1], around[across : across + upright + 1]
    top = around[across + upright : 2 * across + upright + 1][::-1]
    left = around[2 * across + upright :][::-1]
    if frame.form == "round":
        half = upright // 2
        slots = {"bottom": bottom, "top": top, "right_lower": right[: half + 1], "right_upper": right[half:][::-1]}
        slots |= {"left_lower": left[: half + 1][::-1], "left_upper": left[half:]}
        strips = {side: (nodes, np.linspace(0.0, 1.0, len(nodes))) for side, nodes in slots.items()}
        return None, strips
    strips = {}
    for side, level, nodes in (("bottom", "lower", bottom), ("top", "upper", top)):
        names = [f"left_{level}", side, f"right_{level}"] if len(columns[side]) == 3 else [side]
        first = 0
        for name, piece in zip(names, columns[side]):
            strips[name] = nodes[first : first + len(piece)], _shares(piece)
            first += len(piece) - 1
    if frame.form == "flat":
        strips |= {
            name: (nodes, np.linspace(0.0, 1.0, through + 1)) for name, nodes in (("left", left), ("right", right))
        }
    return template, strips


def _middles(surface: Skin, segments: int) -> tuple[tuple[list[str], np.ndarray], ...]:
    """Per segment, its sides and the points (v, z) at the middle of their parameters."""
    centre = np.array([0.5])
    found: list[tuple[list[str], list]] = [([], []) for _ in range(segments)]
    for patch in surface.patches:
        sides, middles = found[patch.segment]
        sides.append(patch.side)
        middles.append(patch.at(centre, centre)[0, 0, 1:])
    return tuple((sides, np.array(middles)) for sides, middles in found)
