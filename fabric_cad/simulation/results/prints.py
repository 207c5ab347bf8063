"""What was printed of a job, from its ``.dat`` file."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

_TITLE = re.compile(
    r"^ (\S.*?) for (?:set (\S+) and |slave set (\S+), master set (\S+) and )?time +(\S+)\s*$"
)
_QUANTITIES = {
    "total force (fx,fy,fz)": "RF",
    "forces (fx,fy,fz)": "RF",
    "displacements (vx,vy,vz)": "U",
    "total internal energy": "ELSE",
    "internal energy (element, energy)": "ELSE",
    "total volume": "EVOL",
    "volume (element, volume)": "EVOL",
    "total contact spring energy": "CELS",
    "total number of contact elements": "CNUM",
    "statistics": "CF",
}
_SIZES = {"CF": 18}


@dataclass(frozen=True, eq=False)
class Printed:
    """One print request at one increment.

    ``quantity`` is the key asked for where this module knows its title (RF, U, ELSE, EVOL, CELS,
    CNUM, CF), else the title as printed. ``name`` is the set in upper case (as ccx keeps it), ""
    without a set, ``SLAVE/MASTER`` for CF. ``time`` is the total time. ``values``: of a sum
    (``TOTALS=ONLY``) the row of numbers, (3,) for RF, (1,) for ELSE, EVOL, CELS, CNUM; of a listing
    (rows, 1 + components), the node or element number first; of CF (18,), see
    :data:`CONTACT_FORCE`.
    """

    quantity: str
    name: str
    time: float
    values: np.ndarray


CONTACT_FORCE = {
    "force": slice(0, 3),
    "moment about the origin": slice(3, 6),
    "centre": slice(6, 9),
    "mean normal": slice(9, 12),
    "moment about the centre": slice(12, 15),
    "area": 15,
    "normal force": 16,
    "shear force": 17,
}
"""Where CF has what: force on the slave surface, its centre of gravity and mean outward normal.

Tension is positive.
"""


def read_dat(path: str | Path) -> tuple[Printed, ...]:
    """All that was printed to a ``.dat`` file, in the file's order.

    Of a solver that was killed, a last sum cut off is dropped, a last listing may be short of rows.
    """
    text = Path(path).read_text(encoding="ascii", errors="replace")
    found: list[Printed] = []
    title: re.Match | None = None
    rows: list[list[float]] = []

    for line in text[: text.rfind("\n") + 1].splitlines():
        if match := _TITLE.match(line):
            found += _printed(title, rows)
            title, rows = match, []
        elif title and (row := _numbers(line)):
            rows.append(row)

    return tuple(found + _printed(title, rows))


def _numbers(line: str) -> list[float]:
    """The numbers of a line, none where it has anything else (ccx's own sub-titles)."""
    try:
        return [float(word) for word in line.split()]
    except ValueError:
        return []


def _printed(title: re.Match | None, rows: list[list[float]]) -> list[Printed]:
    """The record of a title and its rows; none where it was cut off."""
    if title is None or not rows:
        return []
    words, name, slave, master, time = title.groups()
    quantity = _QUANTITIES.get(words, words)
    if words.startswith(("total ", "statistics")):
        values = np.array([number for row in rows for number in row])
        if len(values) != _SIZES.get(quantity, len(values)):
            return []
    else:
        values = np.array([row for row in rows if len(row) == len(rows[0])])
    return [Printed(quantity, name or (f"{slave}/{master}" if slave else ""), float(time), values)]
