"""What a command declares: its arguments, the frozen value they become, and what it does."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from ..support.numerals import number, whole
from .voice import Voice


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of every command: folders of the family tables and of results."""

    families: str = "families"
    out: str = "build"


@dataclass(frozen=True, kw_only=True)
class RowOptions(Options):
    """Rows a command works on one after the other: those named, or ``every`` row."""

    rows: tuple[str, ...] = ()
    every: bool = False


@dataclass(frozen=True, kw_only=True)
class MeshedRowOptions(RowOptions):
    """Rows with what the command line says of their meshes; None: nothing."""

    size: float | None = None
    across: int | None = None
    crossing: int | None = None
    through: int | None = None
    gap: int | None = None

    @property
    def mesh(self) -> dict[str, Any]:
        """What is said of the mesh, as keywords of :func:`fabric_cad.mesh_options`."""
        asked = {argument.name: getattr(self, argument.name) for argument in MESH_ARGUMENTS}
        return {name: value for name, value in asked.items() if value is not None}


AnyOptions = TypeVar("AnyOptions", bound=Options)


@dataclass(frozen=True)
class Command(Generic[AnyOptions]):
    """A command of the command line.

    ``declare`` adds its arguments to its parser; ``run`` gets what they say as ``options``,
    whose fields are called as the arguments are, and returns the exit status.
    """

    name: str
    text: str
    options: type[AnyOptions]
    run: Callable[[AnyOptions, Voice], int]
    declare: Callable[[argparse.ArgumentParser], None] = lambda _parser: None


class UsageError(Exception):
    """Arguments that cannot stand together; the command's usage is printed with the message."""


@dataclass(frozen=True)
class MeshArgument:
    """An argument for the mesh; ``default`` is what the help of ``cell`` says of its default."""

    name: str
    kind: Callable[[str], float]
    metavar: str
    text: str
    default: str = ""


MESH_ARGUMENTS = (
    MeshArgument(
        "size",
        number,
        "MM",
        "target element size in mm; numbers given below win over it",
    ),
    MeshArgument(
        "across",
        whole,
        "N",
        "elements across a weft, and along a warp's crossings",
        " (default 12)",
    ),
    MeshArgument(
        "crossing",
        whole,
        "N",
        "elements along a weft's crossings, and across a warp",
        " (default: as --across)",
    ),
    MeshArgument(
        "through",
        whole,
        "N",
        "layers through the thickness, even for lenticular sections",
        " (default 2), from 4 for round ones (default 4)",
    ),
    MeshArgument(
        "gap",
        whole,
        "N",
        "elements along the gap between crossings, even",
        " (default 4)",
    ),
)


def declare_rows(parser: argparse.ArgumentParser, with_all: bool = True) -> None:
    """Add the arguments for the rows a command works on."""
    parser.add_argument("rows", metavar="ROW", nargs="*", help="names of rows of any family table")
    if with_all:
        parser.add_argument(
            "--all",
            dest="every",
            action="store_true",
            help="every row of every family table",
        )


def declare_mesh(parser: argparse.ArgumentParser, default: str | None = None) -> None:
    """Add the arguments for the mesh; ``default`` is told in place of the defaults of a cell."""
    for argument in MESH_ARGUMENTS:
        own = argument.default if default is None or not argument.default else default
        parser.add_argument(
            f"--{argument.name}",
            type=argument.kind,
            metavar=argument.metavar,
            help=argument.text + own,
        )


def declare_deck(parser: argparse.ArgumentParser, text: str, default: str | None = None) -> None:
    """Add the argument for the dialect of a deck, one of :data:`fabric_cad.decks.keywords.DIALECTS`."""
    parser.add_argument("--deck", choices=("calculix", "abaqus"), default=default, help=text)
