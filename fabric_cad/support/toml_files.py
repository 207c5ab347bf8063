"""TOML files as users write them: their content, and the line of every key for what is wrong with it."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from .errors import InputError, Problem, read_input


def read_toml(path: str | Path) -> tuple[dict, dict[str, int]]:
    """Content of a TOML file, a byte-order mark passed over, and line numbers as of :func:`key_lines`.

    Raises :class:`InputError`, with the line, where it cannot be read, is not UTF-8 or not TOML.
    """
    path = Path(path)
    raw = read_input(path)
    try:
        text = raw.decode("utf-8-sig")
        return tomllib.loads(text), key_lines(text)
    except UnicodeDecodeError as error:
        raise InputError(
            Problem("not UTF-8 text", str(path), raw[: error.start].count(b"\n") + 1)
        ) from error
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"\(at line (\d+), column \d+\)", str(error))
        message = f"not TOML: {str(error).split(' (at')[0]}"
        raise InputError(Problem(message, str(path), int(found[1]) if found else None)) from error
    except RecursionError as error:
        raise InputError(
            Problem("not TOML that can be read: its brackets are nested too deeply", str(path))
        ) from error
    except ValueError as error:  # an integer of thousands of digits
        raise InputError(Problem(f"not TOML that can be read: {error}", str(path))) from error


def key_lines(text: str) -> dict[str, int]:
    """Line number of each key of a TOML text by its dotted name, tables included."""
    lines: dict[str, int] = {}
    table = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if header := re.match(r"\s*\[+\s*([^\]]+?)\s*\]", line):
            table = re.sub(r"[\s\"']", "", header[1])
            lines.setdefault(table, number)
        elif key := re.match(r"\s*([\w\-.\"']+)\s*=", line):
            name = re.sub(r"[\"']", "", key[1])
            lines.setdefault(f"{table}.{name}" if table else name, number)
    return lines
