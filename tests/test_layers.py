"""The order of the folders: each imports from those before it and from none after it."""

import ast
from pathlib import Path

import pytest

import fabric_cad

PACKAGE = Path(fabric_cad.__file__).parent

LAYERS = (
    "support",
    "weave",
    "section",
    "measured",
    "model",
    "yarn",
    "cad",
    "masters",
    "meshing",
    "decks",
    "comparison",
    "pictures",
    "cell",
    "composite",
    "flow",
    "simulation",
    "study",
    "page",
    "cli",
)
"""From the ground up: the paper's chain from a measured row to the cell under load."""

FREE = {"__init__.py", "__main__.py"}  # the facade and the start of the command see every folder

MODULES = sorted(
    path for path in PACKAGE.rglob("*.py") if path.relative_to(PACKAGE).as_posix() not in FREE
)


def imported(path):
    """The modules of this package that a module imports, anywhere in it, as parts of their names."""
    package = ("fabric_cad", *path.relative_to(PACKAGE).parts[:-1])
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (tuple(name.name.split(".")) for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = package[: len(package) - node.level + 1] if node.level else ()
            whole = (*start, *(node.module.split(".") if node.module else ()))
            yield from ((*whole, name.name) for name in node.names) if len(whole) == 1 else [whole]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_a_module_imports_nothing_of_a_folder_after_its_own(path):
    own = LAYERS.index(path.relative_to(PACKAGE).parts[0])

    later = {
        parts[1]
        for parts in imported(path)
        if parts[0] == "fabric_cad" and parts[1] in LAYERS[own + 1 :]
    }
    assert not later


def test_every_folder_has_its_place():
    folders = {
        path.parent.relative_to(PACKAGE).parts[0] for path in MODULES if path.parent != PACKAGE
    }
    assert folders == set(LAYERS)
    assert {path.name for path in PACKAGE.glob("*.py")} == FREE
