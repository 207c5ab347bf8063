"""``fabric-cad solve``: the solved family tables."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ...support.staging import staged
from ..options import Command, Options
from ..rows import raise_together, read_tables
from ..voice import Voice

if TYPE_CHECKING:
    from ...model.solved import SolvedTable


def run(options: Options, voice: Voice) -> int:
    """Write OUT/families/<family>.csv; raises :class:`InputError` with the tables left out."""
    tables = read_tables(options, voice)
    target = Path(options.out) / "families"
    with staged(target) as aside:
        for family, (_, table) in tables.solved.items():
            table.write(aside / f"{family}.csv")

    for family, (_, table) in tables.solved.items():
        voice.summary(f"{target / family}.csv: {len(table)} rows")
        for note in _notes(table):
            voice.summary(f"  {note}")

    tables.warn(voice)
    raise_together(tables.errors)
    return 0


def _notes(table: SolvedTable) -> Iterator[str]:
    """What a solved table has to say beyond its numbers."""
    columns = table.columns
    for index, name in enumerate(columns["name"]):
        if columns["other_weft_thickness_mm"][index] != "":
            weft, warp, other_weft, other_warp = (
                f"{columns[f'{which}_thickness_mm'][index]:.4g}"
                for which in ("weft", "warp", "other_weft", "other_warp")
            )
            yield (
                f"{name}: two solutions, yarns of {weft} (weft) and {warp} mm (warp), taken, "
                f"or {other_weft} and {other_warp} mm; column thicker = weft or warp chooses"
            )

        for quantity, measured, model in table.comparisons[index]:
            difference = 100 * (model - measured) / measured
            values = f"measured {measured:.4g}, model {model:.4g} ({difference:+.2f} %)"
            yield f"{name}: {quantity} {values}"


COMMAND = Command(
    name="solve",
    text="solve every row of every table into OUT/families/<family>.csv",
    options=Options,
    run=run,
)
