"""PyVista and VTK, loaded when they are needed, and arrays checked before they get there."""

from __future__ import annotations

import numpy as np

from ...support.interrupts import uninterrupted


def pyvista():
    """PyVista, which is loaded whole or not at all."""
    with uninterrupted():
        import pyvista

    return pyvista


def checked(name: str, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """``values`` as an array. Raises ValueError, which says ``name``, where its shape is not ``shape``."""
    if np.shape(values) != shape:
        raise ValueError(f"{name} has shape {np.shape(values)}, not {shape}")
    return np.asarray(values)
