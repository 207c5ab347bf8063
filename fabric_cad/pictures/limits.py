"""Round ends of a colour bar."""

from __future__ import annotations

import numpy as np

_NICE = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
_NEAR_ZERO = 0.2  # of the greatest value


def limits_of(values: np.ndarray) -> tuple[float, float, int]:
    """Round ends of a colour bar for any number of values, and the round steps between them.

    Symmetric where values lie far to both sides of 0; else from or to 0 where they come near it.
    """
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    if min(-low, high) > _NEAR_ZERO * max(-low, high):
        low, high = -max(-low, high), max(-low, high)
    elif abs(low) < _NEAR_ZERO * high:
        low = min(low, 0.0)
    elif abs(high) < -_NEAR_ZERO * low:
        high = max(high, 0.0)

    if not high > low:
        return low - 0.5, high + 0.5, 4
    step = (high - low) / 4
    power = 10.0 ** np.floor(np.log10(step))
    step = power * next(nice for nice in _NICE if nice * power >= step * (1 - 1e-9))
    low = step * np.floor(low / step + 1e-9)
    steps = int(np.ceil((high - low) / step - 1e-9))

    return low, low + steps * step, steps
