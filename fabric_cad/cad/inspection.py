"""What a cell's solids really do, measured on the B-spline faces of the STEP file.

Seen from above, the faces of a yarn in a crossing are height fields z(x, y) over axis-parallel
rectangles (checked, not assumed). Two yarns can meet only where their rectangles overlap.
Between knot lines the difference of two polynomial faces is a polynomial, and Gauss-Lobatto
points with more nodes than its degree see all of it; round lateral zones are sampled at the
same points.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import cadquery as cq
import numpy as np

from ..support.errors import BuildError
from .extent import thickness
from .faces import Rectangle, faces_of
from .meeting import TOUCHING, hull, intersection, meeting

__all__ = ["TOUCHING", "Consistency", "Rectangle", "inspect_cell"]

_VOLUME = 1e-9  # relative; without it OCCT takes fewer points than its own degree needs


@dataclass(frozen=True)
class Consistency:
    """How a cell's yarns meet; lengths mm, areas mm2, volumes mm3.

    ``max_contact_gap`` is the largest distance between the facing sides of two crossing
    yarns over their contact patch, ``max_penetration`` how deep one enters another anywhere,
    ``overlap_volume`` the integral of that depth over the fabric's plane, ``contact_area`` the
    area in which the distance is at most :data:`TOUCHING`; ``yarn_volumes`` has one entry a yarn.
    """

    max_penetration: float
    max_contact_gap: float
    overlap_volume: float
    contact_area: float
    thickness: float
    yarn_volumes: dict[str, float]


def inspect_cell(
    solids: Mapping[str, cq.Solid],
    patches: Mapping[tuple[str, str], Rectangle] | None = None,
) -> Consistency:
    """Measure the solids of a cell, as read from its STEP file.

    ``patches`` gives the plan rectangle in which two yarns should touch; without it they
    should wherever they lie over each other. Raises :class:`BuildError` where a yarn is no
    valid solid, or its faces are no height fields in a crossing.
    """
    for name, solid in solids.items():
        if not solid.isValid():
            raise BuildError(f"{name} is not a valid solid")

    faces = {name: faces_of(solid) for name, solid in solids.items()}
    hulls = {name: hull([face.rectangle for face in of_yarn]) for name, of_yarn in faces.items()}
    meetings = []

    for first, second in combinations(solids, 2):
        common = intersection(hulls[first], hulls[second])
        if common is not None:
            patch = common if patches is None else patches.get((first, second), common)
            meetings.append(meeting(faces[first], faces[second], common, patch))

    return Consistency(
        max_penetration=max((meet.penetration for meet in meetings), default=0.0),
        max_contact_gap=max((meet.gap for meet in meetings), default=0.0),
        overlap_volume=float(np.sum([meet.overlap_volume for meet in meetings])),
        contact_area=float(np.sum([meet.contact_area for meet in meetings])),
        thickness=thickness([face for of_yarn in faces.values() for face in of_yarn]),
        yarn_volumes={name: solid.Volume(_VOLUME) for name, solid in solids.items()},
    )
