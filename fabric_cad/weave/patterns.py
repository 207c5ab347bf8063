"""Interlacements as a person writes them: one text a weft, a mark for every warp it crosses.

::

    oouu/oouu/uuoo/uuoo      1100 1100 0011 0011      the same basket weave twice

``o`` or ``1``: the weft passes over the warp; ``u`` or ``0``: under. The first text is
weft 1, at the smallest y; its first mark is warp 1, at the smallest x.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from ..support.errors import quoted

_BETWEEN = re.compile(r"[\s/|]+")
_DIGITS, _LETTERS = set("10"), set("ou")


def read_pattern(text: str) -> tuple[str, ...]:
    """The pattern of a text, one string of ``1`` (over) and ``0`` (under) a weft.

    Spaces, line breaks, ``/`` and ``|`` part the wefts. Raises ValueError for any other
    character, and for digits and letters together: a letter O among zeros would mean the
    contrary of what is seen.
    """
    marks = tuple(row for row in _BETWEEN.split(text.lower()) if row)
    used = set("".join(marks))
    if strange := used - _DIGITS - _LETTERS:
        shown = " ".join(sorted(strange))
        raise ValueError(
            f"{quoted(text)} has {shown} in it; a pattern is of 1 and 0, or of o and u, "
            "for a weft over and under a warp "
            "(a spreadsheet makes a date of 10/01, but not of ou/uo)"
        )

    if used & _DIGITS and used & _LETTERS:
        raise ValueError(f"{quoted(text)} has digits and letters; write 1 and 0, or o and u")

    return tuple(row.translate(str.maketrans("ou", "10")) for row in marks)


def written(pattern: Iterable[str]) -> str:
    """A pattern as text that every spreadsheet leaves alone, e.g. ``oouu/uuoo``."""
    return "/".join(row.translate(str.maketrans("10", "ou")) for row in pattern)
