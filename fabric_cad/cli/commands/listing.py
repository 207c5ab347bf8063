"""``fabric-cad list``: every row with its model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..options import Command, Options
from ..rows import raise_together, read_tables
from ..voice import Voice

if TYPE_CHECKING:
    from ...measured.tables import Family
    from ...model.solved import SolvedTable

_HEADER = ("row", "weave", "section", "model", "identified by", "thickness mm")


def run(options: Options, voice: Voice) -> int:
    """Print a line for every row; raises :class:`InputError` with what is wrong with others."""
    tables = read_tables(options, voice, partial=True)
    lines: list[tuple[str, ...]] = [_HEADER]
    for family, (measured, table) in tables.solved.items():
        lines += _lines(family, measured, table)

    voice.table(lines)
    tables.warn(voice)
    raise_together(tables.errors)
    return 0


def _lines(family: str, measured: Family, table: SolvedTable) -> list[tuple[str, ...]]:
    """A line for every row of a table."""
    columns = table.columns
    return [
        (
            name,
            measured.weaves[index].name(family),
            columns["section"][index],
            f"{columns['parameters'][index]} parameters",
            ", ".join(["density", "width", *columns["identified_by"][index].split()]),
            f"{columns['fabric_thickness_mm'][index]:.4g}",
        )
        for index, name in enumerate(columns["name"])
    ]


COMMAND = Command(
    name="list",
    text="list every row with its weave, its model and what identifies it",
    options=Options,
    run=run,
)
