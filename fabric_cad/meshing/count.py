"""How many hexahedra a mesh will have, and what it will take, told from its options alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..model.solved import SolvedFabric
from ..section.sections import Frame
from ..weave.weaves import yarns_of

if TYPE_CHECKING:
    from .options import MeshOptions

BYTES_A_HEXAHEDRON = 540
"""Memory a hexahedron takes until all files are written, measured: 382 of one million, 536 of 2.55 million."""

_NEARLY = 0.1
"""Two half chords that differ by less than this share of a column count as nearly equal."""


def chord_ends(frame: Frame, side: str, across: int) -> tuple[list[float], list[float]]:
    """Half widths (mm) at which columns of a pointed or flat section end: typical ones of both sides, and this side's.

    Top and bottom share their columns, which end at either contact chord; where the two chords are nearly
    equal there is none for so small a difference, and each side has its own chord's end in the same column.
    """
    edge, half = frame.width / 2, frame.splits[side][0]
    chords = [frame.splits[each][0] for each in ("bottom", "top") if frame.has_laterals(each)]
    if len(chords) == 2 and max(chords) - min(chords) < _NEARLY * frame.width / across:
        return [sum(chords) / 2, edge], [half, edge]
    ends = sorted({*chords, edge})
    return ends, ends


def column_counts(ends: Sequence[float], across: int) -> list[int]:
    """Elements on the middle interval, from -ends[0] to ends[0], and on the pairs beside it: ``across`` in all.

    A narrow interval gets one element still, so that there may be more.
    """
    pairs = [2 * max(1, round(across * (b - a) / (2 * ends[-1]))) for a, b in zip(ends, ends[1:])]
    return [max(1, across - sum(pairs)), *pairs]


def lateral_count(frame: Frame, side: str, across: int) -> int:
    """Elements on either arc of a round section's side, about as long as the ``across`` ones on its chord."""
    half = frame.splits[side][0]
    return max(1, round(across * (frame.width / 2 - half) / (2 * half)))


def hexahedra(fabric: SolvedFabric, options: MeshOptions) -> int:
    """The number of hexahedra of a fabric's cell, exactly."""
    across = {"weft": options.across, "warp": options.crossing}
    frames = {direction: fabric.frame(direction) for direction in across}
    quads = {d: _section_quads(frames[d], across[d], options.through) for d in across}
    layers = {
        (d, high): options.gap + _side_columns(frames[crossed], "top" if high else "bottom", across[crossed])
        for d, crossed in (("weft", "warp"), ("warp", "weft"))
        for high in (True, False)
    }
    return sum(
        quads[yarn.direction] * sum(layers[yarn.direction, high] for high in yarn.high)
        for yarn in yarns_of(fabric.weave.interlacement())
    )


def _side_columns(frame: Frame, side: str, across: int) -> int:
    if frame.form == "round":
        return across + 2 * lateral_count(frame, side, across)
    return sum(column_counts(chord_ends(frame, side, across)[0], across))


def _section_quads(frame: Frame, across: int, through: int) -> int:
    """Quadrilaterals of the templates of :mod:`fabric_cad.meshing.templates`."""
    if frame.form == "round":
        return (across + 2) * through - 4  # a block of two layers less in a ring without corners
    columns = _side_columns(frame, "bottom", across)
    if frame.form == "flat":
        return columns * through
    return columns * through - through**2 // 2  # either pointed edge: 3 k^2 in place of 4 k^2, k = through / 2


_COPIES = 6
"""Arrays of a section's weights that are there at once while its template is made."""


def needed_memory(fabric: SolvedFabric, options: MeshOptions) -> int:
    """Bytes that meshing a fabric's cell and writing its files takes beyond the program itself.

    Besides the hexahedra these are a section's nodes, each a weighted mean of all nodes of its outline.
    """
    sections = [
        2 * (across + options.through) * (across + 1) * (options.through + 1)
        for across in (options.across, options.crossing)
    ]
    return BYTES_A_HEXAHEDRON * hexahedra(fabric, options) + _COPIES * 8 * max(sections)
