"""STEP to hexahedra.

gmsh reads the STEP, spaces nodes on every edge so that layers of them are vertical planes, and
meshes the yarns' faces transfinitely. A :mod:`template <fabric_cad.meshing.templates>` then fills
each layer of nodes between the faces, and two layers in a row bound the hexahedra.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..model.solved import SolvedFabric
from ..support.errors import BuildError, expect
from ..weave.weaves import yarns_of
from .count import hexahedra
from .filling import fill, name_groups
from .gmsh_session import gmsh_session
from .options import MeshOptions
from .plan import plan_yarns
from .yarn_faces import YarnFaces, classified, set_transfinite, space_nodes


def mesh_cell(
    step: str | Path,
    fabric: SolvedFabric,
    options: MeshOptions,
    msh: str | Path,
) -> None:
    """Mesh the STEP of a fabric's cell with hexahedra and write it as gmsh 4.1.

    Raises :class:`InputError` where the options do not fit the section, :class:`BuildError`
    where gmsh or the STEP does not give what the fabric asks for.
    """
    expect(fabric, SolvedFabric, "fabric", " (identify(table)['name'] gives one)")
    expect(options, MeshOptions, "options")
    options.check(fabric)

    with gmsh_session() as gmsh:
        try:
            _mesh(gmsh, Path(step), fabric, options)
            _write(gmsh, Path(msh))
        except BuildError:
            raise
        except MemoryError as error:
            count = hexahedra(fabric, options)
            raise BuildError(f"out of memory while meshing {count} hexahedra") from error
        except Exception as error:  # gmsh raises bare Exception
            raise BuildError(f"gmsh: {str(error) or 'no reason given'}") from error


def _planned(gmsh: Any, step: Path, fabric: SolvedFabric, options: MeshOptions) -> list[YarnFaces]:
    """The yarns of the STEP, as planned."""
    gmsh.option.setNumber("Geometry.OCCBoundsUseStl", 0)
    gmsh.merge(str(step))
    entities = gmsh.model.getEntities(3)
    solids = {gmsh.model.getEntityName(3, tag).split("/")[-1]: tag for _, tag in entities}
    plans = plan_yarns(fabric, yarns_of(fabric.weave.interlacement()), options)
    if missing := [plan.yarn.name for plan in plans if plan.yarn.name not in solids]:
        raise BuildError(f"{step}: holds no solid named {', '.join(missing)}")

    lattice = fabric.lattice
    return [classified(gmsh, plan, lattice, solids[plan.yarn.name]) for plan in plans]


def _mesh(gmsh: Any, step: Path, fabric: SolvedFabric, options: MeshOptions) -> None:
    yarns = _planned(gmsh, step, fabric, options)
    edges = [yarn.edges(gmsh) for yarn in yarns]
    for yarn, curves in zip(yarns, edges):
        set_transfinite(gmsh, yarn, curves)

    # the end sections are filled by the template, as all layers of nodes are
    gmsh.option.setNumber("Mesh.MeshOnlyVisible", 1)
    ends = [(2, face) for yarn in yarns for face in (yarn.start, yarn.end)]
    gmsh.model.setVisibility(ends, 0)

    gmsh.model.mesh.generate(1)
    for curves in edges:
        space_nodes(gmsh, curves)
    gmsh.model.mesh.generate(2)

    for yarn in yarns:
        fill(gmsh, yarn)
    for yarn in yarns:
        name_groups(gmsh, yarn)
    gmsh.model.mesh.renumberNodes()
    gmsh.model.mesh.renumberElements()


def _write(gmsh: Any, msh: Path) -> None:
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.write(str(msh))
