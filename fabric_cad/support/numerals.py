"""Numbers as a person writes them: ASCII digits only.

Python's own ``float`` and ``int`` read the digits of every script, ``1_000``, ``nan`` and ``inf``
too.
"""

from __future__ import annotations

import math
import re

from .errors import quoted

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_WHOLE = re.compile(r"[+-]?[0-9]{1,18}")


def number(text: str) -> float:
    """The finite number of a text such as ``3.5e-1``. Raises ValueError for anything else."""
    if not _NUMBER.fullmatch(text) or not math.isfinite(float(text)):
        raise ValueError(f"{quoted(text)} is not a number")
    return float(text)


def whole(text: str) -> int:
    """The whole number of a text such as ``12``. Raises ValueError for anything else."""
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"{quoted(text)} is not a whole number")
    return int(text)


whole.__name__ = "whole number"  # as argparse calls it
