"""A row as the text of a link: ``twill?name=mine&over=3&under=2&weft_width_mm=2.4``."""

from __future__ import annotations

from urllib.parse import parse_qsl, quote, urlencode

from ..support.errors import InputError, Problem
from .edited import EditedRow

LONGEST = 16_000
"""Characters of the longest link that is read: no browser sends more, and no row needs them."""

_ROWS_OWN = ("source", "notes")  # texts of the table that a link does not carry


def link_of(row: EditedRow) -> str:
    """The text of a link that holds a row, without its source and notes."""
    cells = {column: text for column, text in row.cells.items() if column not in _ROWS_OWN}
    return f"{row.family}?{urlencode(cells, safe='/', quote_via=quote)}"


def row_of(link: str) -> EditedRow:
    """The row a link holds. Raises :class:`InputError` where it is none."""
    if len(link) > LONGEST:
        raise InputError(f"the link has {len(link)} characters, more than {LONGEST}")

    family, _, query = link.partition("?")
    try:
        pairs = parse_qsl(
            query, keep_blank_values=True, strict_parsing=bool(query), errors="strict"
        )
    except ValueError as error:
        raise InputError(f"the link holds no row: {error}") from error

    cells = dict(pairs)
    twice = [column for column in cells if [name for name, _ in pairs].count(column) > 1]
    if twice:
        raise InputError(
            [Problem("this column stands twice in the link", column=column) for column in twice]
        )

    return EditedRow(family, cells)
