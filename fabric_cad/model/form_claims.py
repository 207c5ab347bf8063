"""What a form's sections need to fit into their envelope, contact profile and free side: for its class."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import singledispatch

import numpy as np

from ..section.conics import lateral_arc
from ..section.edged import Edged
from ..section.flat import Flat
from ..section.forms import Form
from ..section.round import Round
from ..weave.directions import Direction
from .claims import Claim, last_column
from .contacts import ContactValues
from .measured_values import CONTACT_SIDE
from .solution import Solution


@singledispatch
def form_claims(form: Form, direction: Direction) -> Iterable[Claim]:
    """The claims of a direction's sections, in the order in which they are told. (Fig. 9, 17)"""
    return ()


@form_claims.register
def _(form: Edged, direction: Direction) -> Iterable[Claim]:
    return [_edge_is_left(direction, plateau) for plateau in CONTACT_SIDE]


@form_claims.register
def _(form: Flat, direction: Direction) -> Iterator[Claim]:
    for plateau in CONTACT_SIDE:
        yield _edge_is_left(direction, plateau)
        yield _sides_fit(direction, plateau)


@form_claims.register
def _(form: Round, direction: Direction) -> Iterator[Claim]:
    for plateau in CONTACT_SIDE:
        yield _arcs_fit(direction, plateau)
    yield _arcs_fit_between(direction)


def _edge_is_left(direction: Direction, plateau: str) -> Claim:
    """The contact profile ends below the envelope's far side."""

    def column(solution: Solution, row: int) -> str:
        crimp = f"{direction.other}_crimp"
        return crimp if crimp in solution.identifying.names(row) else last_column(solution, row)

    def broken(solution: Solution) -> np.ndarray:
        return ~(solution.contacts[direction, plateau].edge_rise < solution.thickness[direction])

    def message(solution: Solution, row: int) -> str:
        contact = solution.contacts[direction, plateau]
        return (
            f"the contact rise at the {direction}'s edges, {contact.edge_rise[row]:.4g} mm, "
            f"is not below the {direction} thickness {contact.thickness[row]:.4g} mm"
        )

    return Claim(broken, column, message)


def _sides_fit(direction: Direction, plateau: str) -> Claim:
    """An upright side ends below the envelope's far side."""

    def broken(solution: Solution) -> np.ndarray:
        contact = solution.contacts[direction, plateau]
        return ~(contact.edge_rise + contact.lateral_height < contact.thickness)

    def message(solution: Solution, row: int) -> str:
        contact = solution.contacts[direction, plateau]
        left = contact.thickness[row] - contact.edge_rise[row]
        return (
            f"{contact.lateral_height[row]:g} is not below the {left:.4g} mm "
            f"that the contact rise leaves at the {direction}'s edges"
        )

    return Claim(broken, lambda solution, row: "lateral_height_mm", message)


def _top_of_arcs(contact: ContactValues) -> np.ndarray:
    """Highest point of an arc above the contact side, whether the crossed yarn turns or not, mm."""
    tops = []
    for turn in (1, 0):
        radius, centre = lateral_arc(
            0.0, contact.width, contact.half_chord, turn * contact.rise, turn * contact.slope
        )
        tops.append(centre + radius)
    return np.maximum(*tops)


def _arcs_fit(direction: Direction, plateau: str) -> Claim:
    """The arcs of a contact section end below the envelope's far side."""
    side = CONTACT_SIDE[plateau]

    def broken(solution: Solution) -> np.ndarray:
        contact = solution.contacts[direction, plateau]
        return ~(_top_of_arcs(contact) < contact.thickness)

    def message(solution: Solution, row: int) -> str:
        contact = solution.contacts[direction, plateau]
        return (
            f"a chord of {solution.measured.chord[direction, plateau][row]:.4g} mm leaves arcs "
            f"{_top_of_arcs(contact)[row]:.4g} mm high, not below the "
            f"{direction} thickness {contact.thickness[row]:.4g} mm"
        )

    return Claim(
        broken, lambda solution, row: _contact_column(solution, row, direction, side), message
    )


def _arcs_fit_between(direction: Direction) -> Claim:
    """Between crossings half an arc is less high than the envelope's half."""

    def broken(solution: Solution) -> np.ndarray:
        between = solution.between(direction)
        return ~(between.width / 2 - between.half_chord < between.thickness / 2)

    def message(solution: Solution, row: int) -> str:
        between = solution.between(direction)
        return (
            f"between crossings the arcs would be {between.width[row] - 2 * between.half_chord[row]:.4g} mm high, "
            f"not below the {direction} thickness {between.thickness[row]:.4g} mm"
        )

    return Claim(
        broken, lambda solution, row: _contact_column(solution, row, direction, "top"), message
    )


def _contact_column(solution: Solution, row: int, direction: Direction, side: str) -> str:
    """Where a contact chord was measured: of the weft for both directions of a balanced row."""
    measured = Direction.WEFT if solution.measured.balanced[row] else direction
    return f"{measured}_contact_{side}_mm"
