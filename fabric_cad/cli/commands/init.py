"""``fabric-cad init``: tables to start from."""

from __future__ import annotations

import shutil
from pathlib import Path

from ...support.errors import OutputError
from ..options import Command, Options
from ..voice import Voice


def run(options: Options, voice: Voice) -> int:
    """Copy what is shipped into ./families; raises :class:`OutputError` where that cannot be."""
    from ...measured.shipped import shipped_families

    target = Path("families")
    shipped = shipped_families()
    try:
        target.mkdir(exist_ok=True)
        for table in sorted([*shipped.glob("*.csv"), *shipped.glob("*.toml")]):
            voice.summary(_put(table, target))
    except OSError as error:
        place = error.filename or target
        raise OutputError(f"{place}: cannot be written: {error.strerror}") from error

    return 0


def _put(table: Path, target: Path) -> str:
    """Copy a table into a folder that does not have it, in whatever form; what became of it."""
    place = _other_form(target / table.name)
    if place.exists():
        return f"{place}: kept, it is there already"

    shutil.copyfile(table, place)
    return f"{place}: written"


def _other_form(table: Path) -> Path:
    """The file, or the workbook that holds the same table."""
    from ...measured.table_files import WORKBOOKS

    forms = [table.with_suffix(form) for form in WORKBOOKS] if table.suffix == ".csv" else []
    return next((form for form in forms if form.exists()), table)


COMMAND = Command(
    name="init",
    text="put the shipped family tables, simulation.toml, composite.toml and an example of a study into ./families "
    "(files that exist are kept)",
    options=Options,
    run=run,
)
