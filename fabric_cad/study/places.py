"""What stands where a study is to write: told before any of its units has run."""

from __future__ import annotations

from pathlib import Path

from ..support.errors import OutputError
from .table import NAMES

FILES = (*NAMES, "sensitivity.csv", "sensitivity.png", "sensitivity.pdf", "costs.csv")
"""Files that a study leaves."""


def check_places(folder: Path, keep: bool) -> None:
    """Raise :class:`OutputError` where a file is at a folder's place in a study's folder, or the other way round.

    ``keep`` tells that the units' files stay, in a folder ``cells``.
    """
    folders = [folder, folder / "units"] + [folder / "cells"] * keep
    for path in folders:
        if path.exists() and not path.is_dir():
            raise OutputError(f"{path}: is in the way, it is not a folder")
    for path in (folder / name for name in FILES):
        if path.is_dir():
            raise OutputError(f"{path}: is in the way, it is a folder")
