"""How high the faces of a cell reach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .faces import Face

_SAMPLES = 9
"""Points along either parameter of a face among which the search for its summit starts."""


def thickness(faces: Sequence[Face]) -> float:
    """Distance in z between the highest and the lowest point of all faces, mm."""
    return _highest(faces, 1.0) + _highest(faces, -1.0)


def _highest(faces: Sequence[Face], sign: float) -> float:
    """Largest sign * z over all faces, mm.

    No point of a face is higher than its highest pole: faces are tried from the highest pole down,
    until no pole left is above the highest point sampled. From there a minimiser goes on.
    """
    bounds = [(sign * face.corners[..., 2]).max() for face in faces]
    best, summit, start = -np.inf, faces[0], np.zeros(2)

    for number in np.argsort(bounds)[::-1]:
        if bounds[number] <= best:
            break
        height, place = _highest_sample(faces[number], sign)
        if height > best:
            best, summit, start = height, faces[number], place

    return max(best, _climbed(summit, start, sign))


def _highest_sample(face: Face, sign: float) -> tuple[float, np.ndarray]:
    """The largest sign * z (mm) on a grid of a face's parameters, and where, (u, v)."""
    u, v = (np.linspace(knots[0], knots[-1], _SAMPLES) for knots in face.knots)
    points = face.evaluate(u, v)
    z = sign * points[..., 2] / points[..., 3]
    row, column = np.unravel_index(z.argmax(), z.shape)
    return float(z[row, column]), np.array([u[row], v[column]])


def _climbed(face: Face, start: np.ndarray, sign: float) -> float:
    """The largest sign * z (mm) that is reached from the parameters ``start`` (2,) of a face."""
    from scipy.optimize import minimize

    def depth(parameters: np.ndarray) -> float:
        point = face.evaluate(parameters[:1], parameters[1:])[0, 0]
        return float(-sign * point[2] / point[3])

    bounds = [(float(knots[0]), float(knots[-1])) for knots in face.knots]
    climbed = minimize(
        depth,
        start,
        bounds=bounds,
        method="L-BFGS-B",
        options={"ftol": 1e-15, "gtol": 1e-12},
    )

    return float(-climbed.fun)
