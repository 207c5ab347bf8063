"""Filling round sections: one ring template a direction, smoothed section by section.

The sections of a direction are few: those of its control planes, and what they blend to in a gap.
At some stations of every gap the inner nodes are moved to their best places; between stations the
displacements are interpolated, so that lines of nodes along the yarn run smoothly. All layers of
one crossing have the same section, and get the same displacements.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..section.strips import Section, Strip
from .smoothing import smoothed
from .templates import Template, block_modes, round_template, worst_corner

_INSETS = [
    (lateral, upright)
    for upright in (0.08, 0.12, 0.17, 0.22)
    for lateral in np.geomspace(0.002, 0.1, 14)
]
"""Thicknesses of the ring to choose from, as shares of width and height."""

_STATIONS = 4
"""The most intervals between stations from one control plane to the next."""

Strips = Mapping[str, tuple[np.ndarray, np.ndarray]]
"""Each side's places in the outline, and their shares of its strip."""


@dataclass(frozen=True, eq=False)
class Span:
    """Layers between two control planes: the planes' sections and the layers' shares of the way."""

    first: Section
    second: Section
    shares: np.ndarray

    @property
    def stations(self) -> np.ndarray:
        """The shares at which the section is smoothed."""
        if self.first is self.second:
            return self.shares[:1]
        last = len(self.shares) - 1
        layers = np.linspace(0, last, min(last, _STATIONS) + 1).round().astype(int)
        return self.shares[np.unique(layers)]


def fill_rings(
    yarns: Sequence[Sequence[Span]], strips: Strips, across: int, upright: int
) -> tuple[Template, list[np.ndarray]]:
    """The template of a direction's yarns, each a sequence of spans, and how far their inner nodes are moved.

    The displacements, one array (layers, inner, 2) in mm a yarn, are across and upwards.
    """
    spans = [span for yarn in yarns for span in yarn]
    stations = list(
        dict.fromkeys(_station(span, share) for span in spans for share in span.stations)
    )
    outlines = np.array([_outline(station, strips) for station in stations])
    templates = [round_template(across, upright, inset) for inset in _INSETS]
    template = templates[int(np.argmax([worst_corner(each, outlines) for each in templates]))]

    modes = block_modes(across, upright)
    coefficients = dict(zip(stations, smoothed(template, modes, outlines)))
    return template, [modes @ _along(yarn, coefficients) for yarn in yarns]


def _station(span: Span, share: float) -> tuple[Section, Section, float]:
    """What tells the section at a share of a span."""
    if share in (0.0, 1.0) or span.first is span.second:
        section = span.second if share == 1.0 else span.first
        return section, section, 0.0
    return span.first, span.second, float(share)


def _outline(station: tuple[Section, Section, float], strips: Strips) -> np.ndarray:
    """Outline nodes (outline, 2) of the section at a station, mm: the blend that is swept there."""
    first, second, share = station
    blend = share**2 * (3 - 2 * share)
    places = np.empty((1 + max(int(slots.max()) for slots, _ in strips.values()), 2))
    for side, (slots, shares) in strips.items():
        start, end = first.strips[side], second.strips[side]
        weights = (1 - blend) * start.poles[:, 2:] + blend * end.poles[:, 2:]
        weighted = [strip.poles[:, :2] * strip.poles[:, 2:] for strip in (start, end)]
        poles = ((1 - blend) * weighted[0] + blend * weighted[1]) / weights
        places[slots] = Strip(side, start.knots, np.hstack([poles, weights])).at(shares)
    return places


def _along(spans: Sequence[Span], coefficients: Mapping) -> np.ndarray:
    """Coefficients (layers, modes, 2) of every layer of a yarn."""
    layers = []
    for number, span in enumerate(spans):
        known = np.array([coefficients[_station(span, share)] for share in span.stations])
        after = np.searchsorted(span.stations, span.shares).clip(1, max(len(known) - 1, 1))
        if len(known) == 1:
            inner = np.repeat(known, len(span.shares), axis=0)
        else:
            start, end = span.stations[after - 1], span.stations[after]
            share = ((span.shares - start) / (end - start))[:, None, None]
            inner = (1 - share) * known[after - 1] + share * known[after]
        layers.append(inner[1 if number else 0 :])
    return np.concatenate(layers)
