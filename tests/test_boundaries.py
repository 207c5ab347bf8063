"""What may import what: CAD and gmsh each stay behind one door, and the package imports in a blink."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import fabric_cad

PACKAGE = Path(fabric_cad.__file__).parent
DOORS = {
    "cadquery": {"cad", "masters"},
    "OCP": {"cad"},
    "gmsh": {"meshing/gmsh_session.py"},
    "pyvista": {"support/vtk.py"},
    "vtkmodules": {"support/vtk.py"},
    "skfem": {"support/scikit_fem.py"},
    "dask": {"study/engine.py"},
    "distributed": {"study/engine.py"},
    "pyarrow": {"study/table.py"},
    "meshio": {"meshing/exchange.py"},
    "python_calamine": {"measured/workbooks.py"},
    "trame": {"page/server.py"},
    "aiohttp": {"page/guard.py"},
}


def imports(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield node.module.split(".")[0]


@pytest.mark.parametrize(
    "path", sorted(PACKAGE.rglob("*.py")), ids=lambda p: str(p.relative_to(PACKAGE))
)
def test_heavy_packages_stay_behind_their_doors(path):
    place = path.relative_to(PACKAGE).as_posix()
    for name in imports(path):
        allowed = DOORS.get(name)
        assert allowed is None or any(
            place == door or place.startswith(f"{door}/") for door in allowed
        ), name


@pytest.mark.parametrize(
    ("statement", "absent"),
    [
        ("import fabric_cad", ("cadquery", "OCP", "gmsh", "scipy", "pyvista", "numpy")),
        (
            "import fabric_cad; fabric_cad.identify; fabric_cad.read_family; fabric_cad.mesh_options",
            ("cadquery", "OCP", "gmsh", "scipy", "pyvista"),
        ),
        (
            "import fabric_cad; fabric_cad.run_study",
            (
                "cadquery",
                "OCP",
                "gmsh",
                "scipy",
                "pyvista",
                "dask",
                "distributed",
                "pyarrow",
                "matplotlib",
            ),
        ),
        (
            "from fabric_cad.page.desk import Desk; from fabric_cad.page.scene import scene",
            ("cadquery", "OCP", "gmsh", "pyvista", "vtkmodules", "matplotlib", "trame", "dask"),
        ),
        (
            "from fabric_cad.cli import main; main(['list', '-q'])",
            ("cadquery", "OCP", "gmsh", "scipy", "pyvista"),
        ),
    ],
)
def test_what_is_loaded_when(statement, absent):
    code = f"import sys; {statement}; print([name for name in {absent!r} if name in sys.modules])"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=PACKAGE.parent, check=True
    )
    assert done.stdout.splitlines()[-1] == "[]"


def test_every_public_name_is_there_and_documented():
    for name in fabric_cad.__all__:
        assert getattr(fabric_cad, name) is not None
        assert name == "__version__" or getattr(fabric_cad, name).__doc__
    with pytest.raises(AttributeError):
        fabric_cad.no_such_name  # noqa: B018
