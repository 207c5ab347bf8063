"""The states of a cell under load, as a series for ParaView.

tension.pvd --names--> tension_state_0.vtu, tension_state_1.vtu, ...   (one a state, flat beside it)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from ..meshing.grids import pyvista_grid
from ..meshing.mesh import Mesh
from ..support.arrays import checked
from .vtu import write_grid


@dataclass(frozen=True, eq=False)
class State:
    """A deformed state: its ``time`` (or angle, or number), its ``label``, and what is known of it.

    ``displacement`` (nodes, 3) mm; ``point_data`` and ``cell_data`` map names to arrays (nodes,
    ...) and (elements, ...); ``facts`` maps names to one number or text each, which become field
    data.
    """

    time: float
    label: str
    displacement: np.ndarray
    point_data: Mapping[str, np.ndarray] = field(default_factory=dict)
    cell_data: Mapping[str, np.ndarray] = field(default_factory=dict)
    facts: Mapping[str, float | str] = field(default_factory=dict)


def write_series(
    mesh: Mesh,
    states: Iterable[State],
    path: str | Path,
    units: Mapping[str, str],
) -> list[Path]:
    """Write every state at its *deformed* points, and ``path`` (``.pvd``) that names them.

    Returns all files written.

    Each has the point vectors ``displacement`` (mm), which are active: points minus displacement is
    the cell at rest, and *Warp By Vector* with the factor n - 1 shows it n times larger. Cell data:
    ``yarn`` (from 1), ``direction`` (0 weft, 1 warp), ``fibre_axis`` along the deformed fibres.
    Field data: ``state`` (its label), ``yarn_names``, ``units`` (``name: unit`` of every array,
    from ``units``), ``TimeValue`` and the state's facts. Raises ValueError where an array does not
    fit the mesh or has a name that is taken, OSError where a file cannot be written whole.
    """
    path = Path(path)
    states = list(states)
    digits = len(str(len(states) - 1))
    files, entries = [], []

    for number, state in enumerate(states):
        file = path.with_name(f"{path.stem}_state_{number:0{digits}d}.vtu")
        write_grid(_state_grid(mesh, state, units), file)
        files.append(file)
        place = f'timestep="{state.time:.9g}" part="0" file={quoteattr(file.name)}'
        entries.append(f"    <DataSet {place}/>")

    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
    path.write_text(head + "\n".join(entries) + "\n  </Collection>\n</VTKFile>\n", encoding="utf-8")
    return [*files, path]


def _state_grid(mesh: Mesh, state: State, units: Mapping[str, str]):
    displacement = checked("displacement", state.displacement, mesh.points.shape)
    moved = replace(mesh, points=mesh.points + displacement)
    grid = pyvista_grid(moved)
    grid.point_data["displacement"] = np.asarray(state.displacement)

    sets = (("point", state.point_data, grid.point_data), ("cell", state.cell_data, grid.cell_data))
    for (kind, given, there), count in zip(sets, (len(mesh.points), len(mesh.hexahedra))):
        for name, values in given.items():
            if name in there:
                raise ValueError(f"{kind} data {name} is written anyway")
            there[name] = checked(f"{kind} data {name}", values, (count, *np.shape(values)[1:]))

    grid.point_data.active_vectors_name = "displacement"

    grid.field_data["state"] = [state.label]
    grid.field_data["units"] = [f"{name}: {unit}" for name, unit in units.items()]
    grid.field_data["TimeValue"] = np.array([state.time])
    for name, fact in state.facts.items():
        grid.field_data[name] = [fact] if isinstance(fact, str) else np.array([float(fact)])

    return grid
