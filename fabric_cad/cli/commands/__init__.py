"""The commands, one module each; a new one is a module here and its name in :func:`commands`."""

from __future__ import annotations

from typing import Any

from ..options import Command
from . import (
    cell,
    composite,
    design,
    init,
    listing,
    loads,
    page,
    permeability,
    show,
    solve,
    stiffness,
    study,
    validate,
    voxels,
    wif,
)


def commands() -> tuple[Command[Any], ...]:
    """Every command, in the order in which the help tells of them."""
    return (
        listing.COMMAND,
        solve.COMMAND,
        validate.COMMAND,
        cell.COMMAND,
        composite.COMMAND,
        *loads.load_commands(),
        stiffness.COMMAND,
        voxels.COMMAND,
        permeability.COMMAND,
        study.COMMAND,
        show.COMMAND,
        page.COMMAND,
        design.COMMAND,
        wif.COMMAND,
        init.COMMAND,
    )
