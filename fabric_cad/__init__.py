"""From a handful of numbers measured on a woven fabric to a CAD model and a hexahedral mesh of its cell.

The consistent model of Hivet and Boisse (Finite Elements in Analysis and Design 42, 2005, 25-49)::

    table = identify(read_family("families/twill.csv"))   # no CAD, whole tables at once
    cell = build_cell(table["twill32"])                   # CadQuery: one valid solid a yarn
    cell.write_step("twill32.step")
    mesh_cell("twill32.step", table["twill32"], MeshOptions(), "twill32.msh")

Without a table: ``measured_fabric("twill", over=3, under=2, weft_density_per_mm=0.35, ...)``.

CadQuery and gmsh are loaded when a cell is first built or meshed, not by importing this package.
"""

from __future__ import annotations

import sys
from importlib import import_module

__version__ = "0.1.0"

_FROM = {
    "read_family": "measured.tables",
    "read_families": "measured.tables",
    "measured_fabric": "measured.by_hand",
    "Family": "measured.tables",
    "read_wif": "measured.wif",
    "identify": "model.identification",
    "propagate": "model.scatter",
    "read_solved": "model.solved",
    "SolvedFabric": "model.solved",
    "SolvedTable": "model.solved",
    "build_cell": "masters",
    "mesh_cell": "meshing",
    "read_mesh": "meshing",
    "mesh_options": "meshing",
    "Mesh": "meshing",
    "MeshOptions": "meshing",
    "make_cell": "cell.pipeline",
    "make_composite": "composite.pipeline",
    "mesh_composite": "composite.matrix",
    "composite_mesh_options": "composite.spacing",
    "CompositeCell": "composite.cell",
    "CompositeOptions": "composite.options",
    "Margin": "composite.options",
    "make_stiffness": "composite.stiffness.run",
    "make_permeability": "flow.run",
    "make_voxels": "composite.voxel_run",
    "voxelise": "composite.voxels",
    "read_constituents": "composite.constituents",
    "Constituents": "composite.substances",
    "Fibre": "composite.substances",
    "Matrix": "composite.substances",
    "make_tension": "simulation.run",
    "make_shear": "simulation.run",
    "Solver": "simulation.job",
    "read_study": "study",
    "run_study": "study",
    "show": "page.display",
    "FabricCadError": "support.errors",
    "InputError": "support.errors",
    "ArgumentError": "support.errors",
    "UnknownRowError": "support.errors",
    "MissingPackageError": "support.errors",
    "BuildError": "support.errors",
    "OutputError": "support.errors",
    "SolverError": "support.errors",
}
__all__ = ["__version__", *_FROM]


def __getattr__(name: str):
    if name in _FROM:
        return getattr(import_module(f".{_FROM[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


def _register_display() -> None:
    """Where this is imported in a notebook, a solved fabric is shown as a picture and a table."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    if shell is None:
        return

    def drawn(fabric):
        return import_module(".page.display", __name__).picture_and_table(fabric)

    formatter = shell.display_formatter.formatters["text/html"]
    formatter.for_type_by_name(f"{__name__}.model.solved", "SolvedFabric", drawn)


_register_display()
