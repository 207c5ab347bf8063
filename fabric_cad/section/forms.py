"""The forms a section may have: a frozen dataclass each, known by the word that tables have for it.

What a form does is told by generic functions, each registered for the class of a form
(:func:`functools.singledispatch`), in the folder where it is needed:

================================================  ==============================================
here                                              strips of contact and free sections
``measured.form_rules``                           rules between a row's cells
``model.free_sides``, ``model.form_claims``       conics of a solved row, and when it is no fabric
``yarn.volumes``                                  areas, where volumes have a closed form
``meshing.section_mesh``                          template, places of nodes, bounds of options
================================================  ==============================================

A form that is :class:`~fabric_cad.section.edged.Edged` has all of them and changes what it likes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import singledispatch
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar

import numpy as np

if TYPE_CHECKING:
    from .frame import ContactSide, Frame, FreeSide
    from .strips import Strip


@dataclass(frozen=True)
class Form:
    """The form of a section: what its lateral zones are like, between contact and free side.

    ``word`` is its name in tables; ``takes_lateral_height`` says whether a row must give the height
    of its sides; ``parameters`` of a direction are those the paper counts for the form itself, 0
    where contact chords and offsets make the count (sections 5.1, 5.2).
    """

    word: ClassVar[str]
    takes_lateral_height: ClassVar[bool] = False
    parameters: ClassVar[int] = 0


_forms: dict[str, Form] = {}

FORMS: Mapping[str, Form] = MappingProxyType(_forms)
"""Every form by its word, the one of rows that name none first."""


def register(form: Form) -> None:
    """Let rows have a form. Raises ValueError where its word is taken."""
    if form.word in _forms:
        raise ValueError(f"there is a section form {form.word!r} already")
    _forms[form.word] = form


def unregister(form: Form) -> None:
    """Take back what :func:`register` did."""
    del _forms[form.word]


def rows_by_form(words: Sequence[str]) -> Iterator[tuple[Form, np.ndarray]]:
    """Every form that rows have, and their numbers, shape (rows of the form,).

    ``words`` are one a row.
    """
    named = np.array(words, dtype=object)
    for word, form in FORMS.items():
        rows = np.flatnonzero(named == word)
        if len(rows):
            yield form, rows


@singledispatch
def contact_strips(
    form: Form, frame: Frame, contact: ContactSide, turns: tuple[bool, bool], free: FreeSide
) -> list[Strip]:
    """New strips of a section whose bottom touches, in the order of its faces. (Fig. 9, 17)

    Arguments as in :func:`~fabric_cad.section.sections.contact_section`.
    """
    raise NotImplementedError(f"{type(form).__name__} has no contact section")


@singledispatch
def free_strips(form: Form, frame: Frame, between: FreeSide) -> list[Strip]:
    """New strips of the section between crossings, in the order of its faces. (Fig. 13)"""
    raise NotImplementedError(f"{type(form).__name__} has no section between crossings")
