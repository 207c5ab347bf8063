"""The sett of a weaving draft: how closely its threads lie, and how thick they are drawn."""

from __future__ import annotations

from ..support.errors import quoted
from ..weave.directions import DIRECTIONS
from .drafts import MOST_THREADS, Draft

_UNITS = {
    **dict.fromkeys(("decipoints", "decipoint"), 25.4 / 720),
    **dict.fromkeys(("inches", "inch", "in"), 25.4),
    **dict.fromkeys(("centimeters", "centimetres", "centimeter", "centimetre", "cm"), 10.0),
    **dict.fromkeys(("millimeters", "millimetres", "millimeter", "millimetre", "mm"), 1.0),
}
"""Millimetres of the units a draft may name: the specification's three, in the words programs use, and mm."""


def sett(draft: Draft) -> dict[str, str]:
    """What a draft says of densities (1/mm) and thicknesses (mm), by column of the table."""
    cells, notes = {}, []
    for direction in DIRECTIONS:
        spacing = draft.measure(direction, "spacing")
        each = [
            draft.measure(f"{direction} spacing", key)
            for key in draft.sections.get(f"{direction} spacing", {})
        ]
        threads = draft.count(direction, "threads", MOST_THREADS) or len(each)
        if any(each) and (spacing or len(each) >= threads):  # threads with a spacing of their own
            own = [value or spacing or 0.0 for value in each]
            spacing = (sum(own) + max(0, threads - len(own)) * (spacing or 0.0)) / max(
                threads, len(own)
            )

        thickness = draft.measure(direction, "thickness")
        if spacing is None:
            continue
        if (unit := _unit(draft, direction)) is None:
            notes.append(f"{direction} spacing {spacing:g} in no unit")
            continue

        cells[f"{direction}_density_per_mm"] = f"{1 / (spacing * unit):.6g}"
        if thickness is not None and thickness < spacing:
            cells[f"{direction}_thickness_mm"] = f"{thickness * unit:.6g}"

    return cells | ({"notes": "; ".join(notes)} if notes else {})


def _unit(draft: Draft, direction: str) -> float | None:
    """Millimetres of the unit of a direction's spacing, None where the draft names none."""
    name = draft.entry(direction, "units").lower()
    if name and name not in _UNITS:
        raise draft.wrong(
            f"{quoted(name)} is none of decipoints, inches and centimeters", direction, "units"
        )
    return _UNITS.get(name)
