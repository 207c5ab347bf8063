"""Weaving drafts (.wif, Weaving Information File 1.1) turned into rows of ``pattern.csv``.

A draft tells which shafts every warp thread hangs on and which shafts move at every pick::

              threading (warp threads)    tie-up (treadles)
    shaft 2      . x . x                     . x
    shaft 1      x . x .                     x .
              drawdown: the pattern       treadling, or a liftplan
    pick 1       u o u o                     x .        treadle 1 raises shaft 1
    pick 2       o u o u                     . x
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from ..support.errors import InputError, Problem, quoted
from ..weave.faults import pattern_faults, repeat_fault
from ..weave.patterns import written
from .columns import is_safe_name
from .drafts import MOST_THREADS, Draft, read_draft
from .setts import sett

_ROW = (
    "name",
    "pattern",
    *(f"weft_{quantity}" for quantity in ("density_per_mm", "width_mm", "crimp", "thickness_mm")),
    *(f"warp_{quantity}" for quantity in ("density_per_mm", "width_mm", "crimp", "thickness_mm")),
    *("fabric_thickness_mm", "section", "lateral_height_mm", "float_gap", "thicker"),
    *(
        "weft_linear_density_tex",
        "warp_linear_density_tex",
        "fibre_density_g_cm3",
        "source",
        "notes",
    ),
)


def read_wif(path: str | Path) -> tuple[str, ...]:
    """The pattern of a draft, one text of ``1`` (over) and ``0`` (under) a weft.

    Pick 1 is weft 1, warp thread 1 is warp 1. Only the smallest repeat in either direction
    is given; a repeat divides the draft or is there twice and more. A liftplan wins over a
    treadling; under a sinking shed the shafts named go down. Raises :class:`InputError`
    with line, section and key where the draft is incomplete, malformed or no weave.
    """
    return _pattern(read_draft(Path(path)))


def wif_row(path: str | Path, name: str) -> str:
    """Header and one row of ``pattern.csv`` for a draft.

    Spacings are densities, and a thickness below its spacing is the yarn's; a larger one is how
    programs draw threads that touch. What else was measured is left empty. Raises
    :class:`InputError` for a name no table takes, and as :func:`read_wif` does.
    """
    if not is_safe_name(name):
        raise InputError(
            f"name: {quoted(name)} is no row name: letters, digits, '_' and '-' only, not '-' first"
        )

    text = io.StringIO()
    rows = csv.DictWriter(text, _ROW, restval="", lineterminator="\n")
    rows.writeheader()
    draft = read_draft(Path(path))
    rows.writerow({"name": name, "pattern": written(_pattern(draft))} | sett(draft))

    return text.getvalue()


def _pattern(draft: Draft) -> tuple[str, ...]:
    rising = draft.flag("weaving", "rising shed") is not False
    raised, other = ("0", "1") if rising else ("1", "0")  # a warp raised has the weft under it
    threading, moved = _threading(draft, rising), _moved(draft, rising)
    _check_moved(draft, threading, frozenset().union(*moved), rising)

    rows = ["".join(raised if shafts & moves else other for shafts in threading) for moves in moved]
    pattern = _repeat(rows)
    if fault := repeat_fault(pattern):
        raise draft.wrong(fault)
    if faults := pattern_faults(pattern):
        raise InputError([Problem(fault, draft.path) for fault in faults])
    return pattern


def _threading(draft: Draft, rising: bool) -> list[frozenset[int]]:
    """The shafts of every warp thread."""
    _bounded(draft, "threading", "shaft")
    shafts = _listed(draft, "threading", "warp", "this is no thread; the draft has {} of them")
    idle = [number for number, each in enumerate(shafts, start=1) if not each]
    if idle:
        side = "under" if rising else "over"
        why = f"hangs on no shaft: warp {idle[0]} passes {side} every yarn and never interlaces"
        raise _idle(
            draft,
            "threading",
            "warp",
            idle,
            f"thread {idle[0]} of {len(shafts)} {why}",
            len(shafts),
        )

    return shafts


def _moved(draft: Draft, rising: bool) -> list[frozenset[int]]:
    """The shafts that move at every pick."""
    if any(draft.numbered("liftplan").values()):
        section = "liftplan"
        _bounded(draft, section, "shaft")
        moved = _listed(draft, section, "weft", "this is no pick; the draft has {} of them")
    else:
        section = "treadling"
        if not draft.sections.get(section):
            raise draft.wrong(
                "this section is missing or empty, and there is no [LIFTPLAN]", section
            )

        moved = _treadled(draft)

    idle = [number for number, each in enumerate(moved, start=1) if not each]
    if idle:
        side = "over" if rising else "under"
        why = f"moves no shaft: weft {idle[0]} passes {side} every yarn and never interlaces"
        raise _idle(
            draft, section, "weft", idle, f"pick {idle[0]} of {len(moved)} {why}", len(moved)
        )

    return moved


def _treadled(draft: Draft) -> list[frozenset[int]]:
    """The shafts tied to the treadles of every pick."""
    if not draft.sections.get("tieup"):
        raise draft.wrong("this section is missing or empty", "tieup")
    _bounded(draft, "treadling", "treadle")
    _bounded(draft, "tieup", "shaft")
    ties = draft.numbered("tieup")
    picks = _listed(draft, "treadling", "weft", "this is no pick; the draft has {} of them")
    for number, treadles in enumerate(picks, start=1):
        for treadle in sorted(treadles - ties.keys()):
            raise draft.wrong(
                f"treadle {treadle} is not in [TIEUP]", "treadling", draft.key("treadling", number)
            )
    return [frozenset().union(*(ties[treadle] for treadle in treadles)) for treadles in picks]


def _bounded(draft: Draft, section: str, kind: str) -> None:
    """Refuse numbers of shafts, or of treadles, beyond those [WEAVING] says the loom has (where it does)."""
    key = f"{kind}s"
    there_are = draft.count("weaving", key, MOST_THREADS)
    for number, listed in draft.numbered(section).items():
        if there_are and listed and max(listed) > there_are:
            message = f"{kind} {max(listed)} is beyond the {there_are} of [WEAVING] {key.title()}"
            raise draft.wrong(message, section, draft.key(section, number))


def _listed(draft: Draft, section: str, direction: str, beyond: str) -> list[frozenset[int]]:
    """What a section lists for every thread of a direction, nothing where it does not name one.

    Where the draft does not say how many there are, the last that has something is the last.
    """
    listed = draft.numbered(section)
    last = max((number for number, each in listed.items() if each), default=0)
    if not last:
        raise draft.wrong("this section is missing or empty", section)
    threads = draft.count(direction, "threads", MOST_THREADS) or last
    if last > threads:
        raise draft.wrong(beyond.format(threads), section, draft.key(section, last))
    if last > MOST_THREADS:
        raise draft.wrong(
            f"{last} is not between 1 and {MOST_THREADS}", section, draft.key(section, last)
        )

    return [listed.get(number, frozenset()) for number in range(1, threads + 1)]


def _idle(
    draft: Draft, section: str, direction: str, idle: list[int], message: str, threads: int
) -> InputError:
    """An error at the first thread that does nothing; where only the last ones do, the remedy."""
    if len(idle) > 1:
        message += f", nor do {len(idle) - 1} more"
    if idle == list(range(idle[0], threads + 1)):
        message += f"; write [{direction.upper()}] Threads={idle[0] - 1} if the draft ends there"
    return draft.wrong(message, section, draft.key(section, idle[0]))


def _check_moved(
    draft: Draft, threading: list[frozenset[int]], moved: frozenset[int], rising: bool
) -> None:
    """Refuse threads on shafts only that no pick moves."""
    for number, shafts in enumerate(threading, start=1):
        if not shafts & moved:
            named = ", ".join(map(str, sorted(shafts)))
            side = "under" if rising else "over"
            message = f"no pick moves shaft {named}: warp {number} passes {side} every yarn and never interlaces"
            raise draft.wrong(message, "threading", draft.key("threading", number))


def _repeat(rows: Sequence[str]) -> tuple[str, ...]:
    """The smallest repeat of a drawdown in both directions."""
    rows = rows[: _period(rows)]
    warps = _period(["".join(column) for column in zip(*rows)])
    return tuple(row[:warps] for row in rows)


def _period(yarns: Sequence[str]) -> int:
    """Yarns after which all repeats: a divisor of their number, or seen twice at least."""
    count = len(yarns)
    return next(
        period
        for period in range(1, count + 1)
        if (count % period == 0 or 2 * period <= count)
        and yarns[period:] == yarns[: count - period]
    )
