"""The rules between the cells of a row, each once, in the order in which they are told."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..section.forms import FORMS, Form
from ..support.errors import Problem
from ..weave.directions import DIRECTIONS
from .columns import MEASURED
from .family import Family
from .form_rules import contact_rules
from .row_values import RowValues
from .rules import BOUNDS, Rule


def _there(column: str, direction: str) -> Rule:
    hint = " (leave every warp cell empty for a balanced fabric)" if direction == "warp" else ""
    return Rule(
        column,
        lambda rows: rows.has(direction) & ~rows.filled[column],
        f"this cell is empty{hint}",
    )


def _beside_each_other(direction: str) -> Rule:
    column = f"{direction}_width_mm"
    return Rule(
        column,
        lambda rows: rows.has(direction) & (rows.values[column] >= rows.spacing(direction)),
        f"{{value}} is not below the {direction} spacing {{bound:.4g}} mm",
        lambda rows: rows.spacing(direction),
    )


SPACING = {direction: _beside_each_other(direction) for direction in DIRECTIONS}
"""Yarns of a direction lie beside each other."""


def _lateral(forms: Iterable[Form]) -> Iterator[Rule]:
    """The height of the sides belongs to the forms that take it: a flat section."""
    words = [form.word for form in forms if form.takes_lateral_height]
    column = "lateral_height_mm"

    yield Rule(
        column,
        lambda rows: rows.is_section(*words) & ~rows.filled[column],
        "this cell is empty; a {section} section needs the height of its sides",
    )
    yield Rule(
        column,
        lambda rows: ~rows.is_section(*words) & ~np.isnan(rows.values[column]),
        "{value} has no meaning for a {section} section; write flat",
    )


def _chord(direction: str, side: str) -> Rule:
    chord, width = f"{direction}_contact_{side}_mm", f"{direction}_width_mm"
    return Rule(
        chord,
        lambda rows: rows.values[chord] > rows.values[width],
        f"{{value}} is above the {direction} width {{bound:g}} mm",
        lambda rows: rows.values[width],
    )


def _offset(direction: str, side: str) -> Rule:
    offset = f"{direction}_offset_{side}_mm"
    return Rule(
        offset,
        lambda rows: rows.values[offset] >= rows.chord(direction, side) / 2,
        "{value} is not below half the contact chord, {bound:g} mm",
        lambda rows: rows.chord(direction, side) / 2,
    )


def _only_of(form: Form, rule: Rule) -> Rule:
    """The rule for rows of one form."""
    return replace(rule, broken=lambda rows: rows.is_section(form.word) & rule.broken(rows))


def relations() -> tuple[Rule, ...]:
    """Rules between cells of one row, with those of all section forms."""
    return _relations(tuple(FORMS.values()))


@lru_cache(maxsize=8)
def _relations(forms: tuple[Form, ...]) -> tuple[Rule, ...]:
    return tuple(_all_relations(forms))


def _all_relations(forms: tuple[Form, ...]) -> Iterator[Rule]:
    for direction in DIRECTIONS:
        for quantity in ("density_per_mm", "width_mm"):
            yield _there(f"{direction}_{quantity}", direction)
        yield SPACING[direction]

    yield from _lateral(forms)

    for direction in DIRECTIONS:
        for side in ("top", "bottom"):
            yield _chord(direction, side)
            for form in forms:
                for rule in contact_rules(form, direction, side):
                    yield _only_of(form, rule)
            yield _offset(direction, side)


def _finite(column: str) -> Rule:
    return Rule(column, lambda rows: np.isinf(rows.values[column]), "{value} is not a number")


NUMBERS_ALONE = tuple(rule for column in MEASURED for rule in (_finite(column), BOUNDS[column]))
"""What each measured number must keep by itself."""


def out_of_bounds(table: Family) -> dict[int, Problem]:
    """The first rule that each row breaks, by row number; of rows that break any."""
    rows = RowValues.of(table)
    refused: dict[int, Problem] = {}

    for rule in (*NUMBERS_ALONE, *relations()):
        for row, message in rule.faults(rows):
            if row not in refused:
                refused[row] = table.problem(row, rule.column, message)
    return refused
