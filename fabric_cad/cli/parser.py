"""The command line: every command's arguments, put together and read."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any, NoReturn

from .. import __version__
from ..support.errors import did_you_mean
from .commands import commands
from .options import Command, Options
from .terminal import complain, say

_DESCRIPTION = """\
From a few numbers measured on a woven fabric to a CAD model and a hexahedral mesh of its
elementary cell, in which the yarns touch exactly where they should and never run into each other.

Fabrics are rows of the family tables plain.csv, twill.csv, satin.csv and, for any other weave,
pattern.csv (lengths in mm): yarn density and width, and crimps or thicknesses. 'fabric-cad init'
puts tables to start from into ./families.
"""
_EPILOG = """\
exit status: 0 done, 2 bad input or usage, 1 anything else; \
of several rows the highest of theirs"""


@dataclass(frozen=True)
class Request:
    """What a command line asks for; ``refuse`` ends it with the usage and a message."""

    command: Command[Any]
    options: Options
    quiet: bool
    refuse: Callable[[str], NoReturn]


def read_request(arguments: Sequence[str] | None) -> Request:
    """Read a command line (None: that of the process); ends with its help, or on wrong usage."""
    parsed = vars(_parser().parse_args(arguments))
    command = parsed["asked"]

    names = [field.name for field in fields(command.options) if field.name in parsed]
    values = {name: _frozen(parsed[name]) for name in names}

    options = command.options(**values)
    return Request(command, options, parsed.get("quiet", False), parsed["refuse"])


def _frozen(value: object) -> object:
    return tuple(value) if isinstance(value, list) else value


class _Parser(argparse.ArgumentParser):
    """A parser that names the nearest known word where it does not know one."""

    known: set[str] = set()
    """Every option of every command."""

    def add_argument(self, *names, **more):
        self.known.update(name for name in names if name.startswith("--"))
        return super().add_argument(*names, **more)

    def _print_message(self, message: str, file=None) -> None:
        """As the one of argparse, which takes a help that is lost for one that was read."""
        if message:
            say(message, end="") if file is sys.stdout else complain(message, end="")

    def error(self, message: str) -> NoReturn:
        if wrong := re.search(r"invalid choice: '([^']*)' \(choose from (.*)\)", message):
            message += did_you_mean(wrong[1], re.findall(r"[\w-]+", wrong[2]))
        elif wrong := re.match(r"unrecognized arguments: (--[^\s=]+)", message):
            message += did_you_mean(wrong[1], self.known)
        super().error(message)


def _parser() -> argparse.ArgumentParser:
    """The parser of all commands; common options may stand before and after their names."""
    common = _common_options()
    parser = _Parser(
        prog="fabric-cad",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        parents=[common],
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"fabric-cad {__version__}")
    adder = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)

    for command in commands():
        added = adder.add_parser(
            command.name,
            parents=[common],
            help=command.text,
            description=command.text,
            epilog=_EPILOG,
        )
        command.declare(added)
        added.set_defaults(asked=command, refuse=added.error)

    return parser


def _common_options() -> _Parser:
    common = _Parser(add_help=False)
    common.add_argument(
        "--families",
        metavar="DIR",
        default=argparse.SUPPRESS,
        help="folder of the family tables (default: families)",
    )
    common.add_argument(
        "--out",
        metavar="DIR",
        default=argparse.SUPPRESS,
        help="folder for results (default: build)",
    )
    common.add_argument(
        "-q",
        "--quiet",
        action="store_true",
        default=argparse.SUPPRESS,
        help="no progress, notes and summaries of what files hold: only what list, validate and "
        "wif exist to print, warnings and errors",
    )

    return common
