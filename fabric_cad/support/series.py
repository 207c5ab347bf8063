"""What a row of states says of a bound."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def valid_until(states: Sequence[float], depths: Sequence[float], allowed: float) -> float:
    """The state (an angle, a strain) at which the depth of penetration first exceeds ``allowed``.

    ``states`` ascend, ``depths`` and ``allowed`` are in one unit; between states the depth is taken
    as linear. The last state where it never exceeds, the first where it does from the start.
    """
    over = np.flatnonzero(np.asarray(depths) > allowed)
    if not len(over):
        return float(states[-1])
    if (n := over[0]) == 0:
        return float(states[0])
    share = (allowed - depths[n - 1]) / (depths[n] - depths[n - 1])
    return float(states[n - 1] + share * (states[n] - states[n - 1]))
