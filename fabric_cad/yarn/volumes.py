"""Volumes of yarns without CAD: integrals of the section's area along the yarn, whole tables at once.

The skin of :mod:`~fabric_cad.yarn.skin` moves a section along the yarn in vertical planes and blends
two sections strip by strip. The strips of pointed and flat sections end at the same places in every
section of a yarn, so that an area blends as the heights do, and the cubic smoothstep has the mean
1/2: between two control planes the volume is their distance times the mean of both areas, exactly.

``float_gap`` changes no volume of such sections: the symmetric section (two parabolas, each (b - h)/2 deep)
and that of a flat contact (one parabola, b - h deep) both have the area c b - c (b - h)/3.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from ..model.solved import PLATEAUX
from ..section.sections import KINDS
from ..weave.directions import DIRECTIONS
from ..weave.weaves import Weave, yarns_of


@lru_cache(maxsize=1024)
def crossing_counts(weave: Weave) -> Mapping[tuple[str, str, str], int]:
    """How many crossings of the cell have each (direction, plateau, kind of contact section)."""
    return Counter(
        (yarn.direction, "high" if high else "low", KINDS[left + right])
        for yarn in yarns_of(weave.interlacement())
        for high, left, right in zip(yarn.high, yarn.turns_left, yarn.turns_right)
    )


def yarn_volumes(columns: Mapping[str, np.ndarray], weaves: tuple[Weave, ...]) -> dict[str, np.ndarray]:
    """Volume (rows,) of all wefts and of all warps of the cell, mm3, from the columns of a solved table.

    NaN in rows with round sections, whose arcs do not blend by areas.
    """
    distinct = {id(weave): weave for weave in weaves}
    order = {key: at for at, key in enumerate(distinct)}
    number = np.array([order[id(weave)] for weave in weaves], dtype=int)
    rounded = np.array([form == "round" for form in columns["section"]], dtype=bool)
    volumes = {}
    for d, crossed in zip(DIRECTIONS, reversed(DIRECTIONS)):
        over = columns[f"{crossed}_width_mm"]
        gap = columns[f"{d}_crossed_spacing_mm"] - over
        between = _between_area(columns, d)
        total = np.where(rounded, np.nan, 0.0)
        for plateau in PLATEAUX:
            for kind in KINDS:
                each = [crossing_counts(weave)[d, plateau, kind] for weave in distinct.values()]
                area = _contact_area(columns, d, crossed, plateau, kind)
                total += np.array(each)[number] * (area * over + (area + between) / 2 * gap)
        volumes[d] = total
    return volumes


def _between_area(columns: Mapping[str, np.ndarray], d: str) -> np.ndarray:
    """Area of the section between crossings, mm2: two parabolas q v^2 deep in b."""
    half = columns[f"{d}_width_mm"] / 2
    return 2 * half * columns[f"{d}_thickness_mm"] - columns[f"{d}_between_q"] * 4 / 3 * half**3


def _contact_area(columns: Mapping[str, np.ndarray], d: str, crossed: str, plateau: str, kind: str) -> np.ndarray:
    """Area of a contact section, mm2: envelope less free parabola less the contact profile's rise on every turn."""
    half = columns[f"{d}_width_mm"] / 2
    q, v0 = columns[f"{d}_{plateau}_{kind}_q"], columns[f"{d}_{plateau}_{kind}_v0_mm"]
    free = q * ((half - v0) ** 3 + (half + v0) ** 3) / 3
    # the crossed yarn lies at its other plateau, where its parabola is p
    high_there = plateau == "low"
    p = np.abs(columns[_PARABOLA[crossed, high_there]])
    rise = p * (half - columns[f"{d}_{plateau}_offset_mm"]) ** 3 / 3
    return 2 * half * columns[f"{d}_thickness_mm"] - free - KINDS.index(kind) * rise


_PARABOLA = {("weft", False): "p11", ("weft", True): "p12", ("warp", True): "p21", ("warp", False): "p22"}
"""Column of a direction's parabola at its high (True) or low plateau."""
