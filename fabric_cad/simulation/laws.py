"""What every simulation takes beside the row: the yarns' law, their contact, the mesh of the cell."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from ..measured.settings_files import POISSON, POSITIVE, Check
from .checks import is_from_to, whole


@dataclass(frozen=True)
class YarnLaw:
    """Orthotropic law of a yarn (MPa), axis 1 the fibre's, and the crush that doubles its transverse modulus."""

    E1_MPa: float
    E2_MPa: float
    E3_MPa: float
    G12_MPa: float
    G13_MPa: float
    G23_MPa: float
    nu12: float
    nu13: float
    nu23: float
    compaction_strain: float

    checks: ClassVar[Mapping[str, Check]] = MappingProxyType(
        {
            **{f"{modulus}_MPa": POSITIVE for modulus in ("E1", "E2", "E3", "G12", "G13", "G23")},
            **dict.fromkeys(("nu12", "nu13", "nu23"), POISSON),
            "compaction_strain": (
                float,
                lambda value: value >= 0.001,
                "is below 0.001 (inf: a linear law)",
            ),
        }
    )

    @property
    def compliance(self) -> np.ndarray:
        """Compliance (3, 3) of the normal components, 1/MPa."""
        e1, e2, e3 = self.E1_MPa, self.E2_MPa, self.E3_MPa
        return np.array(
            [
                [1 / e1, -self.nu12 / e1, -self.nu13 / e1],
                [-self.nu12 / e1, 1 / e2, -self.nu23 / e2],
                [-self.nu13 / e1, -self.nu23 / e2, 1 / e3],
            ]
        )

    @property
    def hardening(self) -> float:
        """Hardening H (MPa) of the compaction energy H/4 (J - 1)**4; 0 for the linear law.

        Crush by eps adds 3 H eps**2 to the modulus E3, as much again at the compaction strain.
        """
        return (
            0.0
            if math.isinf(self.compaction_strain)
            else self.E3_MPa / (3 * self.compaction_strain**2)
        )


@dataclass(frozen=True)
class ContactLaw:
    """How yarns touch: ``penalty`` with a stiffness (N/mm3) and friction, or ``tie``.

    ``rings`` of faces widen the patches that touch at first, but where they are glued;
    ``valid_penetration`` is the share of the thinner yarn's thickness up to which a state is valid.
    """

    kind: str
    stiffness_N_per_mm3: float
    friction: float
    stick_N_per_mm3: float
    rings: int
    valid_penetration: float

    checks: ClassVar[Mapping[str, Check]] = MappingProxyType(
        {
            "kind": (
                str,
                lambda kind: kind in ("penalty", "tie"),
                "is neither 'penalty' nor 'tie'",
            ),
            "stiffness_N_per_mm3": POSITIVE,
            "friction": (float, is_from_to(0, 2), "is not between 0 and 2"),
            "stick_N_per_mm3": POSITIVE,
            "rings": whole(0, 20),
            "valid_penetration": (
                float,
                lambda value: 0 < value <= 0.5,
                "is not above 0 and up to 0.5",
            ),
        }
    )


@dataclass(frozen=True)
class CellMesh:
    """Elements of the simulated cell, as the options of :func:`fabric_cad.mesh_options`.

    ``through`` 0: the least.
    """

    across: int
    crossing: int
    through: int
    gap: int

    checks: ClassVar[Mapping[str, Check]] = MappingProxyType(
        {
            "across": whole(2, 200),
            "crossing": whole(2, 200),
            "through": whole(0, 100),
            "gap": whole(2, 200),
        }
    )
