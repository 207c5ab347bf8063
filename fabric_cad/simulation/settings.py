"""Materials and load cases: ``simulation.toml`` beside the family tables.

A key that is missing has the value of the file that is shipped, or else the one a load case gives
it; ``[rows.NAME.TABLE]`` holds what differs for one row.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from ..measured.settings_files import SettingsFile
from ..measured.shipped import shipped_families
from ..support.errors import InputError
from .laws import CellMesh, ContactLaw, YarnLaw
from .loads import LoadCase, load_cases

FILE = "simulation.toml"
_LAWS: dict[str, Any] = {"yarn": YarnLaw, "contact": ContactLaw, "mesh": CellMesh}


@dataclass(frozen=True, repr=False)
class Settings:
    """All that a simulation of one row takes beside the row.

    ``cases`` are all load cases there are.
    """

    yarn: YarnLaw
    contact: ContactLaw
    mesh: CellMesh
    cases: tuple[LoadCase[Any], ...]

    def case(self, name: str) -> LoadCase[Any]:
        """A load case by its name. Raises KeyError where there is none."""
        return {case.name: case for case in self.cases}[name]

    def __repr__(self) -> str:
        """One name and value a table: studies know their units by it."""
        tables = {name: getattr(self, name) for name in _LAWS} | {
            case.name: case for case in self.cases
        }
        return f"Settings({', '.join(f'{name}={table!r}' for name, table in tables.items())})"


def read_settings(families: str | Path, row: str) -> Settings:
    """Settings of one row: the shipped file's, the folder's own, then what the folder's file has for the row.

    Raises :class:`InputError` naming file, line, key, value and bound of all that is wrong.
    """
    cases = load_cases()
    sections: dict[str, Any] = {**_LAWS, **cases}
    checks = {table: section.checks for table, section in sections.items()}
    layers = [SettingsFile(shipped_families() / FILE, checks)]
    own = Path(families) / FILE
    if own.exists():
        layers.append(SettingsFile(own, checks))
    if problems := [problem for layer in layers for problem in layer.problems]:
        raise InputError(problems)

    merged: dict[str, dict[str, Any]] = {table: {} for table in sections}
    for layer in layers:
        for table, keys in layer.tables(row).items():
            merged[table] |= keys

    last = layers[-1]
    read = {
        table: _section(section, table, merged[table], last) for table, section in sections.items()
    }
    settings = Settings(
        **{table: read[table] for table in _LAWS},
        cases=tuple(read[name] for name in cases),
    )
    if np.linalg.eigvalsh(settings.yarn.compliance).min() <= 0:
        message = "the yarn's moduli and Poisson ratios give no stable material"
        raise InputError(last.problem("yarn", "nu12", message, row))

    return settings


def _section(section: Any, table: str, values: Mapping[str, Any], file: SettingsFile) -> Any:
    """A table as its value. Raises :class:`InputError` where a key is neither given nor has a value of its own."""
    needed = [field.name for field in fields(section) if field.default is MISSING]
    if missing := [key for key in needed if key not in values]:
        raise InputError(
            [file.problem(table, key, f"this key of [{table}] is missing") for key in missing]
        )
    return section(**values)
