"""How the stations of a gap are spaced where strips of resin lie beside the yarns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from ..meshing.options import MeshOptions, mesh_options
from ..model.solved import SolvedFabric
from ..section.strips import FIRST, LAST
from ..support.errors import InputError, Problem
from ..weave.directions import DIRECTIONS, Direction
from ..yarn.swept import swept_yarns

_SIDES = MappingProxyType({"flat": 1.5, "round": 3.0})
"""Width of a strip of resin at most, in heights of the side where that is lowest: wider ones are too pointed."""

_OF_HALF_GAP = 0.65
"""Share of half a gap that a strip beside arcs takes at most."""

_STEEP_SIDES, _LEAST_OF_HALF_GAP = 0.4, 0.15
"""Width of a strip beside a flat side in a narrow gap, in heights of the side, and its least share of half the gap.

There the other yarns climb steeply, and a strip that lies on them bends with them: the narrower it
is, the less.
"""


def composite_mesh_options(fabric: SolvedFabric, **asked: Any) -> MeshOptions:
    """Mesh options of a composite from what a user asked for, as :func:`fabric_cad.meshing.mesh_options` takes it.

    Beside flat and round sections a gap has room for the strips of resin, unless ``gap`` is given.
    Raises :class:`InputError` where strips do not fit.
    """
    options = mesh_options(fabric, **asked)
    if asked.get("gap") is None:
        options = replace(options, gap=max(options.gap, 2 * _resin_lines(fabric, options) + 2))
        options.check(fabric)
    gap_shares(fabric, options)
    return options


def _resin_lines(fabric: SolvedFabric, options: MeshOptions) -> int:
    """The lines of a gap that a strip of resin takes beyond a yarn's edge."""
    if fabric.section == "lenticular":
        return 0
    if options.through % 2:
        message = f"{options.through} is odd; the strips of resin beside flat sections take an even number of layers"
        raise InputError(Problem(message, column="through"))
    edges = options.through if fabric.section == "flat" else options.through - 2
    return edges // 2 + 1


def gap_shares(fabric: SolvedFabric, options: MeshOptions) -> Mapping[Direction, np.ndarray] | None:
    """For yarns of either direction, the shares from 0, a crossing's end, to 1, mid-gap, at which nodes lie.

    None where they lie evenly. Raises :class:`InputError` where a gap has no room for the strips of
    resin.
    """
    taken, half = _resin_lines(fabric, options), options.gap // 2
    if not taken:
        return None
    if half <= taken:
        message = f"{options.gap} is below {2 * taken + 2}: strips of resin lie beside {fabric.section} sections"
        raise InputError(Problem(message, column="gap"))

    shares = {}
    for direction in DIRECTIONS:
        width = (fabric.directions[direction].crossed_spacing - fabric.crossed(direction).width) / 2
        strip = _strip_share(fabric.section, lowest_side(fabric, direction.other) / width)
        inner, outer = np.linspace(0.0, strip, taken + 1), np.linspace(strip, 1.0, half - taken + 1)
        shares[direction] = np.concatenate([inner, outer[1:]])

    return MappingProxyType(shares)


def _strip_share(section: str, side: float) -> float:
    """Share of half a gap that a strip takes beside a side whose height is ``side`` halves of the gap."""
    most = _SIDES[section] * side
    if section == "flat":
        return min(most, max(_STEEP_SIDES * side, _LEAST_OF_HALF_GAP), _OF_HALF_GAP)
    return min(most, _OF_HALF_GAP)


def lowest_side(fabric: SolvedFabric, direction: Direction) -> float:
    """The least height (mm) of the sides of a direction's yarns, between the contact's and the free side."""
    if fabric.section == "flat":
        return fabric.lateral_height
    own = [swept for swept in swept_yarns(fabric) if swept.yarn.direction is direction]
    sections = [section for swept in own for section in swept.sections]
    return min(
        float(
            section.strips[f"{edge}_upper"].poles[inner, 1]
            - section.strips[f"{edge}_lower"].poles[inner, 1]
        )
        for section in sections
        for edge, inner in (("left", LAST), ("right", FIRST))
    )
