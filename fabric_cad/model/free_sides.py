"""The conics that a form's sections have opposite to contact and between crossings: registered for its class."""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from ..section.conics import free_parabola, lateral_arc, round_between, round_free_side
from ..section.edged import Edged
from ..section.forms import Form
from ..section.round import Round
from .contacts import BetweenValues, ContactValues


@singledispatch
def free_side(form: Form, contact: ContactValues, turns: tuple[bool, bool]) -> np.ndarray:
    """Free sides opposite to contact: q (1/mm), v0, left and right end (mm), shape (4, rows).

    ``turns`` says whether the crossed yarn changes sides left and right. (Fig. 9, 17) See
    :class:`~fabric_cad.section.frame.FreeSide`.
    """
    raise NotImplementedError(f"{type(form).__name__} has no free side")


@singledispatch
def between_side(form: Form, between: BetweenValues) -> tuple[np.ndarray, np.ndarray]:
    """Either side between crossings: its parabola q (1/mm) and half its extent (mm), shape (rows,). (Fig. 13)"""
    raise NotImplementedError(f"{type(form).__name__} has no section between crossings")


@free_side.register
def _(form: Edged, contact: ContactValues, turns: tuple[bool, bool]) -> np.ndarray:
    left, right = (turn * contact.edge_rise for turn in turns)
    q, v0 = free_parabola(contact.thickness, contact.width, left, right, contact.lateral_height)
    return np.array([q, v0, -contact.free_half_chord, contact.free_half_chord])


@between_side.register
def _(form: Edged, between: BetweenValues) -> tuple[np.ndarray, np.ndarray]:
    # both sides fall by (b - h)/2 over half the width
    q = 2 * (between.thickness - between.lateral_height) / between.width**2
    return q, between.width / 2


@free_side.register
def _(form: Round, contact: ContactValues, turns: tuple[bool, bool]) -> np.ndarray:
    left, right = (
        lateral_arc(
            contact.thickness,
            contact.width,
            contact.half_chord,
            turn * contact.rise,
            turn * contact.slope,
        )
        for turn in turns
    )
    return np.array(round_free_side(contact.thickness, contact.width, left, right))


@between_side.register
def _(form: Round, between: BetweenValues) -> tuple[np.ndarray, np.ndarray]:
    q, _ = round_between(between.thickness, between.width, between.half_chord)
    return q, between.half_chord
