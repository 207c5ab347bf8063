"""Lines of a table as texts, whatever the file: what the CSV and the workbook reader hand to the rules of a row."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..support.errors import InputError, Place, read_input


@dataclass(frozen=True)
class Record:
    """One line that holds something: its number from 1 and the texts of its cells.

    A workbook knows more of its cells, by their number from 0: ``faults`` tells what is no text and
    no number, ``merged`` what lies in another cell's area; ``numbers`` were entered as numbers, and
    ``percents`` are shown as percentages.
    """

    line: int | None
    cells: tuple[str, ...]
    faults: Mapping[int, str] = field(default_factory=dict)
    merged: Mapping[int, str] = field(default_factory=dict)
    numbers: frozenset[int] = frozenset()
    percents: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Records:
    """Where a table stands, its lines, header first, and what separates its cells (nothing in a workbook)."""

    place: Place
    lines: tuple[Record, ...]
    separator: str = ""


_MARKS = (  # a text file's byte-order mark, its encoding, the encoding's name; UTF-32's begins as UTF-16's
    (b"\xff\xfe\x00\x00", "utf-32"),
    (b"\x00\x00\xfe\xff", "utf-32"),
    (b"\xff\xfe", "utf-16"),
    (b"\xfe\xff", "utf-16"),
)
_BINARIES = {
    b"PK\x03\x04": "this is a workbook (or another archive), not a text table; name it .xlsx or .ods",
    b"\xd0\xcf\x11\xe0": "this is an old or an encrypted workbook, not a text table; save it as 'CSV UTF-8' or .xlsx",
}


def read_csv(path: Path) -> Records:
    """A text table: separated by ``,``, ``;`` or tab, in UTF-8 or, with a byte-order mark, UTF-16 or UTF-32.

    Blank lines and comments (``#``) are passed over. Raises :class:`InputError` where the file
    cannot be read, is no text in these encodings, or holds a line that is no CSV.
    """
    place = Place(str(path))
    lines = re.split(r"\r\n|\r|\n", _text(place, read_input(path)))
    # comments are blanked, not dropped, so that line numbers stay those of the file
    lines = ["" if line.lstrip().startswith("#") else line for line in lines]

    first = next((line for line in lines if line.strip()), "")
    if hint := re.fullmatch(r"\s*\"?sep=(.)\"?[;,\t]*\s*", first, re.IGNORECASE):  # Excel's own
        separator = hint[1]
        lines[lines.index(first)] = ""
    else:
        separator = next((s for s in ";\t" if s in first), ",")

    return Records(place, tuple(_csv_records(place, lines, separator)), separator)


def _text(place: Place, raw: bytes) -> str:
    """The text of a file's bytes."""
    for start, message in _BINARIES.items():
        if raw.startswith(start):
            raise InputError(place.problem(message))

    encoding = next((encoding for mark, encoding in _MARKS if raw.startswith(mark)), "utf-8-sig")
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError as error:
        name = encoding.upper().removesuffix("-SIG")
        line = raw[: error.start].count(b"\n") + 1
        raise InputError(
            place.problem(f"not {name} text; save the table as 'CSV UTF-8'", line)
        ) from error

    if "\0" in text:
        line = len(re.findall(r"\r\n|\r|\n", text[: text.index("\0")])) + 1
        message = "this line holds a NUL character, which no text table does; save the table as 'CSV UTF-8'"
        raise InputError(place.problem(message, line))

    return text


def _csv_records(place: Place, lines: list[str], separator: str) -> Iterator[Record]:
    try:
        # ended again, so that line breaks inside a quoted cell stay
        reader = csv.reader(
            (line + "\n" for line in lines), delimiter=separator, skipinitialspace=True
        )
    except (TypeError, ValueError) as error:
        raise InputError(
            place.problem(f"sep={separator!r} names no separator: {error}", 1)
        ) from error

    line = 1
    try:
        for texts in reader:
            cells = tuple(text.strip() for text in texts)
            if any(cells) and not cells[0].startswith("#"):
                yield Record(line, cells)
            line = reader.line_num + 1
    except csv.Error as error:
        raise InputError(place.problem(f"not a CSV line: {error}", reader.line_num)) from error
