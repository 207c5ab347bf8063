"""A fabric from numbers in a script, by the rules of a table's row."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Integral, Real

from ..support.errors import ArgumentError, InputError, Place, Problem, did_you_mean
from ..weave.weaves import FAMILIES
from .columns import TEXTS, WEAVE_COLUMNS, known_columns
from .family import Family
from .reader import read_rows
from .records import Record


def measured_fabric(family: str, **columns: object) -> Family:
    """The table of one row that a family table with these cells would have, ready for :func:`identify`.

    ``family`` is ``plain``, ``twill``, ``satin`` or ``pattern``; the keywords are the columns of
    its table, units in their names (``weft_density_per_mm`` 1/mm, ``weft_width_mm`` mm,
    ``weft_crimp`` a ratio or ``weft_crimp_percent`` ...), ``None`` as an empty cell::

        table = measured_fabric("twill", name="mine", over=2, under=2,
                                weft_density_per_mm=0.35, weft_width_mm=2.4, weft_crimp_percent=0.4)
        cell = build_cell(identify(table)["mine"])

    ``name`` is ``fabric`` where none is given; ``pattern`` may also be a list of a text a weft.
    Raises :class:`ArgumentError`, an InputError and a TypeError, for an unknown keyword or a value
    of the wrong kind, and :class:`InputError` naming every keyword whose value breaks a rule of the
    tables.
    """
    if family not in FAMILIES:
        hint = did_you_mean(str(family), FAMILIES)
        raise ArgumentError(f"family: {family!r:.60} is none of {', '.join(FAMILIES)}{hint}")

    given = {"name": "fabric"} | {
        column: value for column, value in columns.items() if value is not None
    }
    if problems := _unknown(family, given):
        raise ArgumentError(problems)
    texts, problems = {}, []
    for column, value in given.items():
        try:
            texts[column] = _text(family, column, value)
        except TypeError as error:
            problems.append(Problem(str(error), column=column))

    if problems:
        raise ArgumentError(problems)

    needed = ("name", *WEAVE_COLUMNS[family])
    header = list(dict.fromkeys([*needed, *texts]))
    row = Record(None, tuple(texts.get(column, "") for column in header))
    table = read_rows(family, header, Place(), [row])
    if table.refused:
        raise InputError(table.refused)

    return table


def _unknown(family: str, given: Iterable[str]) -> list[Problem]:
    known = known_columns(family)
    return [
        Problem(
            f"unknown column of the {family} table{did_you_mean(column.lower(), known, cutoff=0.3)}",
            column=column,
        )
        for column in given
        if column not in known
    ]


def _text(family: str, column: str, value: object) -> str:
    """A value as the text of a cell. Raises TypeError where it is of the wrong kind."""
    if column in TEXTS or column == "pattern":
        if column == "pattern" and not isinstance(value, str) and isinstance(value, Iterable):
            value = "/".join(map(str, value))
        if not isinstance(value, str):
            raise TypeError(f"expected a text, got {type(value).__name__} {value!r:.60}")
        return value.strip()

    whole = column in WEAVE_COLUMNS[family]
    if isinstance(value, bool) or not isinstance(value, Integral if whole else Real):
        word = "a whole number" if whole else "a number"
        raise TypeError(f"expected {word}, got {type(value).__name__} {value!r:.60}")

    if isinstance(value, Integral) and whole:
        return str(int(value))
    try:
        return repr(float(value))
    except OverflowError:
        return repr(math.copysign(math.inf, value))
