"""The command ``fabric-cad``: exit statuses, errors and interrupts."""

from __future__ import annotations

import os
from collections.abc import Sequence

from ..support.errors import OutputError
from ..support.interrupts import stoppable
from ..support.staging import commits
from . import terminal
from .failures import told
from .options import UsageError
from .parser import read_request
from .terminal import complain
from .voice import Voice


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit status."""
    try:
        return _main(arguments)
    except KeyboardInterrupt:  # once more while the first was told, or when all had been said
        complain("\nstopped")
        return 1


def _main(arguments: Sequence[str] | None) -> int:
    """Run the command and tell what goes wrong, also with standard output itself."""
    terminal.prepare()
    with stoppable(), commits() as done:
        try:
            status = _run(arguments)
        except SystemExit as end:  # --help, --version and wrong usage
            if lost := terminal.finish():
                complain(lost)
                raise SystemExit(1) from end

            raise
        except BrokenPipeError:
            status = 1
        except BaseException as error:
            status, sentence = told(error, done)
            complain(sentence)

    lost = terminal.finish()
    if lost:
        complain(lost)
    return status if lost is None else status or 1


def _run(arguments: Sequence[str] | None) -> int:
    """Read the command line and run what it asks for."""
    request = read_request(arguments)
    try:
        os.getcwd()
    except OSError as error:
        gone = "the current folder is gone (deleted, or moved away)"
        raise OutputError(f"{gone}; change to one that is there") from error

    try:
        return request.command.run(request.options, Voice(request.quiet))
    except UsageError as error:
        request.refuse(str(error))
