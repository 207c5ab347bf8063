"""Volumes of yarns without CAD: integrals of the section's area along the yarn, whole tables at once.

The skin of :mod:`~fabric_cad.yarn.skin` moves a section along the yarn in vertical planes and
blends two sections strip by strip. The strips of pointed and flat sections end at the same places
in every section of a yarn, so that an area blends as the heights do, and the cubic smoothstep has
the mean 1/2: between two control planes the volume is their distance times the mean of both areas,
exactly.

``float_gap`` changes no volume of such sections: the symmetric section (two parabolas, each (b -
h)/2 deep) and that of a flat contact (one parabola, b - h deep) both have the area c b - c (b -
h)/3.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, singledispatch
from typing import Any

import numpy as np

from ..model.solved import PLATEAUX
from ..section.edged import Edged
from ..section.forms import Form, rows_by_form
from ..section.frame import KINDS
from ..weave.directions import DIRECTIONS, Direction
from ..weave.weaves import Weave, yarns_of


@lru_cache(maxsize=1024)
def crossing_counts(weave: Weave) -> Mapping[tuple[Direction, str, str], int]:
    """How many crossings of the cell have each (direction, plateau, kind of contact section)."""
    return Counter(
        (yarn.direction, "high" if high else "low", KINDS[left + right])
        for yarn in yarns_of(weave.interlacement())
        for high, left, right in zip(yarn.high, yarn.turns_left, yarn.turns_right)
    )


@dataclass(frozen=True, eq=False)
class Areas:
    """Areas of one direction's sections, shape (rows,), mm2: ``between`` crossings and by (plateau, kind)."""

    contact: Mapping[tuple[str, str], np.ndarray]
    between: np.ndarray


@singledispatch
def section_areas(
    form: Form, columns: Mapping[str, np.ndarray], direction: Direction
) -> Areas | None:
    """Areas of the sections of a form, from the columns of a solved table whose rows have it.

    None where volumes do not follow from areas: strips of arcs end at other places in other
    sections.
    """
    return None


@section_areas.register
def _(form: Edged, columns: Mapping[str, np.ndarray], direction: Direction) -> Areas:
    half = columns[f"{direction}_width_mm"] / 2
    envelope = 2 * half * columns[f"{direction}_thickness_mm"]
    contact = {
        (plateau, kind): envelope
        - _above_free_side(columns, direction, plateau, kind)
        - KINDS.index(kind) * _below_contact(columns, direction, plateau)
        for plateau in PLATEAUX
        for kind in KINDS
    }
    return Areas(contact, envelope - columns[f"{direction}_between_q"] * 4 / 3 * half**3)


def _above_free_side(
    columns: Mapping[str, np.ndarray], direction: Direction, plateau: str, kind: str
) -> np.ndarray:
    """Area between a free parabola q (v - v0)^2 and the envelope, mm2."""
    half = columns[f"{direction}_width_mm"] / 2
    q, v0 = (columns[f"{direction}_{plateau}_{kind}_{name}"] for name in ("q", "v0_mm"))
    return q * ((half - v0) ** 3 + (half + v0) ** 3) / 3


def _below_contact(
    columns: Mapping[str, np.ndarray], direction: Direction, plateau: str
) -> np.ndarray:
    """Area between the envelope and a contact profile p (v - d_c)^2 on one side of the axis, mm2."""
    # the crossed yarn lies at its other plateau, where its parabola is p
    p = np.abs(columns[_PARABOLA[direction.other, "high" if plateau == "low" else "low"]])
    half = columns[f"{direction}_width_mm"] / 2
    return p * (half - columns[f"{direction}_{plateau}_offset_mm"]) ** 3 / 3


_PARABOLA = {
    (Direction.WEFT, "low"): "p11",
    (Direction.WEFT, "high"): "p12",
    (Direction.WARP, "high"): "p21",
    (Direction.WARP, "low"): "p22",
}
"""Column of a direction's parabola at its plateaux."""


def yarn_volumes(columns: Mapping[str, Any], weaves: Sequence[Weave]) -> dict[str, np.ndarray]:
    """Volume (rows,) of all wefts and of all warps of the cell, mm3, from the columns of a solved table.

    NaN in rows with round sections, whose arcs do not blend by areas.
    """
    volumes: dict[str, np.ndarray] = {
        direction: np.full(len(weaves), np.nan) for direction in DIRECTIONS
    }
    numbers = {name: values for name, values in columns.items() if isinstance(values, np.ndarray)}

    for form, rows in rows_by_form(columns["section"]):
        of_form = {name: values[rows] for name, values in numbers.items()}
        weaves_of_form = [weaves[row] for row in rows.tolist()]
        for direction in DIRECTIONS:
            if areas := section_areas(form, of_form, direction):
                volumes[direction][rows] = _volume(of_form, weaves_of_form, areas, direction)

    return volumes


def _volume(
    columns: Mapping[str, np.ndarray], weaves: Sequence[Weave], areas: Areas, direction: Direction
) -> np.ndarray:
    """Volume (rows,) of one direction's yarns, mm3: areas times lengths along the yarns."""
    distinct = {id(weave): weave for weave in weaves}
    order = {key: number for number, key in enumerate(distinct)}
    number = np.array([order[id(weave)] for weave in weaves], dtype=int)

    over = columns[f"{direction.other}_width_mm"]
    gap = columns[f"{direction}_crossed_spacing_mm"] - over
    total = np.zeros(len(weaves))
    for (plateau, kind), area in areas.contact.items():
        counts = [crossing_counts(weave)[direction, plateau, kind] for weave in distinct.values()]
        total += np.array(counts)[number] * (area * over + (area + areas.between) / 2 * gap)
    return total
