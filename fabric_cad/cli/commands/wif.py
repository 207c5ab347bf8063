"""``fabric-cad wif``: a weaving draft as a row of ``pattern.csv``."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from ..options import Command, Options
from ..voice import Voice


@dataclass(frozen=True, kw_only=True)
class WifOptions(Options):
    """The draft's file and the name of the row."""

    draft: str
    name: str


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``wif``."""
    parser.add_argument(
        "draft",
        metavar="DRAFT.wif",
        help="a draft with a tie-up and treadling, or a liftplan",
    )
    parser.add_argument("--name", required=True, metavar="NAME", help="name of the row")


def run(options: WifOptions, voice: Voice) -> int:
    """Print the row."""
    from ...measured.wif import wif_row

    voice.result(wif_row(options.draft, options.name), end="")
    return 0


COMMAND = Command(
    name="wif",
    text="print a weaving draft (.wif) as a row to paste into pattern.csv",
    options=WifOptions,
    run=run,
    declare=declare,
)
