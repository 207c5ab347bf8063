"""How much of a yarn is fibre, along it: from its linear density and the area of its section, or as given.

A yarn holds the fibre section A_f = tex / (1000 density) mm2 (density in g/cm3) all along, or that
times the share of its weight that is fibre. A plane across the fabric cuts it in the area A, at the
slope theta of its trajectory; normal to the fibres that is A cos(theta), of which the fibres take V
= A_f / (A cos(theta)).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..cell.figures import yarn_data
from ..measured.tables import Family
from ..support.errors import InputError, Problem
from ..weave.directions import DIRECTIONS, Direction
from ..yarn.profiles import section_areas, slopes
from ..yarn.swept import SweptYarn
from .constituents import FILE
from .substances import CLOSEST_PACKING, Constituents

_SAMPLES = 33  # places between two control planes at which a fraction is checked


@dataclass(frozen=True)
class FibreSections:
    """Solid section of fibre, mm2, in a yarn of each direction, or the fraction that is given; else None.

    ``places`` says of each direction where a fraction that is too high is to be put right.
    """

    areas: Mapping[Direction, float]
    fraction: float | None
    places: Mapping[Direction, Problem]


def fibre_sections(row: Family, constituents: Constituents) -> FibreSections:
    """What is known of the fibres in the yarns of a table of one row.

    What ``composite.toml`` gives for the row by name goes before the row's linear density, that
    before what the file gives in general. Raises :class:`InputError` where a linear density is
    given, the fibre's density is not, and nothing else says how much fibre there is.
    """
    (name,) = row.names
    given, table = (
        constituents.yarn.fibre_fraction,
        Problem("", row.place.path, row.lines[0], row=name),
    )
    if constituents.yarn.own_fraction:
        return FibreSections({}, given, {})

    data = yarn_data(row, 0)
    known = {d: tex for d in DIRECTIONS if (tex := data[f"{d}_linear_density_tex"]) is not None}
    density = data["fibre_density_g_cm3"] or (
        constituents.fibre.density_g_cm3 if constituents.fibre else None
    )
    if known and density is None and given is None and constituents.yarn.law is None:
        message = "is missing: the fibre fraction is to follow from the linear density of the yarns"
        raise InputError(Problem(message, constituents.path, None, "density_g_cm3", name))

    share = constituents.yarn.fibre_weight_fraction
    areas = (
        {direction: share * value / (1000 * density) for direction, value in known.items()}
        if density
        else {}
    )
    if len(areas) < 2 and given is None and constituents.yarn.law is None:
        message = "is missing, and the row gives no linear density of both directions from which it would follow"
        raise InputError(Problem(message, constituents.path, None, "fibre_fraction", name))

    return FibreSections(areas, given, {direction: table for direction in areas})


def fibre_fractions(
    swept: SweptYarn, sections: FibreSections, places: np.ndarray
) -> np.ndarray | None:
    """Fibre volume fraction (places,) of a yarn at ``places`` (mm along it); None where it is not known.

    Raises :class:`InputError` where it is above that of round fibres that touch anywhere along the
    yarn, not at ``places`` alone.
    """
    area = sections.areas.get(swept.yarn.direction)
    if area is None:
        return None if sections.fraction is None else np.full(len(places), sections.fraction)

    _refuse_too_dense(swept, area, sections.places[swept.yarn.direction])
    return _fractions(swept, area, places)


def _fractions(swept: SweptYarn, area: float, places: np.ndarray) -> np.ndarray:
    # a mesh's elements stand in rows
    distinct, number = np.unique(np.round(places, 9), return_inverse=True)
    return (area / section_areas(swept, distinct) * np.sqrt(1 + slopes(swept, distinct) ** 2))[
        number
    ]


def _refuse_too_dense(swept: SweptYarn, area: float, table: Problem) -> None:
    bounds = np.array([plane.place for plane in swept.planes])
    share = np.linspace(0.0, 1.0, _SAMPLES)
    places = np.unique(bounds[:-1, None] + np.diff(bounds)[:, None] * share)
    fractions = _fractions(swept, area, places)
    worst = int(np.argmax(fractions))
    if fractions[worst] <= CLOSEST_PACKING:
        return

    column = f"{swept.yarn.direction}_linear_density_tex"
    message = (
        f"{swept.yarn.name}: its fibres would take {fractions[worst]:.4g} of its section {places[worst]:.4g} mm along "
        f"it, above {CLOSEST_PACKING:.4f}, where round fibres touch each other "
        f"({area:.4g} mm2 of fibre; {FILE} can give a fibre_fraction for the row)"
    )
    raise InputError(Problem(message, table.path, table.line, column, table.row))
