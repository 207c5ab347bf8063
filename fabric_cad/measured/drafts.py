"""Files of weaving drafts (.wif, Weaving Information File 1.1): sections of keys, each with its line.

Drafts come from many programs and say the same in many ways. What relates to the weave and its
densities is read strictly; titles, notes, colours and sections of a program's own hold whatever
they like.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from ..support.errors import InputError, Problem, quoted, read_input

READ = (
    *("weaving", "warp", "weft", "threading", "tieup", "treadling", "liftplan"),
    *("warp spacing", "weft spacing", "warp thickness", "weft thickness"),
)
"""Sections that are read; all others are passed over."""

MOST_THREADS = 5000
"""Most threads a draft may have in a direction, before it is reduced to its repeat."""

_HEADER = re.compile(r"\[\s*([^\[\]=]+?)\s*\]\s*(;.*)?")
_TRUE, _FALSE = ("true", "yes", "on", "1"), ("false", "no", "off", "0")
_MOST_DIGITS = 9


@dataclass(frozen=True)
class Entry:
    """What stands behind a key's ``=``, without spaces at its ends, and its line in the file."""

    text: str
    line: int | None


@dataclass(frozen=True)
class Draft:
    """A draft's sections that are :data:`READ`, names and keys in lower case.

    ``lines`` has their headers.
    """

    path: str
    sections: Mapping[str, Mapping[str, Entry]]
    lines: Mapping[str, int]

    def wrong(self, message: str, section: str = "", key: str = "") -> InputError:
        """An error at a key, or at a section as a whole."""
        place = f"[{section.upper()}] {key.title()}".strip() if section else None
        entry = self.sections.get(section, {}).get(key)
        line = entry.line if entry else self.lines.get(section)
        return InputError(Problem(message, self.path, line, place))

    def entry(self, section: str, key: str) -> str:
        """The text of a key, empty where there is none."""
        entry = self.sections.get(section, {}).get(key)
        return entry.text if entry else ""

    def key(self, section: str, number: int) -> str:
        """The key of a section that is this number, however it is written.

        Empty where there is none.
        """
        return next(
            (key for key in self.sections.get(section, {}) if key.isdigit() and int(key) == number),
            "",
        )

    def count(self, section: str, key: str, most: int) -> int | None:
        """A number from 1 to ``most``; None where it is missing, empty or 0."""
        text = self.entry(section, key)
        if text and not re.fullmatch(rf"[0-9]{{1,{_MOST_DIGITS}}}", text):
            raise self.wrong(f"{quoted(text)} is not a whole number", section, key)
        number = int(text or 0)
        if number > most:
            raise self.wrong(f"{number} is not between 1 and {most}", section, key)
        return number or None

    def flag(self, section: str, key: str) -> bool | None:
        """True or False, None where the draft does not say."""
        text = self.entry(section, key).lower()
        if text not in ("", *_TRUE, *_FALSE):
            raise self.wrong(
                f"{quoted(self.entry(section, key))} is neither true nor false", section, key
            )
        return text in _TRUE if text else None

    def measure(self, section: str, key: str) -> float | None:
        """A number above 0, with a point or a decimal comma.

        None where it is missing, empty or 0.
        """
        text = self.entry(section, key)
        if text and not re.fullmatch(r"[0-9]{1,9}([.,][0-9]*)?|[.,][0-9]+", text):
            raise self.wrong(f"{quoted(text)} is not a number above 0", section, key)
        return float(text.replace(",", ".")) or None if text else None

    def numbered(self, section: str) -> dict[int, frozenset[int]]:
        """The numbers of every thread, pick or treadle that a section lists.

        0 and nothing at all mean none.
        """
        found: dict[int, frozenset[int]] = {}
        for key, entry in self.sections.get(section, {}).items():
            if not re.fullmatch(rf"[0-9]{{1,{_MOST_DIGITS}}}", key):
                raise self.wrong("this key is not a number", section, key)
            pieces = [piece.strip() for piece in entry.text.split(",")]
            if not all(re.fullmatch(rf"[0-9]{{0,{_MOST_DIGITS}}}", piece) for piece in pieces):
                raise self.wrong(
                    f"{quoted(entry.text)} is not a list of whole numbers", section, key
                )

            numbers = frozenset(int(piece) for piece in pieces if piece) - {0}
            if int(key) in found and found[int(key)] != numbers:
                raise self.wrong("this key stands twice", section, key)
            if int(key) == 0 and numbers:
                raise self.wrong("numbers count from 1", section, key)
            found[int(key)] = numbers

        return {number: numbers for number, numbers in found.items() if number}


def read_draft(path: Path) -> Draft:
    """Read the sections of a draft's file.

    Text is UTF-8, UTF-16 with its mark, or else Windows' code page 1252. Lines that start with
    ``;`` are comments. A section or key may stand twice where both say the same, or one says
    nothing. Raises :class:`InputError` with the line of what is not of this form.
    """
    sections: dict[str, dict[str, Entry]] = {}
    headers: dict[str, int] = {}
    section = None

    for line, text in _lines(path):
        if header := _HEADER.fullmatch(text):
            section = " ".join(header[1].lower().split())
            headers.setdefault(section, line)
            sections.setdefault(section, {})
        elif section is None:
            message = "not a weaving draft: this line comes before any [SECTION]"
            raise InputError(Problem(message, str(path), line))
        elif section in READ:
            _add(sections[section], text, Problem("", str(path), line, f"[{section.upper()}]"))

    if "wif" not in headers:
        raise InputError(Problem("not a weaving draft: it has no section [WIF]", str(path)))

    return Draft(str(path), {name: sections[name] for name in sections if name in READ}, headers)


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    """Number and text of the lines that hold something, without comments."""
    raw = read_input(path)
    marks = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
    try:
        text = raw.decode(marks.get(raw[:2], "utf-8-sig"))
    except UnicodeDecodeError:
        text = raw.decode("cp1252", errors="replace")  # only titles and notes hold more than ASCII
    for number, line in enumerate(re.split(r"\r\n|\r|\n", text), start=1):
        stripped = line.strip().strip("\x00\x1a")  # some programs end a file with these
        if stripped and not stripped.startswith(";"):
            yield number, stripped


def _add(entries: dict[str, Entry], text: str, place: Problem) -> None:
    """Add a line KEY=VALUE to its section; ``place`` is that line's."""
    key, equals, value = (part.strip() for part in text.partition("="))
    key, value = " ".join(key.lower().split()), re.sub(r"\s+;.*", "", value)
    if not (equals and key):
        raise InputError(
            Problem("not a line of the form KEY=VALUE", place.path, place.line, place.column)
        )
    before = entries.get(key)
    if before and before.text and value and before.text.lower() != value.lower():
        message = f"this key stands twice, at line {before.line} as {quoted(before.text)}"
        raise InputError(Problem(message, place.path, place.line, f"{place.column} {key.title()}"))
    if not (before and before.text):
        entries[key] = Entry(value, place.line)
