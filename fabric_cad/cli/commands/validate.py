"""``fabric-cad validate``: the model against what rows measure beyond need."""

from __future__ import annotations

from ...support.errors import InputError, Problem
from ..options import Command, Options
from ..rows import raise_together, read_tables
from ..voice import Voice

Lines = list[tuple[str, ...]]


def run(options: Options, voice: Voice) -> int:
    """Print comparisons and scatter; raises :class:`InputError` with what is wrong with tables."""
    from ...model.scatter import doubts, propagate
    from ...model.validation import compared, spread_out

    tables = read_tables(options, voice)
    errors = list(tables.errors)
    comparisons: Lines = []
    spreads: Lines = []
    notes: list[Problem] = []
    differences: list[float] = []  # %

    for measured, table in tables.solved.values():
        try:
            spread = propagate(measured, table)
        except InputError as error:
            errors.append(error)
            continue

        comparisons += compared(measured, table, spread)
        spreads += spread_out(measured, spread)
        notes += doubts(measured, table)
        for row in table.comparisons:
            differences += [100 * abs(model / value - 1) for _, value, model in row]

    _print_comparisons(voice, comparisons, differences)
    voice.result()
    _print_spreads(voice, spreads)
    for note in notes:
        voice.result(f"note: {note}")

    tables.warn(voice)
    raise_together(errors)
    return 0


def _print_comparisons(voice: Voice, comparisons: Lines, differences: list[float]) -> None:
    if not comparisons:
        voice.result(
            "no row measures more than what identifies it: nothing to compare with the model"
        )
        return

    voice.table([("row", "quantity", "measured", "model", "difference %"), *comparisons])
    largest = max(differences)
    voice.result(f"{len(differences)} comparisons, the largest difference {largest:.2f} %")


def _print_spreads(voice: Voice, spreads: Lines) -> None:
    if spreads:
        voice.table([("row", "identified", "weft", "warp"), *spreads])
    else:
        voice.result("no row gives a standard deviation (columns *_std): none to propagate")


COMMAND = Command(
    name="validate",
    text="compare what rows measure beyond need with the model; propagate their *_std columns",
    options=Options,
    run=run,
)
