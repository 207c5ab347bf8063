"""The fields of every state, from a ``.frd`` file in text form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...support.errors import InputError, Problem
from .increments import Increment, read_sta

_WIDTH = 12  # of a number in a row of .frd
_LEAD = 13  # " -1" and the node number before it


@dataclass(frozen=True, eq=False)
class State:
    """The fields of one converged increment.

    ``time`` is the total time; ``fields`` maps ccx's name to an array (nodes, components), row i
    for node i + 1, NaN where the block has no such node: DISP (3), FORC (3), STRESS, TOSTRAIN,
    MESTRAIN (6 each, xx, yy, zz, xy, yz, zx), CONTACT (COPEN, CSLIP1, CSLIP2, CPRESS, CSHEAR1,
    CSHEAR2); units are the deck's.
    """

    step: int
    increment: int
    time: float
    fields: dict[str, np.ndarray]
    labels: dict[str, tuple[str, ...]]

    def components(self, name: str) -> tuple[str, ...]:
        """The names ccx gives to the columns of a field, e.g. ``("D1", "D2", "D3")`` of DISP."""
        return self.labels[name]


def read_frd(path: str | Path) -> tuple[State, ...]:
    """The converged states of a ``.frd`` file in text form (``*NODE FILE``, ``*EL FILE``, ``*CONTACT FILE``).

    A state left incomplete by a solver that was stopped is dropped; so is the last iterate that ccx
    adds when it gives up, if the ``.sta`` file stands beside it or other requests than U, RF were
    made. Raises InputError where the file is not a ``.frd`` of this form (binary: ``*NODE
    OUTPUT``).
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
    if attempts and not any(
        a.converged and (a.step, a.increment) == (last.step, last.increment) for a in attempts
    ):
        return False
    return (
        data.rstrip().endswith(b" 9999")
        or len(states) == 1
        or states[-2].fields.keys() <= last.fields.keys()
    )


def _node_count(data: bytes, path: Path) -> int:
    """The highest node number of the mesh in the file, 0 where the file ends before."""
    if not data.startswith(b"    1C"[: len(data)]):
        raise InputError(Problem("not a .frd file", str(path)))
    at = data.find(b"\n    2C")
    line = data.find(b"\n", at + 1)
    if at < 0 or line < 0:
        return 0
    if data[at:line].split()[-1] != b"1":
        raise InputError(
            Problem("a binary .frd file; ask for *NODE FILE instead of *NODE OUTPUT", str(path))
        )
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


def _table(
    data: bytes, start: int, rows: int, columns: int, nodes: int, path: Path
) -> np.ndarray | None:
    """Values (nodes, columns) of a block of fixed-width rows, NaN where a node is absent.

    None where cut off.
    """
    width = _LEAD + _WIDTH * columns + 1
    end = start + rows * width
    if data[end : end + 4] not in (b" -3\n", b" -3\r"):
        if len(data) < end + 4:
            return None
        raise InputError(
            Problem("rows that are not those of a .frd file written by ccx", str(path))
        )

    table = np.frombuffer(data, np.uint8, rows * width, start).reshape(rows, width)
    numbers = np.ascontiguousarray(table[:, 3:_LEAD]).view(f"S{_LEAD - 3}").astype(int).ravel()
    found = np.full((max(nodes, numbers.max(initial=0)), columns), np.nan)
    found[numbers - 1] = np.ascontiguousarray(table[:, _LEAD:-1]).view(f"S{_WIDTH}").astype(float)

    return found
