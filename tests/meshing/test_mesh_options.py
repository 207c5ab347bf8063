"""What mesh options ask for, before there is any mesh: counted exactly, refused where no memory holds it."""

import numpy as np
import pytest
from fabrics import TWILL32, random_general_row, random_row, table
from reports import small_report

from fabric_cad.cli import main
from fabric_cad.meshing import mesher
from fabric_cad.meshing.count import hexahedra, needed_memory
from fabric_cad.meshing.options import MOST, MeshOptions, mesh_options
from fabric_cad.meshing.plan import plan_yarns
from fabric_cad.model.identification import identify_rows
from fabric_cad.model.solved import SolvedFabric
from fabric_cad.support import memory
from fabric_cad.support.errors import BuildError, InputError
from fabric_cad.weave.weaves import yarns_of


def fabric_of(family, row):
    """The fabric of a measured row, None where it is none."""
    found = identify_rows(table(family, row))
    return (
        None
        if found.refused
        else SolvedFabric.from_row({name: each[0] for name, each in found.columns.items()})
    )


TWILL = fabric_of("twill", TWILL32)
GIGABYTE = 10**9


def planned(fabric, options):
    """The hexahedra of all yarns' plans: layers along, each of the template's quadrilaterals."""
    plans = plan_yarns(fabric, yarns_of(fabric.weave.interlacement()), options)
    return sum(len(plan.template.quads) * plan.rows[-1] for plan in plans)


@pytest.mark.parametrize("form", ["lenticular", "flat", "round"])
@pytest.mark.parametrize("seed", range(6))
def test_the_count_is_that_of_the_plans(form, seed):
    rng = np.random.default_rng([seed, len(form)])
    draw = (
        random_row
        if seed < 2 and form == "lenticular"
        else lambda rng: random_general_row(rng, form=form)
    )
    fabric = next(
        fabric for fabric in (fabric_of(*draw(rng)) for _ in range(200)) if fabric is not None
    )
    through = 2 * int(rng.integers(2, 4)) if form == "round" else 2 * int(rng.integers(1, 3))
    across, crossing = (int(n) for n in rng.integers(2 * through, 2 * through + 9, 2))
    for options in (
        MeshOptions(across, crossing, through, 2 * int(rng.integers(1, 4))),
        mesh_options(fabric),
    ):
        assert hexahedra(fabric, options) == planned(fabric, options)


def test_the_count_of_the_readme():
    assert hexahedra(TWILL, mesh_options(TWILL)) == 17600


@pytest.mark.parametrize("name", ["across", "crossing", "through", "gap"])
def test_zero_is_an_error_and_not_the_default(name):
    for size in ({}, {"size": 0.5}):
        with pytest.raises(InputError, match=rf"{name}: 0 is not at least \d"):
            mesh_options(TWILL, **size, **{name: 0})


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (
            {"through": 100},
            "^through: the mesh would have 380000000 hexahedra .* than the 8 GB .*; reduce through$",
        ),
        ({"size": 0.002}, r"^size: the mesh would have 14139697000 hexahedra .*; raise size$"),
        ({"size": 0.5, "gap": 90000}, r"^gap: the mesh would have .*; reduce gap$"),
        (
            {"across": 90000, "crossing": 4},
            r"^across: .* GB, more than the 8 GB",
        ),  # few hexahedra of a huge section
        ({"gap": 100_000_000}, rf"^gap: 100000000 is above {MOST} \(elements\)$"),
        ({"across": 10**30}, rf"^across: this is above {MOST} \(elements\)$"),
        ({"across": 12.5}, "^across: 12.5 is not a whole number$"),
        ({"size": 1e-9}, rf"^size: 1e-09 makes more than {MOST} elements of 0.3548 mm$"),
        ({"size": 1e-320}, "^size: .* makes more than"),
        ({"size": float("inf")}, "^size: inf is not above 0 and finite$"),
        ({"size": float("nan")}, "^size: nan is not above 0$"),
    ],
)
def test_what_no_memory_holds_is_refused_with_the_number(monkeypatch, options, words):
    monkeypatch.setattr("fabric_cad.meshing.options.available_memory", lambda: 8 * GIGABYTE)
    with pytest.raises(InputError, match=words):
        mesh_options(TWILL, **options)


def test_the_bound_is_the_memory_there_is(monkeypatch):
    options = MeshOptions(40, 40, 4, 4)
    needed = needed_memory(TWILL, options)
    for there_is, refused in ((needed, False), (needed - 1, True), (None, False)):
        monkeypatch.setattr(
            "fabric_cad.meshing.options.available_memory", lambda there_is=there_is: there_is
        )
        if refused:
            with pytest.raises(InputError, match="hexahedra"):
                options.check(TWILL)
        else:
            options.check(TWILL)


def test_available_memory_is_the_least_of_all_limits(monkeypatch, tmp_path):
    assert memory.available_memory() > 0
    limit, used = tmp_path / "limit", tmp_path / "used"
    limit.write_text("5000\n")
    used.write_text("3000\n")
    monkeypatch.setattr(memory, "_CGROUPS", ((tmp_path / "none", used), (limit, used)))
    assert memory.available_memory() == 2000
    limit.write_text("max\n")
    assert memory.available_memory() > 2000


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (MemoryError(), "out of memory while meshing 17600 hexahedra"),
        (Exception(), "gmsh: no reason given"),
        (Exception("no surface"), "gmsh: no surface"),
    ],
)
def test_a_mesher_that_fails_says_why(monkeypatch, tmp_path, error, words):
    def fail(*_):
        raise error

    monkeypatch.setattr(mesher, "_mesh", fail)
    with pytest.raises(BuildError, match=f"^{words}$"):
        mesher.mesh_cell(tmp_path / "x.step", TWILL, MeshOptions(), tmp_path / "x.msh")


def test_the_command_foretells(here, capsys, monkeypatch):
    monkeypatch.setattr("fabric_cad.cell.pipeline.make_cell", lambda *_: small_report())
    assert main(["cell", "twill32"]) == 0
    assert "  17600 hexahedra to make\n" in capsys.readouterr().err
