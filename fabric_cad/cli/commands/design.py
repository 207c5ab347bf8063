"""``fabric-cad design``: a page on the loopback that draws a fabric while it is being described."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from ...support.numerals import whole
from ..options import Command, Options, RowOptions
from ..rows import find_row
from ..voice import Voice

_FIRST = "twill22"


@dataclass(frozen=True, kw_only=True)
class DesignOptions(Options):
    """The row to begin with, the port, and whether a browser is opened."""

    row: str | None = None
    port: int = 0
    browser: bool = True


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``design``."""
    parser.add_argument(
        "row", metavar="ROW", nargs="?", help=f"row to begin with (default: {_FIRST})"
    )
    parser.add_argument(
        "--port", type=whole, default=0, metavar="N", help="port (default: one that is free)"
    )
    parser.add_argument(
        "--no-browser",
        dest="browser",
        action="store_false",
        help="print the address and open no browser",
    )


def run(options: DesignOptions, voice: Voice) -> int:
    """Serve the page until it is stopped."""
    from ...page.desk import Places
    from ...page.edited import edited
    from ...page.server import Address, inside_here, open_browser, serve

    places = Places(families=inside_here(options.families), out=inside_here(options.out))
    rows = RowOptions(families=options.families, out=options.out)
    row = find_row(options.row or _FIRST, rows, voice)

    def told(address: Address) -> None:
        voice.result(address.url)
        voice.flush()
        voice.remark("the page answers this address only; Ctrl-C ends it")
        if options.browser:
            open_browser(address)

    serve(edited(row), places, options.port, told)
    return 0


COMMAND = Command(
    name="design",
    text="open a page in the browser that draws a fabric while it is being described",
    options=DesignOptions,
    run=run,
    declare=declare,
)
