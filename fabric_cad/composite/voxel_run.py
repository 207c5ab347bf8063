"""The voxels of a row's composite cell, in the row's folder."""

from __future__ import annotations

from pathlib import Path

from ..cell.pipeline import Stages
from ..cell.traces import renew_digests
from ..measured.tables import Family, expect_row
from ..model.identification import identify
from ..support.staging import staged
from .constituents import read_constituents
from .fibres import fibre_sections
from .options import USUAL, Margin
from .voxels import Voxels, voxelise


def make_voxels(
    row: Family,
    families: str | Path,
    out: str | Path,
    counts: tuple[int, int, int],
    *,
    margin: Margin = USUAL.margin,
    stages: Stages | None = None,
) -> Voxels:
    """The composite cell of a table of one row as ``counts`` voxels: ``voxels.vti`` and ``.npz`` in ``out/<row name>``.

    ``families`` is the folder whose ``composite.toml`` holds, where it has one; the box stands
    ``margin`` off the yarns. Raises :class:`FabricCadError`; earlier results are then as they were.
    """
    expect_row(row)
    (name,) = row.names
    stages = stages or Stages()
    sections = fibre_sections(row, read_constituents(families, name))
    with stages("identify"):
        fabric = identify(row)[name]
    with stages("voxels"):
        voxels = voxelise(fabric, counts, margin.length(fabric.fabric_thickness), sections)
    with staged(Path(out) / name, renew_digests) as folder, stages("write"):
        voxels.write_vti(folder / "voxels.vti")
        voxels.write_npz(folder / "voxels.npz")

    return voxels
