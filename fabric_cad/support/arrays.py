"""Arrays that frozen values hold."""

from __future__ import annotations

import numpy as np


def read_only(values: np.ndarray) -> np.ndarray:
    """The array itself, no longer to be written to."""
    values.setflags(write=False)
    return values


def checked(name: str, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """``values`` as an array. Raises ValueError, which says ``name``, where its shape is not ``shape``."""
    if np.shape(values) != shape:
        raise ValueError(f"{name} has shape {np.shape(values)}, not {shape}")
    return np.asarray(values)
