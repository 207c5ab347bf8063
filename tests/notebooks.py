"""Runs the notebooks and stores them with their outputs: ``python tests/notebooks.py [NAME ...]``.

What is stored depends on nothing but the notebook: no times, no paths of a machine, pictures in few colours.
"""

from __future__ import annotations

import base64
import io
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from PIL import Image
from traitlets.config import Config

FOLDER = Path(__file__).parents[1] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))

TIMEOUT = 900
"""Seconds a cell may take, many times what it does on a machine that is idle."""

COLOURS = 128
"""Most colours of a stored picture."""

RELATIVE, ABSOLUTE = 1e-3, 1e-9
"""By how much a number of a fresh run may differ from the stored one, besides a unit of its last digit."""

_NUMBER = re.compile(r"[-+]?\d+(?:\.(\d+))?(?:e([-+]?\d+))?")


def read(path: Path) -> nbformat.NotebookNode:
    return nbformat.read(path, as_version=4)


def code_cells(notebook: nbformat.NotebookNode) -> list[nbformat.NotebookNode]:
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def executed(path: Path, folder: Path) -> nbformat.NotebookNode:
    """A notebook as run in ``folder``. Raises what nbclient raises where a cell fails."""
    notebook = read(path)
    where = {"metadata": {"path": str(folder)}}
    with tempfile.TemporaryDirectory() as sockets:
        NotebookClient(
            notebook,
            timeout=TIMEOUT,
            record_timing=False,
            resources=where,
            config=_private(sockets),
        ).execute()

    notebook.metadata = {"kernelspec": notebook.metadata["kernelspec"]}
    for cell in code_cells(notebook):
        cell.metadata = {}
        for output in cell.outputs:
            picture = output.get("data", {}).get("image/png")
            if picture is not None:
                output.data["image/png"] = smaller(picture)
    return notebook


def _private(folder: str) -> Config:
    """Has a kernel listen at sockets in a folder of this user's own, not at ports, where a system has such."""
    return Config(
        {"KernelManager": {"transport": "ipc", "ip": f"{folder}/kernel"}}
        if os.name == "posix"
        else {}
    )


def smaller(picture: str) -> str:
    """A PNG in base64 with few colours and no description of itself."""
    with Image.open(io.BytesIO(base64.b64decode(picture))) as image:
        reduced = image.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    stored = io.BytesIO()
    reduced.save(stored, "png", optimize=True)
    return base64.b64encode(stored.getvalue()).decode()


def shown(cell: nbformat.NotebookNode) -> str:
    """What stands below a cell: its texts, and for a picture that there is one."""
    parts = []
    for output in cell.outputs:
        if output.output_type == "stream":
            parts.append(f"{output.name}: {output.text}")
        elif "image/png" in output.data:
            parts.append("picture\n")
        else:
            parts.append(str(output.data.get("text/plain")))
    return "".join(parts)


def differences(stored: nbformat.NotebookNode, fresh: nbformat.NotebookNode) -> Iterator[str]:
    """Where the outputs of two runs of a notebook tell different things."""
    for number, (one, other) in enumerate(zip(code_cells(stored), code_cells(fresh)), 1):
        if not alike(shown(one), shown(other)):
            yield f"code cell {number}\nstored:\n{shown(one)}\nnow:\n{shown(other)}"


def alike(one: str, other: str) -> bool:
    """True where two texts are the same but for spaces and, within the tolerance, numbers that are not whole."""

    def words(text: str) -> list[str]:
        return _NUMBER.sub("#", text).split()

    pairs = zip(_NUMBER.finditer(one), _NUMBER.finditer(other))
    return words(one) == words(other) and all(_close(*pair) for pair in pairs)


def _close(one: re.Match, other: re.Match) -> bool:
    first, second = float(one[0]), float(other[0])
    if _is_whole(one) and _is_whole(other):
        return first == second

    digit = max(_last_digit(one), _last_digit(other))
    return abs(first - second) <= max(ABSOLUTE, RELATIVE * abs(first), 1.001 * digit)


def _is_whole(number: re.Match) -> bool:
    return number[1] is None and number[2] is None


def _last_digit(number: re.Match) -> float:
    """The worth of a unit of a number's last digit, 0 for whole numbers."""
    decimals, exponent = number[1], number[2]
    if _is_whole(number):
        return 0.0
    return 10.0 ** (int(exponent or 0) - len(decimals or ""))


def main(names: list[str]) -> None:
    for path in NOTEBOOKS:
        if names and path.stem not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            notebook = executed(path, Path(folder))
        nbformat.write(notebook, path)
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(sys.argv[1:])
