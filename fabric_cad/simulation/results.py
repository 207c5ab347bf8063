"""What CalculiX wrote, as arrays: ``.frd`` (fields), ``.dat`` (printed sums), ``.sta`` (increments).

Our own reader, because ccx2paraview is GPL and pyvista-frd-reader, as fast, knows neither steps nor diverged frames.

Times. Both ``.frd`` and ``.dat`` count the total time, which runs on from step to step (two steps of 1
and 2 end at 1 and 3); only ``.sta`` has the time within the step beside it. ``.frd`` rounds it to six
digits below 1, so match states and prints with a tolerance, or by their order.

Fields. Nodal values in the global axes, the mean over the elements that share the node. Tensors have the
order xx, yy, zz, xy, yz, zx (``.dat`` prints xx, yy, zz, xy, xz, yz, and in the element's own axes
where it has an orientation, unless told ``GLOBAL=YES``). Shear strains are tensor components, half the
angle. Under NLGEOM, STRESS is Cauchy's and TOSTRAIN Green's. ccx carries stress and strain from the
integration points of a C3D8 to its nodes with coefficients rounded to four digits: a uniform field comes
out 4e-5 of its value too small (DISP, FORC and the sums of the ``.dat`` do not).

Contact. Face-to-face contact fills in CONTACT for the slave surface; every other node has zeros.

Sums. RF of a node tied by an equation is the force of the elements at that node, dependent or not, so a
face keeps its sum; RF of a node that only equations know (a reference node) prints 0.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..support.errors import InputError, Problem

_WIDTH = 12  # of a number in a row of .frd
_LEAD = 13  # " -1" and the node number before it


@dataclass(frozen=True)
class Increment:
    """One attempt at an increment, converged or not; times in the unit of the deck.

    ``step``, ``increment`` and ``attempt`` count from 1; ``step_time`` and ``total_time`` are those
    reached, for an attempt that failed those it set out from; ``size`` is the time it covers.
    """

    step: int
    increment: int
    attempt: int
    iterations: int
    converged: bool
    total_time: float
    step_time: float
    size: float


@dataclass(frozen=True, eq=False)
class State:
    """The fields of one converged increment.

    ``time`` is the total time; ``fields`` maps ccx's name to an array (nodes, components), row i for node i + 1,
    NaN where the block has no such node: DISP (3), FORC (3), STRESS, TOSTRAIN, MESTRAIN (6 each, xx, yy,
    zz, xy, yz, zx), CONTACT (COPEN, CSLIP1, CSLIP2, CPRESS, CSHEAR1, CSHEAR2); units are the deck's.
    """

    step: int
    increment: int
    time: float
    fields: dict[str, np.ndarray]
    labels: dict[str, tuple[str, ...]]

    def components(self, name: str) -> tuple[str, ...]:
        """The names ccx gives to the columns of a field, e.g. ``("D1", "D2", "D3")`` of DISP."""
        return self.labels[name]


@dataclass(frozen=True, eq=False)
class Printed:
    """One print request at one increment.

    ``quantity`` is the key asked for where this module knows its title (RF, U, ELSE, EVOL, CELS, CNUM, CF),
    else the title as printed. ``name`` is the set in upper case (as ccx keeps it), "" without a set,
    ``SLAVE/MASTER`` for CF. ``time`` is the total time. ``values``: of a sum (``TOTALS=ONLY``) the row of
    numbers, (3,) for RF, (1,) for ELSE, EVOL, CELS, CNUM; of a listing (rows, 1 + components), the node
    or element number first; of CF (18,), see :data:`CONTACT_FORCE`.
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
"""Where CF has what: force on the slave surface, its centre of gravity and mean outward normal; tension positive."""


def read_sta(path: str | Path) -> tuple[Increment, ...]:
    """Every attempt listed in a ``.sta`` file, also one still being written; none where there is no file."""
    try:
        text = Path(path).read_text(encoding="ascii", errors="replace")
    except FileNotFoundError:
        return ()
    rows = (line.split() for line in text[: text.rfind("\n") + 1].splitlines())
    return tuple(_attempt(row) for row in rows if len(row) == 7 and row[0].isdigit())


def _attempt(row: list[str]) -> Increment:
    """A row of .sta; the attempts that failed carry a U."""
    step, increment, iterations = int(row[0]), int(row[1]), int(row[3])
    return Increment(step, increment, int(row[2].rstrip("U")), iterations, "U" not in row[2], *map(float, row[4:]))


def read_frd(path: str | Path) -> tuple[State, ...]:
    """The converged states of a ``.frd`` file in text form (``*NODE FILE``, ``*EL FILE``, ``*CONTACT FILE``).

    A state left incomplete by a solver that was stopped is dropped; so is the last iterate that ccx adds
    when it gives up, if the ``.sta`` file stands beside it or other requests than U, RF were made.
    Raises InputError where the file is not a ``.frd`` of this form (binary: ``*NODE OUTPUT``).
    """
    path = Path(path)
    data = path.read_bytes()
    nodes = _node_count(data, path)
    states: list[State] = []
    for step, increment, time, name, labels, values in _blocks(data, nodes, path):
        if not states or (states[-1].step, states[-1].increment) != (step, increment):
            states.append(State(step, increment, time, {}, {}))
        states[-1].fields[name] = values
        states[-1].labels[name] = labels
    if states and not _whole(states, data, read_sta(path.with_suffix(".sta"))):
        states.pop()
    return tuple(states)


def _whole(states: list[State], data: bytes, attempts: tuple[Increment, ...]) -> bool:
    """Whether the last state converged and was written to its end (a finished job ends with 9999)."""
    last = states[-1]
    if attempts and not any(a.converged and (a.step, a.increment) == (last.step, last.increment) for a in attempts):
        return False
    return data.rstrip().endswith(b" 9999") or len(states) == 1 or states[-2].fields.keys() <= last.fields.keys()


def _node_count(data: bytes, path: Path) -> int:
    """The highest node number of the mesh in the file, 0 where the file ends before."""
    if not data.startswith(b"    1C"[: len(data)]):
        raise InputError(Problem("not a .frd file", str(path)))
    at = data.find(b"\n    2C")
    line = data.find(b"\n", at + 1)
    if at < 0 or line < 0:
        return 0
    if data[at:line].split()[-1] != b"1":
        raise InputError(Problem("a binary .frd file; ask for *NODE FILE instead of *NODE OUTPUT", str(path)))
    end = data.find(b"\n -3", at)
    last = data.rfind(b"\n -1", at, max(end, 0))
    return int(data[last + 4 : last + 14]) if last > 0 else 0


def _blocks(data: bytes, nodes: int, path: Path) -> Iterator[tuple]:
    """Step, increment, time, field name, component names and values of every complete block."""
    at = -1
    while (at := data.find(b"\n    1PSTEP", at + 1)) >= 0:
        start = data.find(b"\n -1", at)
        head = data[at + 1 : start].decode("ascii", "replace").splitlines()
        if start < 0 or len(head) < 4 or not head[2].startswith(" -4"):
            return
        increment, step = map(int, head[0].split()[2:4])
        time, rows = float(head[1][12:24]), int(head[1][24:36])
        labels = tuple(line[5:13].strip() for line in head[3:] if line[33:38].strip() != "1")
        values = _table(data, start + 1, rows, len(labels), nodes, path)
        if values is None:
            return
        yield step, increment, time, head[2][5:13].strip(), labels, values


def _table(data: bytes, start: int, rows: int, columns: int, nodes: int, path: Path) -> np.ndarray | None:
    """Values (nodes, columns) of a block of fixed-width rows, NaN where a node is absent; None where cut off."""
    width = _LEAD + _WIDTH * columns + 1
    end = start + rows * width
    if data[end : end + 4] not in (b" -3\n", b" -3\r"):
        if len(data) < end + 4:
            return None
        raise InputError(Problem("rows that are not those of a .frd file written by ccx", str(path)))
    table = np.frombuffer(data, np.uint8, rows * width, start).reshape(rows, width)
    numbers = np.ascontiguousarray(table[:, 3:_LEAD]).view(f"S{_LEAD - 3}").astype(int).ravel()
    found = np.full((max(nodes, numbers.max(initial=0)), columns), np.nan)
    found[numbers - 1] = np.ascontiguousarray(table[:, _LEAD:-1]).view(f"S{_WIDTH}").astype(float)
    return found


_TITLE = re.compile(r"^ (\S.*?) for (?:set (\S+) and |slave set (\S+), master set (\S+) and )?time +(\S+)\s*$")
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


def read_dat(path: str | Path) -> tuple[Printed, ...]:
    """All that was printed to a ``.dat`` file, in the file's order.

    Of a solver that was killed, a last sum cut off is dropped, a last listing may be short of rows.
    """
    text = Path(path).read_text(encoding="ascii", errors="replace")
    found: list[Printed] = []
    title, rows = None, []
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
