"""Every notebook runs to its last assertion, and what is stored below its cells is what it gives."""

import nbformat
import pytest
from jobs import needs_ccx

from notebooks import NOTEBOOKS, alike, code_cells, differences, executed, read, shown


def marked(path):
    """A notebook that runs the solver is skipped without it."""
    marks = [needs_ccx] if "calculix-ccx" in path.read_text(encoding="utf-8") else []
    return pytest.param(path, id=path.stem, marks=marks)


@pytest.mark.parametrize("path", [marked(path) for path in NOTEBOOKS])
def test_a_notebook_runs_and_gives_what_is_stored(path, tmp_path):
    assert list(differences(read(path), executed(path, tmp_path))) == []


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_with_its_outputs(path):
    code = code_cells(read(path))
    assert "assert" in code[-1].source
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))

    told = "".join(map(shown, code))
    assert "picture" in told
    assert not any(
        word in told for word in ("stderr: ", "seconds", "/tmp", "/home", "/root", "Users")
    )
    assert path.stat().st_size < 400_000


def test_differences_of_two_runs():
    assert alike("gap 1.1e-16 mm, 17600 hexahedra", "gap  3e-17 mm, 17600 hexahedra")
    assert alike("T11 103.86 N", "T11 103.87 N")
    assert alike("penetration 0", "penetration 2e-15")
    assert not alike("17600 hexahedra", "17601 hexahedra")
    assert not alike("T11 103.86 N", "T11 104.86 N")
    assert not alike("weft 0.35 mm", "warp 0.35 mm")

    one = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("1")])
    other = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("1")])
    other.cells[0].outputs = [nbformat.v4.new_output("stream", text="1.0")]
    assert list(differences(one, one)) == []
    assert len(list(differences(one, other))) == 1
