"""Whether a row's folder holds one complete result, by the digests of its report and the counts of its files."""

from __future__ import annotations

import hashlib
import json
import os
import re
from pathlib import Path


def row_files(row: str) -> set[str]:
    """Names of every file of a row's result."""
    return {f"{row}.{kind}" for kind in ("step", "msh", "inp", "vtu", "png")} | {
        "solved.csv",
        "report.json",
    }


def read_folder(folder: Path) -> dict[str, bytes]:
    """Content of a folder's files, of one folder even where another takes its name meanwhile.

    Raises FileNotFoundError where there is none, or where a file went away while it was read.
    """
    place = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        contents = {}
        for name in os.listdir(place):
            with open(os.open(name, os.O_RDONLY, dir_fd=place), "rb") as file:
                contents[name] = file.read()
        return contents
    finally:
        os.close(place)


def mixed(row: str, contents: dict[str, bytes]) -> list[str]:
    """What shows that a folder's files are not one complete result; empty where they are one."""
    wrong = []
    if missing := row_files(row) - set(contents):
        return [f"missing: {', '.join(sorted(missing))}"]
    report = json.loads(contents["report.json"])
    digests = report.get("files", {})
    for name in sorted(row_files(row) - {"report.json"}):
        if name in digests and digests[name] != hashlib.sha256(contents[name]).hexdigest():
            wrong.append(f"{name} is not the report's")
    if digests and set(digests) != set(contents) - {"report.json"}:
        wrong.append(f"the report names {sorted(digests)}, the folder has {sorted(contents)}")
    elements = deck_elements(contents[f"{row}.inp"])
    if elements != report["mesh"]["hexahedra"]:
        wrong.append(f"the deck has {elements} elements, the report {report['mesh']['hexahedra']}")
    return wrong


def deck_elements(deck: bytes) -> int:
    """Number of elements of a deck."""
    blocks = re.findall(
        rb"^\*ELEMENT\b[^\n]*\n((?:[^*\n][^\n]*\n)*)", deck, re.IGNORECASE | re.MULTILINE
    )
    return sum(block.count(b"\n") for block in blocks)
