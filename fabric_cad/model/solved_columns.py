"""The columns of a solved table: what their names mean stands in :mod:`~fabric_cad.model.solved`."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from ..measured.family import Family
from ..section.frame import KINDS
from ..weave.directions import DIRECTIONS, Direction
from ..weave.levels import HIGH, LOW, level_of
from .closing import CLOSING, Closed
from .contacts import of_rows
from .free_sides import between_side, free_side
from .identifying import SETS
from .measured_values import Measured
from .solution import Solution
from .solved import PLATEAUX, point_columns

Columns: TypeAlias = dict[str, Any]
"""Arrays, or lists of texts and whole numbers, of one value a row."""

_TURNS = dict(zip(KINDS, ((False, False), (False, True), (True, True))))
"""Where the crossed yarn changes sides, left and right, by kind of contact section."""


def solved_columns(table: Family, solution: Solution, other: Closed, two: np.ndarray) -> Columns:
    """Every column, of one value a row.

    ``other`` is what is not taken of ``two`` solutions, boolean (rows,).
    """
    columns = _of_rows(table, solution)
    for direction in DIRECTIONS:
        columns |= _scalars(solution, direction)
        columns |= _path(solution, direction)
        columns |= _contact_sections(solution, direction)
        columns |= _between_sections(solution, direction)

    for direction, thickness in zip(DIRECTIONS, (other.b1, other.b2)):
        columns[f"other_{direction}_thickness_mm"] = [
            value if there else "" for value, there in zip(thickness.tolist(), two.tolist())
        ]

    return columns


def _of_rows(table: Family, solution: Solution) -> Columns:
    """What a row is, and what identified it."""
    identified_by = [" ".join(CLOSING[quantity] for quantity in quantities) for quantities in SETS]
    return {
        "name": list(table.names),
        "family": [table.family] * len(table),
        "over": [weave.over for weave in table.weaves],
        "under": [weave.under for weave in table.weaves],
        "step": [weave.step for weave in table.weaves],
        "pattern": [" ".join(weave.pattern) for weave in table.weaves],
        "section": list(table.sections),
        "lateral_height_mm": solution.measured.lateral_height,
        "float_gap": list(table.float_gaps),
        "parameters": _parameters(table, solution.measured),
        "identified_by": [identified_by[number] for number in solution.identifying.number.tolist()],
        "fabric_thickness_mm": solution.closed.fabric,  # (15)
    }


def _parameters(table: Family, measured: Measured) -> np.ndarray:
    """Number of the paper's parameters that a row uses (sections 5.1, 5.2)."""

    def any_given(quantity: str) -> np.ndarray:
        columns = [f"{d}_{quantity}_{side}_mm" for d in DIRECTIONS for side in ("top", "bottom")]
        return np.any([~np.isnan(table.measured[column]) for column in columns], axis=0)

    a_direction = np.select([any_given("offset"), any_given("contact")], [6, 4], 0)
    for form, rows in measured.forms:
        if form.parameters:
            a_direction[rows] = form.parameters
    return np.where(
        measured.balanced, np.maximum(a_direction, 3), np.where(a_direction, 2 * a_direction, 7)
    )


def _scalars(solution: Solution, direction: Direction) -> Columns:
    transitions, slope = solution.transitions[direction], solution.slope[direction]
    crimp = np.where(
        _crimp_identified(solution, direction),
        solution.measured.crimp(direction),
        transitions.crimp(slope),
    )
    return {
        f"{direction}_crossed_spacing_mm": transitions.spacing,
        f"{direction}_width_mm": solution.measured.width[direction],
        f"{direction}_thickness_mm": solution.thickness[direction],
        f"{direction}_crimp": crimp,
        f"{direction}_slope": slope,
        f"{direction}_amplitude_mm": solution.amplitude[direction],
    }


def _crimp_identified(solution: Solution, direction: Direction) -> np.ndarray:
    """Boolean (rows,): a direction's measured crimp identified the row.

    In a balanced row the weft's crimp is the warp's too where both float alike; a pattern's warps
    may change sides more or less often than its wefts: then no one crimp is both's.
    """
    own = solution.identifying.uses(CLOSING.index(f"{direction}_crimp"))
    if direction is Direction.WEFT:
        return own

    weft, warp = (solution.transitions[d].projected for d in DIRECTIONS)
    wefts = solution.identifying.where(
        lambda quantities: quantities == (CLOSING.index("weft_crimp"),)
    )
    return own | (wefts & solution.measured.balanced & (weft == warp))


def _path(solution: Solution, direction: Direction) -> Columns:
    """Parabolas and control points of the trajectory; frame R of Fig. 15.

    The weft starts in the middle of its low float, the warp in that of its high one.
    """
    transitions, crossed = solution.transitions[direction], direction.other
    A1, A2 = solution.closed.A1, solution.closed.A2
    offsets = [solution.measured.offset[crossed, plateau] for plateau in ("high", "low")]
    floats = [transitions.low_float, transitions.high_float]
    extents = [transitions.u_low, transitions.u_high]

    z_low, z_high = (level_of(direction, below).height(direction, A1, A2) for below in (LOW, HIGH))
    if direction is Direction.WEFT:
        number, sign, z_start, z_end = 1, 1.0, z_low, z_high
    else:
        number, sign, z_start, z_end = 2, -1.0, z_high, z_low
        offsets, floats, extents = offsets[::-1], floats[::-1], extents[::-1]

    # (A.25), (A.26): s = 2 p u at either plateau
    p_start, p_end = (sign * solution.slope[direction] / (2 * extent) for extent in extents)

    # (A.1)-(A.8)
    leaves = (floats[0] - 1) / 2 * transitions.spacing + offsets[0]
    reaches = (floats[0] + 1) / 2 * transitions.spacing - offsets[1]
    end = (transitions.low_float + transitions.high_float) / 2 * transitions.spacing
    along = (0.0 * leaves, leaves, leaves + extents[0], reaches - extents[1], reaches, end)

    # (A.27)-(A.29), (A.32)-(A.34)
    z_after, z_before = z_start + p_start * extents[0] ** 2, z_end - p_end * extents[1] ** 2
    heights = (z_start, z_start, z_after, z_before, z_end, z_end)

    columns: Columns = {f"p{number}1": p_start, f"p{number}2": p_end}
    for (_, along_column, height_column), x, z in zip(point_columns(direction), along, heights):
        columns |= {along_column: x, height_column: z}
    return columns


def _contact_sections(solution: Solution, direction: Direction) -> Columns:
    """Contact profile and free sides of one direction's contact sections. (Fig. 9, 17)"""
    columns: Columns = {}
    for plateau in PLATEAUX:
        contact = solution.contacts[direction, plateau]
        columns[f"{direction}_{plateau}_chord_mm"] = 2 * contact.half_chord
        columns[f"{direction}_{plateau}_offset_mm"] = contact.offset

        for kind, turns in _TURNS.items():
            sides = np.full((4, len(contact.width)), np.nan)
            for form, rows in solution.measured.forms:
                sides[:, rows] = free_side(form, of_rows(contact, rows), turns)
            for name, values in zip(("q", "v0_mm", "left_mm", "right_mm"), sides):
                columns[f"{direction}_{plateau}_{kind}_{name}"] = values
    return columns


def _between_sections(solution: Solution, direction: Direction) -> Columns:
    """The conics of one direction's section between crossings. (Fig. 13)"""
    between = solution.between(direction)
    q, end = np.full((2, len(between.width)), np.nan)
    for form, rows in solution.measured.forms:
        q[rows], end[rows] = between_side(form, of_rows(between, rows))
    return {f"{direction}_between_q": q, f"{direction}_between_end_mm": end}
