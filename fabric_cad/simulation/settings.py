"""Materials and load cases: ``simulation.toml`` beside the family tables.

A key that is missing has the value of the file that is shipped; ``[rows.NAME.TABLE]`` holds what
differs for one row.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..measured.settings_files import POISSON, POSITIVE, Check, SettingsFile
from ..measured.shipped import shipped_families
from ..support.errors import InputError

FILE = "simulation.toml"


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
        return 0.0 if math.isinf(self.compaction_strain) else self.E3_MPa / (3 * self.compaction_strain**2)


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


@dataclass(frozen=True)
class CellMesh:
    """Elements of the simulated cell, as the options of :func:`fabric_cad.mesh_options`; ``through`` 0: the least."""

    across: int
    crossing: int
    through: int
    gap: int


@dataclass(frozen=True)
class TensionCase:
    """Biaxial tension to a strain, on curves of the given ratios E22/E11 and on a grid."""

    strain: float
    ratios: tuple[float, ...]
    points: int
    grid: int


@dataclass(frozen=True)
class ShearCase:
    """Trellis shear to an angle (degrees) after a strain of both directions."""

    angle_deg: float
    points: int
    strain: float


@dataclass(frozen=True)
class Settings:
    """All that a simulation of one row takes beside the row."""

    yarn: YarnLaw
    contact: ContactLaw
    mesh: CellMesh
    tension: TensionCase
    shear: ShearCase


_TABLES = {"yarn": YarnLaw, "contact": ContactLaw, "mesh": CellMesh, "tension": TensionCase, "shear": ShearCase}


def _count(least: int, most: int) -> Check:
    return int, lambda v: least <= v <= most, f"is not a whole number from {least} to {most}"


_CHECKS: dict[str, dict[str, Check]] = {
    "yarn": {
        **{f"{modulus}_MPa": POSITIVE for modulus in ("E1", "E2", "E3", "G12", "G13", "G23")},
        **{ratio: POISSON for ratio in ("nu12", "nu13", "nu23")},
        "compaction_strain": (float, lambda v: v >= 0.001, "is below 0.001 (inf: a linear law)"),
    },
    "contact": {
        "kind": (str, lambda v: v in ("penalty", "tie"), "is neither 'penalty' nor 'tie'"),
        "stiffness_N_per_mm3": POSITIVE,
        "friction": (float, lambda v: 0 <= v <= 2, "is not between 0 and 2"),
        "stick_N_per_mm3": POSITIVE,
        "rings": _count(0, 20),
        "valid_penetration": (float, lambda v: 0 < v <= 0.5, "is not above 0 and up to 0.5"),
    },
    "mesh": {"across": _count(2, 200), "crossing": _count(2, 200), "through": _count(0, 100), "gap": _count(2, 200)},
    "tension": {
        "strain": (float, lambda v: 0 < v <= 0.1, "is not above 0 and up to 0.1"),
        "ratios": (list, lambda v: bool(v) and all(_is_ratio(k) for k in v), "is not a list of numbers from 0 to inf"),
        "points": _count(1, 100),
        "grid": _count(0, 50),
    },
    "shear": {
        "angle_deg": (float, lambda v: 0 < v <= 60, "is not above 0 and up to 60"),
        "points": _count(1, 200),
        "strain": (float, lambda v: 0 <= v <= 0.1, "is not from 0 to 0.1"),
    },
}


def _is_ratio(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value >= 0


def read_settings(families: str | Path, row: str) -> Settings:
    """Settings of one row: the shipped file's, the folder's own, then what the folder's file has for the row.

    Raises :class:`InputError` naming file, line, key, value and bound of all that is wrong.
    """
    layers = [SettingsFile(shipped_families() / FILE, _CHECKS)]
    own = Path(families) / FILE
    if own.exists():
        layers.append(SettingsFile(own, _CHECKS))
    problems = [problem for layer in layers for problem in layer.problems]
    if problems:
        raise InputError(problems)

    merged: dict[str, dict] = {table: {} for table in _TABLES}
    for layer in layers:
        for table, keys in layer.tables(row).items():
            merged[table] |= keys
    merged["tension"]["ratios"] = tuple(map(float, merged["tension"]["ratios"]))
    settings = Settings(**{table: kind(**merged[table]) for table, kind in _TABLES.items()})
    if np.linalg.eigvalsh(settings.yarn.compliance).min() <= 0:
        last = layers[-1]
        raise InputError(
            last.problem("yarn", "nu12", "the yarn's moduli and Poisson ratios give no stable material", row)
        )
    return settings
