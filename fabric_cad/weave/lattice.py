"""How a cell repeats, and where its woven coordinates lie in space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..support.arrays import read_only


@dataclass(frozen=True, eq=False)
class Lattice:
    """The elementary cell's periods and the linear map from woven coordinates to space.

    Woven coordinates are u along the wefts, v along the warps and z along the fabric's normal,
    mm. ``size`` (2,) holds the extents of the cell along u and v, mm; the rows of ``axes``,
    shape (3, 3), are the places in space of one millimetre along u, v and z. Everything that
    is identified, swept and planned is in woven coordinates; the poles of CAD faces, the nodes
    of meshes and the decks go through the map. Raises ValueError where the map has no inverse.
    """

    size: np.ndarray
    axes: np.ndarray

    def __post_init__(self) -> None:
        for name, shape in (("size", (2,)), ("axes", (3, 3))):
            values = np.array(getattr(self, name), dtype=float)
            if values.shape != shape:
                raise ValueError(f"{name} has shape {values.shape}, not {shape}")
            object.__setattr__(self, name, read_only(values))

        if not np.linalg.det(self.axes) > 0:
            raise ValueError("the axes of a lattice are not right-handed")

    @classmethod
    def axis_parallel(cls, along_weft: float, along_warp: float) -> Lattice:
        """The lattice of a fabric as woven: u is x and v is y; extents in mm."""
        return cls(np.array([along_weft, along_warp]), np.eye(3))

    @property
    def vectors(self) -> np.ndarray:
        """The period vectors, shape (2, 3), mm: along the wefts and along the warps."""
        return self.size[:, None] * self.axes[:2]

    @property
    def is_axis_parallel(self) -> bool:
        """True where woven coordinates are those of space."""
        return bool(np.array_equal(self.axes, np.eye(3)))

    def to_space(self, woven: np.ndarray) -> np.ndarray:
        """Places (..., 3) in space, mm, of woven coordinates (..., 3).

        The same array where they agree.
        """
        return woven if self.is_axis_parallel else woven @ self.axes

    def to_woven(self, places: np.ndarray) -> np.ndarray:
        """Woven coordinates (..., 3) of places (..., 3) in space, mm."""
        return places if self.is_axis_parallel else places @ np.linalg.inv(self.axes)

    def woven_coordinate(self, axis: int) -> np.ndarray:
        """The vector (3,) whose product with a place in space is its woven coordinate.

        ``axis`` is 0 for u, 1 for v, 2 for z.
        """
        return np.linalg.inv(self.axes)[:, axis]


AS_WOVEN = Lattice.axis_parallel(1.0, 1.0)
"""Woven coordinates taken for those of space, whatever the cell's size."""
