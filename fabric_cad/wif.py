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

import configparser
import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .errors import InputError, Problem, read_input
from .patterns import written
from .tables import MOST_YARNS, is_safe_name
from .weaves import pattern_faults

MOST_THREADS = 5000
"""Most threads a draft may have in a direction, before it is reduced to its repeat."""

_ROW = (
    "name",
    "pattern",
    *(f"weft_{quantity}" for quantity in ("density_per_mm", "width_mm", "crimp", "thickness_mm")),
    *(f"warp_{quantity}" for quantity in ("density_per_mm", "width_mm", "crimp", "thickness_mm")),
    *("fabric_thickness_mm", "section", "lateral_height_mm", "float_gap", "thicker"),
    *("weft_linear_density_tex", "warp_linear_density_tex", "fibre_density_g_cm3", "source", "notes"),
)
_TRUE, _FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")


def read_wif(path: str | Path) -> tuple[str, ...]:
    """The pattern of a draft, one text of ``1`` (over) and ``0`` (under) a weft.

    Pick 1 is weft 1, warp thread 1 is warp 1. Only the smallest repeat in either direction
    is given; a repeat divides the draft or is there twice and more. A liftplan wins over a
    treadling; under a sinking shed the shafts named go down. Raises :class:`InputError`
    with the section and key where the draft is incomplete, malformed or no weave.
    """
    draft = _Draft(str(path), _sections(Path(path)))
    warps, wefts = draft.number("warp", "threads"), draft.number("weft", "threads")
    threading = draft.lists("threading", warps)
    moved = _moved(draft, wefts)
    raised = "0" if draft.rising_shed() else "1"  # a warp raised has the weft under it
    other = "1" if raised == "0" else "0"
    rows = ["".join(raised if shafts & moves else other for shafts in threading) for moves in moved]
    pattern = _repeat(rows)
    if max(len(pattern), len(pattern[0])) > MOST_YARNS:
        size = f"{len(pattern)} wefts x {len(pattern[0])} warps"
        raise draft.wrong(f"its repeat of {size} is more than {MOST_YARNS} in a direction")
    if faults := pattern_faults(pattern):
        raise InputError([Problem(fault, draft.path) for fault in faults])
    return pattern


def wif_row(path: str | Path, name: str) -> str:
    """Header and one row of ``pattern.csv`` for a draft; what was measured is left empty.

    Raises :class:`InputError` for a name no table takes, and as :func:`read_wif` does.
    """
    if not is_safe_name(name):
        raise InputError(f"name: {name!r} is no row name: letters, digits, '_' and '-' only, not '-' first")
    text = io.StringIO()
    rows = csv.DictWriter(text, _ROW, restval="", lineterminator="\n")
    rows.writeheader()
    rows.writerow({"name": name, "pattern": written(read_wif(path))})
    return text.getvalue()


@dataclass(frozen=True)
class _Draft:
    """The sections of a draft, section names and keys in lower case."""

    path: str
    sections: dict[str, dict[str, str | None]]

    def wrong(self, message: str, section: str = "", key: str = "") -> InputError:
        place = f"[{section.upper()}] {key.title()}".strip() if section else None
        return InputError(Problem(message, self.path, column=place))

    def section(self, section: str) -> dict[str, str | None]:
        if not self.sections.get(section):
            raise self.wrong("this section is missing or empty", section)
        return self.sections[section]

    def number(self, section: str, key: str) -> int:
        """A number of threads."""
        cells = self.section(section)
        if key not in cells:
            raise self.wrong("this key is missing", section, key)
        (number, *more) = sorted(self.numbers(section, key)) or (0,)
        if more or not 1 <= number <= MOST_THREADS:
            raise self.wrong(f"{cells[key]} is not between 1 and {MOST_THREADS}", section, key)
        return number

    def numbers(self, section: str, key: str) -> frozenset[int]:
        """The numbers of one key, comma-separated; 0 and nothing at all mean none."""
        text = self.sections[section][key] or ""
        if not re.fullmatch(r"(\d{1,9}(\s*,\s*\d{1,9})*)?", text):
            raise self.wrong(f"{text!r} is not a list of whole numbers", section, key)
        return frozenset(map(int, re.findall(r"\d+", text))) - {0}

    def lists(self, section: str, count: int) -> list[frozenset[int]]:
        """The numbers of every thread 1 ... count."""
        cells = self.section(section)
        for key in cells:
            if not key.isdecimal() or not 1 <= int(key) <= count:
                raise self.wrong(f"this is no thread; the draft has {count} of them", section, key)
        missing = [number for number in range(1, count + 1) if str(number) not in cells]
        if missing:
            more = f", and {len(missing) - 1} more" if len(missing) > 1 else ""
            raise self.wrong(f"thread {missing[0]} of {count} is missing{more}", section)
        return [self.numbers(section, str(number)) for number in range(1, count + 1)]

    def rising_shed(self) -> bool:
        """True (also where the draft does not say) where the shafts named go up."""
        text = self.sections.get("weaving", {}).get("rising shed")
        if text is None:
            return True
        if text.lower() not in _TRUE + _FALSE:
            raise self.wrong(f"{text!r} is neither true nor false", "weaving", "rising shed")
        return text.lower() in _TRUE


def _sections(path: Path) -> dict[str, dict[str, str | None]]:
    """What stands in a draft's file, section by section."""
    raw = read_input(path)
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")  # only titles and notes hold more than ASCII
    parser = configparser.ConfigParser(
        delimiters="=", comment_prefixes=";", allow_no_value=True, interpolation=None, default_section=""
    )
    try:
        parser.read_string("\n".join(line.strip() for line in re.split(r"\r\n|\r|\n", text)))
    except configparser.MissingSectionHeaderError as error:
        message = "not a weaving draft: this line comes before any [SECTION]"
        raise InputError(Problem(message, str(path), error.lineno)) from error
    except configparser.DuplicateSectionError as error:
        raise InputError(Problem("this section stands twice", str(path), error.lineno, f"[{error.section}]")) from error
    except configparser.DuplicateOptionError as error:
        place = f"[{error.section}] {error.option}"
        raise InputError(Problem("this key stands twice", str(path), error.lineno, place)) from error
    except configparser.ParsingError as error:
        raise InputError(Problem("not a line of the form KEY=VALUE", str(path), error.errors[0][0])) from error
    sections = {name.lower(): dict(parser[name]) for name in parser.sections()}
    if "wif" not in sections:
        raise InputError(Problem("not a weaving draft: it has no section [WIF]", str(path)))
    return sections


def _moved(draft: _Draft, wefts: int) -> list[frozenset[int]]:
    """The shafts that move at every pick."""
    if draft.sections.get("liftplan"):
        return draft.lists("liftplan", wefts)
    if not draft.sections.get("treadling"):
        raise draft.wrong("this section is missing or empty, and there is no [LIFTPLAN]", "treadling")
    picks = draft.lists("treadling", wefts)
    ties = {key: draft.numbers("tieup", key) for key in draft.section("tieup")}
    for number, treadles in enumerate(picks, start=1):
        for treadle in sorted(treadles):
            if str(treadle) not in ties:
                raise draft.wrong(f"treadle {treadle} is not in [TIEUP]", "treadling", str(number))
    return [frozenset().union(*(ties[str(treadle)] for treadle in treadles)) for treadles in picks]


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
        if (count % period == 0 or 2 * period <= count) and yarns[period:] == yarns[: count - period]
    )
