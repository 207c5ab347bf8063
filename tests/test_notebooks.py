"""Every notebook runs to its last assertion, and is stored without output."""

from pathlib import Path

import nbformat
import pytest
from jobs import needs_ccx
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


def marked(path):
    """A notebook that runs the solver is skipped without it."""
    marks = [needs_ccx] if "calculix-ccx" in path.read_text(encoding="utf-8") else []
    return pytest.param(path, id=path.stem, marks=marks)


@pytest.mark.parametrize("path", [marked(path) for path in NOTEBOOKS])
def test_a_notebook_runs(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in code)
    assert "assert" in code[-1].source
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    (tmp_path / "executed.ipynb").write_text(nbformat.writes(notebook))
