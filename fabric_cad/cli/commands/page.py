"""``fabric-cad page``: rows as HTML files that open without a server or network."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

from ..options import Command, RowOptions, declare_rows
from ..rows import find_row, work_on_rows
from ..voice import Voice


@dataclass(frozen=True, kw_only=True)
class PageOptions(RowOptions):
    """Rows, and whether all of them make a gallery."""

    gallery: bool = False


def declare(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of ``page``."""
    declare_rows(parser)
    parser.add_argument(
        "--gallery",
        action="store_true",
        help="every row of every family table, and an index of them, in OUT/gallery",
    )


def run(options: PageOptions, voice: Voice) -> int:
    """Write the pages of rows."""
    if options.gallery:
        return _gallery(options, voice)
    return work_on_rows(options, voice, lambda name: _page(name, options, voice))


def _page(name: str, options: PageOptions, voice: Voice) -> None:
    """Write OUT/<row>/page.html."""
    from ...cell.traces import renew_digests
    from ...page.document import fabric_page
    from ...page.edited import solution_of
    from ...support.staging import staged

    page = fabric_page(solution_of(find_row(name, options, voice)))
    folder = Path(options.out) / name
    with staged(folder, renew_digests) as aside:
        (aside / "page.html").write_text(page.text, encoding="utf-8")
    voice.files([folder / "page.html"])
    voice.flush()


def _gallery(options: PageOptions, voice: Voice) -> int:
    """Write OUT/gallery: an index and the page of every row that is a fabric."""
    from ...page.document import fabric_page, gallery_page
    from ...page.edited import solution_of
    from ...support.staging import staged
    from ..options import UsageError
    from ..rows import read_tables

    if options.rows or options.every:
        raise UsageError("--gallery is of every row; give no names and no --all")

    tables = read_tables(options, voice, partial=True)
    tables.warn(voice)
    solutions = [solution_of(row) for measured, _ in tables.solved.values() for row in measured]
    folder = Path(options.out) / "gallery"
    with staged(folder) as aside:
        for page in (gallery_page(solutions), *map(fabric_page, solutions)):
            (aside / f"{page.name}.html").write_text(page.text, encoding="utf-8")

    for error in tables.errors:
        voice.alert(str(error))
    voice.files([folder / "index.html"])
    return max([0, *(error.exit_status for error in tables.errors)])


COMMAND = Command(
    name="page",
    text="write rows as HTML files to look at without a server or network, OUT/<row>/page.html",
    options=PageOptions,
    run=run,
    declare=declare,
)
