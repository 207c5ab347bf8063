"""The texts of a table being read: a mapping by column a row, and what was found wrong with them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .refusals import Refusals

Texts = dict[str, str | None]
"""The texts of a row by column: "" where a cell is empty, None where it is refused for what it is in its sheet."""


@dataclass(frozen=True)
class TextRows:
    """The rows of a table as texts under their header.

    ``separator`` is that of the file, "" in a workbook.
    """

    header: Sequence[str]
    separator: str
    rows: Sequence[Texts]
    refusals: Refusals

    def __len__(self) -> int:
        return len(self.rows)

    def column(self, column: str) -> Iterator[tuple[int, str | None]]:
        """Row number and text of a column, nothing where the header does not have it."""
        return ((row, texts[column]) for row, texts in enumerate(self.rows) if column in texts)

    def has_text(self, column: str) -> np.ndarray:
        """True, shape (rows,), where a text stands that is not refused."""
        return np.array([bool(texts[column]) for texts in self.rows], dtype=bool)

    def is_filled(self, column: str) -> np.ndarray:
        """True, shape (rows,), where something stands, be it refused."""
        return np.array([texts[column] != "" for texts in self.rows], dtype=bool)
