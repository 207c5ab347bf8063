"""Where a result comes from: version, date, options, the row as it was read, and a digest of every file."""

from __future__ import annotations

import hashlib
import json
import os
from dataclasses import asdict
from datetime import datetime
from pathlib import Path

import numpy as np

from .. import __version__
from ..measured.columns import WEAVE_COLUMNS
from ..measured.tables import Family
from ..meshing.options import MeshOptions

REPORT = "report.json"


def trace(row: Family, options: MeshOptions | None) -> dict:
    """What made a result, for its report: ``version``, ``date`` (ISO 8601 with zone), ``options``, ``measured``.

    ``row`` is a table of one row, ``options`` those of the mesh, None where there is none.
    """
    return {
        "version": __version__,
        "date": datetime.now().astimezone().isoformat(timespec="seconds"),
        "options": {} if options is None else asdict(options),
        "measured": measured_cells(row),
    }


def measured_cells(row: Family) -> dict[str, object]:
    """Column to value of what a table of one row gives, in the units that are kept (mm, 1/mm, tex, g/cm3, ratio)."""
    weave = row.weaves[0]
    interlacement = {
        "over": weave.over,
        "under": weave.under,
        "harness": weave.over + weave.under,
        "step": weave.step,
        "pattern": " ".join(weave.pattern),
    }
    numbers = {column: float(values[0]) for column, values in row.measured.items()}
    numbers |= {f"{column}_std": float(values[0]) for column, values in row.scatter.items()}
    texts = {
        "section": row.sections[0],
        "thicker": row.thicker[0],
        "source": row.sources[0],
        "notes": row.notes[0],
    }

    return {
        "name": row.names[0],
        **({} if row.lines[0] is None else {"table": f"{row.place.path}:{row.lines[0]}"}),
        **{column: interlacement[column] for column in WEAVE_COLUMNS[row.family]},
        **{column: value for column, value in numbers.items() if not np.isnan(value)},
        **{column: text for column, text in texts.items() if text or column == "source"},
    }


def file_digests(folder: Path, without: str) -> dict[str, str]:
    """Name to SHA-256 of every file of a folder but one.

    Of files that cannot be read there is none.
    """
    digests = {}
    for path in sorted(folder.iterdir()):
        if path.name == without or not path.is_file():
            continue
        try:
            with open(path, "rb") as file:
                digests[path.name] = hashlib.file_digest(file, "sha256").hexdigest()
        except PermissionError:
            continue
    return digests


def write_traced(report: dict, path: Path) -> None:
    """Write a report, with the digests of all other files of its folder under ``files``, which ``report`` takes."""
    report["files"] = file_digests(path.parent, path.name)
    written = path.with_name(f".{path.name}.written")
    written.write_text(json.dumps(report, indent=2) + "\n", encoding="utf-8")
    os.replace(written, path)  # never into a file that stays as it is in another folder


def renew_digests(folder: Path) -> None:
    """Bring the digests in a folder's ``report.json``, if there is one, up to the files beside it."""
    try:
        report = json.loads((folder / REPORT).read_text(encoding="utf-8"))
        traced = isinstance(report["files"], dict)
    except (OSError, ValueError, KeyError, TypeError):
        return
    if traced:
        write_traced(report, folder / REPORT)
