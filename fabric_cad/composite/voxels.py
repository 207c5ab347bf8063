"""A composite cell on a regular grid, for FFT and voxel solvers: exact, from the yarns' closed-form faces.

A voxel is what its centre is in. No CAD and no mesh are needed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..model.solved import SolvedFabric
from ..support.arrays import read_only
from ..support.errors import InputError, Problem
from ..weave.bodies import Body
from ..yarn.heights import heights
from ..yarn.profiles import slopes
from ..yarn.swept import SweptYarn, swept_yarns
from .fibres import FibreSections, fibre_fractions

MOST_CELLS = 500_000_000


@dataclass(frozen=True, eq=False)
class Voxels:
    """Voxels of a cell, all arrays indexed x, y, z; lengths mm.

    ``body`` (nx, ny, nz): 0 matrix, 1, 2, ... the yarns of ``yarns`` in their order; ``fibre_axis``
    (nx, ny, nz, 3) unit vectors and ``fibre_fraction`` (nx, ny, nz), both 0 in the matrix; the
    fraction is NaN where it is not known. ``spacing`` (3,) are a voxel's edges, ``origin`` (3,) the
    corner of the box, whose middle is at z = 0.
    """

    body: np.ndarray
    fibre_axis: np.ndarray
    fibre_fraction: np.ndarray
    spacing: np.ndarray
    origin: np.ndarray
    yarns: tuple[Body, ...]

    def fractions(self) -> Mapping[str, float]:
        """Share of the voxels of every yarn, by its name."""
        counts = np.bincount(self.body.ravel(), minlength=len(self.yarns) + 1)
        return {
            yarn.name: float(count) / self.body.size for yarn, count in zip(self.yarns, counts[1:])
        }

    def write_npz(self, path: str | Path) -> None:
        """Write for numpy: ``body``, ``fibre_axis``, ``fibre_fraction``, ``spacing_mm``, ``origin_mm``, ``yarns``."""
        np.savez(
            path,
            body=self.body,
            fibre_axis=self.fibre_axis,
            fibre_fraction=self.fibre_fraction,
            spacing_mm=self.spacing,
            origin_mm=self.origin,
            yarns=np.array([yarn.name for yarn in self.yarns]),
        )

    def write_vti(self, path: str | Path) -> None:
        """Write for ParaView as image data, with the same names. Raises OSError where it cannot be written whole."""
        from ..support.vtk import image_writer, pyvista

        image = pyvista().ImageData(
            dimensions=np.array(self.body.shape) + 1, spacing=self.spacing, origin=self.origin
        )
        for name in ("body", "fibre_axis", "fibre_fraction"):
            values = getattr(self, name)
            image.cell_data[name] = (
                values.transpose(2, 1, 0, *range(3, values.ndim))
                .reshape(self.body.size, -1)
                .squeeze()
            )

        image.field_data["yarn_names"] = [yarn.name for yarn in self.yarns]

        # raises where there is no writing at all, which VTK does not tell
        Path(path).write_bytes(b"")
        writer = image_writer()
        writer.SetInputData(image)
        writer.SetFileName(str(path))
        if not writer.Write() or writer.GetErrorCode():
            raise OSError(f"{path}: the file could not be written")


def voxelise(
    fabric: SolvedFabric,
    counts: tuple[int, int, int],
    margin: float,
    sections: FibreSections | None = None,
) -> Voxels:
    """The cell of a fabric as ``counts`` voxels along x, y and z, with a clearance of ``margin`` mm above and below.

    ``sections`` say how much fibre there is; without them the fraction is not known. Raises
    :class:`InputError` where there are too many voxels, the cell is sheared, or a yarn would hold
    more fibre than can be packed.
    """
    if not fabric.lattice.is_axis_parallel:
        raise InputError(
            Problem("a sheared cell has no box of voxels that repeats", row=fabric.name)
        )

    if not (min(counts) >= 1 and np.prod(counts, dtype=float) <= MOST_CELLS):
        asked = "x".join(map(str, counts))
        raise InputError(
            Problem(f"{asked} is not from 1x1x1 to {MOST_CELLS:,} voxels in all", column="cells")
        )

    low, high = vertical_extent(fabric)
    size = np.array([*fabric.period, high - low + 2 * margin])
    spacing = size / counts
    body = np.zeros(np.prod(counts), dtype=np.int16)
    axis, fraction = (
        np.zeros((len(body), 3), dtype=np.float32),
        np.zeros(len(body), dtype=np.float32),
    )
    yarns = swept_yarns(fabric)

    for number, swept in enumerate(yarns, start=1):
        places, inside, place = _inside(swept, spacing, counts, (low + high) / 2 - size[2] / 2)
        known = None if sections is None else fibre_fractions(swept, sections, places)
        body[inside] = number
        axis[inside] = _axes(swept, places).astype(np.float32)[place]
        fraction[inside] = np.nan if known is None else known[place]

    return Voxels(
        read_only(body.reshape(counts)),
        read_only(axis.reshape(*counts, 3)),
        read_only(fraction.reshape(counts)),
        read_only(spacing),
        read_only(np.array([0.0, 0.0, -size[2] / 2])),
        tuple(swept.yarn.body for swept in yarns),
    )


def vertical_extent(fabric: SolvedFabric) -> tuple[float, float]:
    """Lowest and highest point of a fabric's yarns, mm, in the frame of its trajectories."""
    ways = fabric.directions.values()
    return min(way.z_low - way.thickness / 2 for way in ways), max(
        way.z_high + way.thickness / 2 for way in ways
    )


def _inside(
    swept: SweptYarn, spacing: np.ndarray, counts: tuple[int, int, int], floor: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which voxels of a grid, whose lowest face is at the height ``floor`` (mm), have their centre in a yarn.

    The ``places`` (along,) of the centres along it, mm; the numbers (voxels,) of those inside in
    the flat grid; and for each of them the number (voxels,) of its place.
    """
    axis = swept.yarn.direction.axis
    places, across = ((np.arange(counts[n]) + 0.5) * spacing[n] for n in (axis, 1 - axis))
    away = across - swept.trajectory.axis
    columns = np.flatnonzero(
        np.abs(away) <= swept.fabric.directions[swept.yarn.direction].width / 2
    )

    lower, upper = ((z - floor) / spacing[2] - 0.5 for z in heights(swept, places, away[columns]))
    mask = (np.arange(counts[2]) >= lower[..., None]) & (np.arange(counts[2]) <= upper[..., None])
    along, beside, up = np.nonzero(mask)
    x, y = (along, columns[beside]) if axis == 0 else (columns[beside], along)
    return places, (x * counts[1] + y) * counts[2] + up, along


def _axes(swept: SweptYarn, places: np.ndarray) -> np.ndarray:
    """Unit vectors (places, 3) along a yarn's trajectory."""
    rise = slopes(swept, places)
    axes = np.zeros((len(places), 3))
    axes[:, swept.yarn.direction.axis] = 1.0
    axes[:, 2] = rise
    return axes / np.hypot(1.0, rise)[:, None]
