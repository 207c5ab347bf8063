"""The process that makes a row's cell for the page: the row as JSON on standard input, stages on standard output."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from ..cell.pipeline import Stages, make_cell
from ..support.errors import FabricCadError, InputError
from ..support.interrupts import stoppable
from .datasheet import write_datasheet
from .edited import EditedRow, Solution, answer


def main() -> int:
    """Make the cell and the datasheet; exit status as that of the command line."""
    task = json.load(sys.stdin)
    stages = Stages(_tell)
    try:
        with stoppable():
            found = answer(EditedRow(task["family"], task["cells"]))
            if not isinstance(found, Solution):
                raise InputError(found)
            make_cell(found.table, task["out"], stages=stages)
            with stages("datasheet"):
                write_datasheet(found, Path(task["out"]) / found.fabric.name)
    except FabricCadError as error:
        print(error, file=sys.stderr)
        return error.exit_status
    except KeyboardInterrupt:
        return 1

    return 0


def _tell(name: str, seconds: float | None) -> None:
    print(json.dumps([name, seconds]), flush=True)


if __name__ == "__main__":
    sys.exit(main())
