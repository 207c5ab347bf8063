"""Materials and load cases: ``simulation.toml`` beside the family tables.

A key that is missing has the value of the file that is shipped; ``[rows.NAME.TABLE]`` holds what
differs for one row.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..measured.shipped import shipped_families
from ..measured.tables import Family, read_families
from ..support.errors import InputError, Problem, did_you_mean, quoted
from ..support.toml_files import read_toml

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

Check = tuple[type, Callable, str]
_POSITIVE: Check = (float, lambda v: 0 < v < math.inf, "is not a number above 0")
_POISSON: Check = (float, lambda v: -1 < v < 1, "is not between -1 and 1")
_NOT_NEGATIVE: Check = (float, lambda v: 0 <= v < math.inf, "is not a number from 0 up")


def _count(least: int, most: int) -> Check:
    return int, lambda v: least <= v <= most, f"is not a whole number from {least} to {most}"


_CHECKS: dict[str, dict[str, Check]] = {
    "yarn": {
        **{f"{modulus}_MPa": _POSITIVE for modulus in ("E1", "E2", "E3", "G12", "G13", "G23")},
        **{ratio: _POISSON for ratio in ("nu12", "nu13", "nu23")},
        "compaction_strain": (float, lambda v: v >= 0.001, "is below 0.001 (inf: a linear law)"),
    },
    "contact": {
        "kind": (str, lambda v: v in ("penalty", "tie"), "is neither 'penalty' nor 'tie'"),
        "stiffness_N_per_mm3": _POSITIVE,
        "friction": (float, lambda v: 0 <= v <= 2, "is not between 0 and 2"),
        "stick_N_per_mm3": _POSITIVE,
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
    layers = [_File(shipped_families() / FILE)]
    own = Path(families) / FILE
    if own.exists():
        layers.append(_File(own))
    problems = [problem for layer in layers for problem in layer.problems]
    if problems:
        raise InputError(problems)
    merged: dict[str, dict] = {table: {} for table in _TABLES}
    for layer in layers:
        for tables in (layer.content, layer.content.get("rows", {}).get(row, {})):
            for table in _TABLES:
                merged[table] |= tables.get(table, {})
    merged["tension"]["ratios"] = tuple(map(float, merged["tension"]["ratios"]))
    settings = Settings(**{table: kind(**merged[table]) for table, kind in _TABLES.items()})
    if np.linalg.eigvalsh(settings.yarn.compliance).min() <= 0:
        last = layers[-1]
        raise InputError(
            last.problem("yarn", "nu12", "the yarn's moduli and Poisson ratios give no stable material", row)
        )
    return settings


class _File:
    """One file, parsed, with everything that is wrong in it."""

    def __init__(self, path: Path) -> None:
        self.path = str(path)
        self.problems: list[Problem] = []
        self.content, self.lines = read_toml(path)
        for table, keys in self.content.items():
            if table == "rows" and isinstance(keys, dict):
                for row, tables in keys.items():
                    self._check_row(path.parent, row, tables)
            else:
                self._check_table(table, keys, "")

    def _check_row(self, families: Path, row: str, tables: object) -> None:
        known = _row_names(families)
        if row not in known and did_you_mean(row, known):  # a slip; what is like no row may be left of one
            self.problems.append(self.problem("", f"rows.{row}", f"no row is called so{did_you_mean(row, known)}"))
        if not isinstance(tables, dict):
            self.problems.append(self.problem("", f"rows.{row}", "is not a table"))
            return
        for name, inner in tables.items():
            self._check_table(name, inner, row)

    def _check_table(self, table: str, keys: object, row: str) -> None:
        if table not in _TABLES:
            self.problems.append(
                self.problem("", table, f"no such table{did_you_mean(table, [*_TABLES, 'rows'])}", row)
            )
        elif not isinstance(keys, dict):
            self.problems.append(self.problem("", table, "is not a table", row))
        else:
            for key, value in keys.items():
                self._check(table, key, value, row)

    def _check(self, table: str, key: str, value: object, row: str) -> None:
        checks = _CHECKS[table]
        if key not in checks:
            self.problems.append(self.problem(table, key, f"no such key in [{table}]{did_you_mean(key, checks)}", row))
            return
        kind, sound, complaint = checks[key]
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        fits = number if kind is float else isinstance(value, kind) and not isinstance(value, bool)
        if not (fits and sound(value)):
            self.problems.append(self.problem(table, key, f"{quoted(value)} {complaint}", row))

    def problem(self, table: str, key: str, message: str, row: str = "") -> Problem:
        place = ".".join(part for part in (table, key) if part)
        line = self.lines.get(f"rows.{row}.{place}", self.lines.get(place))
        return Problem(message, self.path, line, key, row or None)


def _row_names(families: Path) -> list[str]:
    """Names of all rows of a folder of family tables, unfinished ones too, as far as it can be read."""
    try:
        read = read_families(families, partial=True).values()
    except InputError:
        return []
    tables = [table for table in read if isinstance(table, Family)]
    refused = [problem.row for table in tables for problem in table.refused if problem.row]
    return [*(name for table in tables for name in table.names), *refused]
