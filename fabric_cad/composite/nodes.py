"""The nodes of a composite cell while it is made: on a torus, where opposite sides of the cell are one."""

from __future__ import annotations

import numpy as np


class Nodes:
    """Nodes that are added to: ``points`` (nodes, 3) in mm, addressed by their numbers.

    On the torus a number stands for a node and all its images. What lies on x = 0 or y = 0 gets its
    images, a period further, at the end (:meth:`close`).
    """

    def __init__(self, points: np.ndarray) -> None:
        self._parts = [points]
        self._count = len(points)

    def __len__(self) -> int:
        return self._count

    @property
    def points(self) -> np.ndarray:
        """The places (nodes, 3), mm; may be written to until nodes are added."""
        if len(self._parts) > 1:
            self._parts = [np.concatenate(self._parts)]
        return self._parts[0]

    def add(self, places: np.ndarray) -> np.ndarray:
        """Numbers (...) of new nodes at places (..., 3), mm."""
        numbers = np.arange(self._count, self._count + places[..., 0].size).reshape(
            places.shape[:-1]
        )
        self._parts.append(places.reshape(-1, 3))
        self._count += numbers.size
        return numbers

    def images(self, axis: int, period: float, known: np.ndarray) -> np.ndarray:
        """The image (nodes,) of every node on a side of the cell (0: x = 0, 1: y = 0), -1 of others.

        ``known`` (pairs, 2) lists nodes with images of their own, which are moved to where they
        belong; the others' are added, ``period`` (mm) further.
        """
        images = np.full(len(self), -1)
        images[known[:, 0]] = known[:, 1]
        new = np.flatnonzero((self.points[:, axis] == 0.0) & (images < 0))
        places = self.points[new]
        places[:, axis] = period
        images[new] = self.add(places)

        moved = self.points[known[:, 0]]
        moved[:, axis] = period
        self.points[known[:, 1]] = moved
        return images
