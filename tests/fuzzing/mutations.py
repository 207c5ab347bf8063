"""Small harm done to texts, bytes and cells, as editors, spreadsheets, disks and people do it."""

from __future__ import annotations

import gzip
from collections.abc import Callable

import numpy as np

ODD_TEXTS = (
    *(
        "",
        " ",
        "nan",
        "NaN",
        "inf",
        "-inf",
        "Infinity",
        "1e400",
        "1e-320",
        "1e308",
        "-0",
        "0",
        "0.0",
        "-2.4",
        "1e",
    ),
    *(
        "1,5",
        "1.5.5",
        "1_000",
        "0x10",
        "1e5",
        "2.4 mm",
        "1/2",
        "10/01",
        "10-Jan",
        "--",
        "+-1",
        ".",
        "e5",
        "5e-324",
    ),
    *("٠٫٤", "١٢٣", "２．４", "²", "½", "Ⅷ", "௧௨", "३"),  # digits of other scripts
    *(
        "=1+1",
        '=HYPERLINK("http://x";"y")',
        "@SUM(1)",
        "+cmd|' /C calc'!A0",
        "-1+1",
        "#REF!",
        "#NUM!",
        "#DIV/0!",
    ),
    *(
        "\x00",
        "a\x00b",
        "\x1b[31mred\x1b[0m",
        "\x1b]0;title\x07",
        "\r",
        "\x08\x08\x08",
        "\x7f",
        "\x85",
        "\x9b31m",
    ),
    *(
        "\u202e0.4",
        "\ufeff2.4",
        "\u20282.4",
        "\u00a00.4",
        "0.4\u200b",
        "🧵",
        "é",
        "\ufffd",
        "\U0010ffff",
    ),
    *(
        "True",
        "false",
        "None",
        "null",
        "[]",
        "{}",
        "../../etc/passwd",
        "con",
        "..",
        "/",
        "~",
        "$HOME",
        "%s%n",
        "{0}",
    ),
    *(
        '"',
        '""',
        "'",
        ";",
        ",",
        "\t",
        "x\ny",
        "#",
        "# no",
        "a" * 300,
        "9" * 400,
        "0." + "3" * 5000,
        "-" * 200,
    ),
    *(
        "twill",
        "plain",
        "warp",
        "weft",
        "round",
        "flat",
        "lenticular",
        "symmetric",
        "oouu/uuoo",
        "o",
        "1",
        "100",
        "101",
    ),
)
ODD_NUMBERS = (
    "0",
    "1",
    "2",
    "3",
    "7",
    "99",
    "100",
    "1e-9",
    "1e9",
    "0.5",
    "0.999999",
    "4.0",
    "0.001",
    "1e15",
    "0.3",
)


def pick(rng: np.random.Generator, choices):
    """One of a sequence."""
    return choices[int(rng.integers(len(choices)))]


def spoil_cells(rng: np.random.Generator, rows: list[list[str]]) -> list[list[str]]:
    """A table (rows of cells, header first) with one to three things wrong or odd in it."""
    rows = [list(row) for row in rows]
    for _ in range(int(rng.integers(1, 4))):
        pick(rng, _ON_CELLS)(rng, rows)
        rows = rows or [[""]]
    return rows


def _odd_cell(rng, rows) -> None:
    row = pick(rng, rows[1:] or rows)
    if row:
        row[int(rng.integers(len(row)))] = pick(
            rng, ODD_TEXTS if rng.random() < 0.7 else ODD_NUMBERS
        )


def _odd_head(rng, rows) -> None:
    if rows[0]:
        column = int(rng.integers(len(rows[0])))
        name = rows[0][column]
        rows[0][column] = pick(
            rng,
            (name.upper(), name[:-1], name + " ", name + "_std", name + "x", pick(rng, ODD_TEXTS)),
        )


def _scaled(rng, rows) -> None:
    row = pick(rng, rows[1:] or rows)
    numbers = [
        column
        for column, cell in enumerate(row)
        if cell.replace(".", "", 1).isdigit() and cell.isascii()
    ]
    if numbers:
        column = pick(rng, numbers)
        row[column] = repr(float(row[column]) * float(10 ** rng.uniform(-6, 6)))


def _columns_swapped(rng, rows) -> None:
    one, other = rng.integers(max(map(len, rows)), size=2)
    for row in rows[int(rng.integers(2)) :]:
        if max(one, other) < len(row):
            row[one], row[other] = row[other], row[one]


def _column_dropped(rng, rows) -> None:
    column = int(rng.integers(max(map(len, rows))))
    for row in rows[int(rng.integers(2)) :]:
        del row[column : column + 1]


def _column_doubled(rng, rows) -> None:
    column = int(rng.integers(max(map(len, rows))))
    for row in rows[int(rng.integers(2)) :]:
        row[column:column] = row[column : column + 1]


def _row_dropped(rng, rows) -> None:
    del rows[int(rng.integers(len(rows)))]


def _row_doubled(rng, rows) -> None:
    rows.insert(int(rng.integers(len(rows) + 1)), list(pick(rng, rows)))


def _row_cut(rng, rows) -> None:
    row = pick(rng, rows)
    del row[int(rng.integers(len(row) + 1)) :]


def _cells_added(rng, rows) -> None:
    pick(rng, rows).extend(["", pick(rng, ODD_TEXTS)][: int(rng.integers(1, 3))])


def _rows_many(rng, rows) -> None:
    rows.extend([list(pick(rng, rows)) for _ in range(int(rng.integers(100, 400)))])


_ON_CELLS: tuple[Callable, ...] = (
    *(4 * [_odd_cell] + 2 * [_scaled] + [_odd_head]),
    *(
        _columns_swapped,
        _column_dropped,
        _column_doubled,
        _row_dropped,
        _row_doubled,
        _row_cut,
        _cells_added,
        _rows_many,
    ),
)


def spoil_text(rng: np.random.Generator, text: str) -> str:
    """A text with a line, a mark or a run of marks changed."""
    lines = text.split("\n")
    here, there = (int(rng.integers(len(lines))) for _ in range(2))
    place = int(rng.integers(len(text) + 1))
    odd = pick(rng, ODD_TEXTS)
    kind = int(rng.integers(12))
    if kind == 0:
        lines[here], lines[there] = lines[there], lines[here]
    elif kind == 1:
        del lines[here]
    elif kind == 2:
        lines.insert(there, lines[here])
    elif kind == 3:
        lines[here] = odd
    elif kind == 4:
        lines[here] += odd
    elif kind == 5:
        lines[here] = (
            pick(rng, ("  ", "\t", "#", "\ufeff", '"', "[", ";", "sep=;\n", "=")) + lines[here]
        )
    elif kind == 6:
        return text[:place] + odd + text[place:]
    elif kind == 7:
        return text[:place] + text[place + int(rng.integers(1, 40)) :]
    elif kind == 8:
        return text.replace(
            pick(rng, (",", ".", "=", '"', "\n", "_", " ", "[", "/", "e")),
            pick(rng, (";", "\t", ",", "", "\r", "\x0b", "|")),
        )
    elif kind == 9:
        return text.replace("\n", pick(rng, ("\r\n", "\r", "\n\n", "\x0c\n", "\x85", "\u2028")))
    elif kind == 10:
        return text[:place]
    else:
        return text[:place] + text[place : place + 1] * int(rng.integers(2, 5000)) + text[place:]
    return "\n".join(lines)


def spoil_bytes(rng: np.random.Generator, content: bytes) -> bytes:
    """Bytes flipped, cut, put in, repeated, or packed."""
    place = int(rng.integers(len(content) + 1))
    kind = int(rng.integers(9))
    if kind == 0:
        spoilt = bytearray(content)
        for where in rng.integers(max(len(content), 1), size=int(rng.integers(1, 10))):
            spoilt[where : where + 1] = bytes([int(rng.integers(256))])
        return bytes(spoilt)
    if kind == 1:
        return content[:place]
    if kind == 2:
        return content[place:]
    if kind == 3:
        return content[:place] + bytes(int(rng.integers(1, 100))) + content[place:]
    if kind == 4:
        return content[:place] + rng.bytes(int(rng.integers(1, 60))) + content[place:]
    if kind == 5:
        return rng.bytes(int(rng.integers(2000)))
    if kind == 6:
        return content * int(rng.integers(2, 20))
    if kind == 7:
        return gzip.compress(content, mtime=0)
    return bytes(len(content))


ENCODINGS = (
    "utf-16",
    "utf-16-le",
    "utf-16-be",
    "utf-32",
    "latin-1",
    "cp1252",
    "cp037",
    "utf-8-sig",
    "utf-7",
    "shift_jis",
)


def encoded(rng: np.random.Generator, text: str) -> bytes:
    """A text in UTF-8, or now and then in another encoding."""
    encoding = pick(rng, ENCODINGS) if rng.random() < 0.15 else "utf-8"
    return text.encode(encoding, errors="replace")
