"""The commands, one module each; a new one is a module here and its name in ``COMMANDS``."""

from __future__ import annotations

from typing import Any

from ..options import Command
from . import cell, init, listing, loads, show, solve, study, validate, wif

COMMANDS: tuple[Command[Any], ...] = (
    listing.COMMAND,
    solve.COMMAND,
    validate.COMMAND,
    cell.COMMAND,
    loads.TENSION,
    loads.SHEAR,
    study.COMMAND,
    show.COMMAND,
    wif.COMMAND,
    init.COMMAND,
)
"""In the order in which the help tells of them."""
