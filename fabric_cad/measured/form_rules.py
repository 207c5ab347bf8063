"""What a section's form asks of a row's cells: registered for its class."""

from __future__ import annotations

from functools import singledispatch

from ..section.forms import Form
from ..section.round import Round
from .rules import Rule


@singledispatch
def contact_rules(form: Form, direction: str, side: str) -> tuple[Rule, ...]:
    """Rules of the contact chord and offset of a yarn's ``top`` or ``bottom``, beyond those of all forms."""
    return ()


@contact_rules.register
def _(form: Round, direction: str, side: str) -> tuple[Rule, ...]:
    width = f"{direction}_width_mm"
    return (
        Rule(
            f"{direction}_contact_{side}_mm",
            lambda rows: rows.chord(direction, side) == rows.values[width],
            "a round section needs a contact chord below its width {bound:g} mm",
            lambda rows: rows.values[width],
        ),
    )
