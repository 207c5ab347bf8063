"""The masters as a CAD user opens them."""

import subprocess
import sys
from importlib import import_module

import numpy as np
import pytest

from fabric_cad.cell.pipeline import find_row
from fabric_cad.measured.shipped import shipped_families
from fabric_cad.measured.tables import read_families
from fabric_cad.model.identification import identify
from fabric_cad.weave.weaves import FAMILIES
from fabric_cad.yarn.swept import swept_yarns

TWICE = """
import sys
import cadquery
from fabric_cad import __file__ as package

path = package.replace("__init__.py", "masters/plain.py")
code = compile(open(path, encoding="utf-8").read(), path, "exec")
for name in [name for name in sys.modules if name.startswith("fabric_cad")]:
    del sys.modules[name]

for run in (1, 2):
    before, shown = set(sys.modules), []
    exec(code, {"__name__": "__cq_main__", "show_object": lambda part, **told: shown.append((part, told["name"]))})
    for name in set(sys.modules) - before:
        del sys.modules[name]
    kinds = sorted({type(part).__name__ for part, _ in shown})
    print(run, len(shown), *kinds, *(name for part, name in shown if type(part).__name__ == "Solid"))
"""


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """A folder that holds build/plain/solved.csv, and its fabric."""
    row, _ = find_row(shipped_families(), "plain")
    folder = tmp_path_factory.mktemp("masters")
    (folder / "build" / "plain").mkdir(parents=True)
    solved = identify(row)
    solved.write(folder / "build" / "plain" / "solved.csv")
    return folder, solved["plain"]


def run_twice(folder):
    return subprocess.run(
        [sys.executable, "-c", TWICE], cwd=folder, capture_output=True, text=True, timeout=300
    )


def test_a_master_runs_again_when_cq_editor_has_unloaded_what_it_imported(plain):
    folder, fabric = plain
    told = run_twice(folder)

    parts = sum(2 + 2 * len(swept.planes) for swept in swept_yarns(fabric))
    kinds = f"{parts} Edge Solid Wire Workplane weft_1 weft_2 warp_1 warp_2"
    assert told.stdout.splitlines() == [f"1 {kinds}", f"2 {kinds}"], told.stderr


def test_a_master_says_how_to_get_a_solved_row(tmp_path, monkeypatch):
    from fabric_cad.masters.woven import solved_row
    from fabric_cad.support.errors import InputError

    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="no solved row yet; 'fabric-cad cell nothing' writes one"):
        solved_row("build/nothing/solved.csv")


@pytest.mark.parametrize("family", FAMILIES)
def test_the_rule_in_the_script_is_that_of_the_weave(family):
    master = import_module(f"fabric_cad.masters.{family}")
    for fabric in identify(read_families(shipped_families())[family]):
        np.testing.assert_array_equal(master.rule(fabric.weave), fabric.weave.interlacement())


def test_a_section_can_be_replaced_and_cadquery_sweeps_near_the_exact_skin(plain):
    from fabric_cad.masters import plain as master
    from fabric_cad.masters.woven import woven

    _, fabric = plain
    rule = master.rule(fabric.weave)
    exact = woven(fabric, rule).solids
    symmetric = woven(fabric, rule, lambda swept, number: swept.sections[0]).solids
    near = woven(fabric, rule, kind="multisection").solids

    assert all(solid.isValid() for solid in (*symmetric.values(), *near.values()))
    area = symmetric["weft_1"].Volume() / fabric.period[0]
    assert area == pytest.approx(exact["weft_1"].Volume() / fabric.period[0], rel=0.1)
    assert symmetric["weft_1"].Volume() != exact["weft_1"].Volume()

    crossing = [
        sum(
            cell[weft].intersect(cell[warp]).Volume()
            for weft in ("weft_1",)
            for warp in ("warp_1", "warp_2")
        )
        for cell in (exact, near)
    ]
    furthest = max(
        near[swept.yarn.name].distance(point_at(swept, patch, u, v))
        for swept in swept_yarns(fabric)[:1]
        for patch in swept.skin.patches
        for u in (0.25, 0.5, 0.75)
        for v in (0.25, 0.5, 0.75)
    )
    print("overlap, mm3:", crossing, "outside by, mm:", furthest)
    assert crossing[0] < 1e-9
    assert 0.05 < furthest < 0.08  # mm


def point_at(swept, patch, u, v):
    """A point of a weft's skin as CadQuery's vertex."""
    import cadquery as cq

    t, across, height = patch.at([u], [v])[0, 0]
    return cq.Vertex.makeVertex(t, across + swept.skin.axis, height)
