"""What a composite is made of: ``composite.toml`` beside the family tables.

A file beside the tables stands alone; where there is none, the shipped one holds.
``[rows.NAME.TABLE]`` holds what differs for one row.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

from ..measured.settings_files import FINITE, POISSON, POSITIVE, TEXT, Check, SettingsFile
from ..measured.shipped import shipped_families
from ..support.errors import InputError, Problem
from .substances import CLOSEST_PACKING, ELASTIC, Constituents, Fibre, GivenYarn, Matrix
from .transverse import TransverselyIsotropic

FILE = "composite.toml"

_FRACTION: Check = (
    float,
    lambda v: 0 < v <= CLOSEST_PACKING,
    f"is not above 0 and up to {CLOSEST_PACKING:.4f}, where round fibres touch each other",
)
_WEIGHT: Check = (float, lambda v: 0 < v <= 1, "is not above 0 and up to 1")
_COMMON: dict[str, Check] = {"density_g_cm3": POSITIVE, "name": TEXT, "source": TEXT}
_ALONG_ACROSS: dict[str, Check] = {
    "expansion_1_per_K": FINITE,
    "expansion_2_per_K": FINITE,
    "conductivity_1_W_per_mK": POSITIVE,
    "conductivity_2_W_per_mK": POSITIVE,
}
_MODULI: dict[str, Check] = {
    "E1_MPa": POSITIVE,
    "E2_MPa": POSITIVE,
    "G12_MPa": POSITIVE,
    "nu12": POISSON,
}
_CHECKS: dict[str, dict[str, Check]] = {
    "fibre": {**_MODULI, "G23_MPa": POSITIVE, **_COMMON, **_ALONG_ACROSS},
    "matrix": {
        "E_MPa": POSITIVE,
        "nu": (float, lambda v: -1 < v < 0.5, "is not between -1 and 0.5"),
        "expansion_per_K": FINITE,
        "conductivity_W_per_mK": POSITIVE,
        **_COMMON,
    },
    "yarn": {
        "fibre_fraction": _FRACTION,
        "fibre_weight_fraction": _WEIGHT,
        **_MODULI,
        "nu23": POISSON,
        **_COMMON,
        **_ALONG_ACROSS,
    },
}
_NEEDED = {"fibre": ("E1_MPa", "E2_MPa", "G12_MPa", "G23_MPa", "nu12"), "matrix": ("E_MPa", "nu")}


def read_constituents(families: str | Path, row: str) -> Constituents:
    """The constituents of one row, from ``composite.toml`` in the folder of the tables, else the shipped one.

    Raises :class:`InputError` naming file, line, key, value and bound of all that is wrong or
    missing.
    """
    path = Path(families) / FILE
    file = SettingsFile(path if path.exists() else shipped_families() / FILE, _CHECKS)
    if file.problems:
        raise InputError(file.problems)

    tables = file.tables(row)
    if problems := list(_missing(file, tables, row)):
        raise InputError(problems)

    given = file.content.get("rows", {}).get(row, {}).get("yarn", {})
    constituents = Constituents(
        Matrix(**tables["matrix"]),
        Fibre(**tables["fibre"]) if "fibre" in tables else None,
        GivenYarn(**tables.get("yarn", {}), own_fraction="fibre_fraction" in given),
        file.path,
    )
    if problems := list(_unstable(file, constituents, row)):
        raise InputError(problems)

    return constituents


def _missing(file: SettingsFile, tables: dict[str, dict], row: str) -> Iterator[Problem]:
    """What a composite cannot be computed without."""
    own = [key for key in ELASTIC if key in tables.get("yarn", {})]
    lacking = [key for key in ELASTIC if own and key not in own]

    for key in lacking:
        yield file.problem(
            "yarn", key, f"is missing: the yarn's own constants are {', '.join(ELASTIC)}", row
        )

    for table, keys in _NEEDED.items():
        if table in tables:
            yield from (
                file.problem(table, key, f"is missing in [{table}]", row)
                for key in keys
                if key not in tables[table]
            )
        elif table == "matrix":
            yield file.problem(
                "", table, "there is no table [matrix]: what fills the space between the yarns", row
            )
        elif not own:
            message = "there is no table [fibre], nor are the yarn's own constants given in [yarn]"
            yield file.problem("", table, message, row)


def _unstable(file: SettingsFile, constituents: Constituents, row: str) -> Iterator[Problem]:
    """Materials that are not positive definite."""
    fibre, yarn = constituents.fibre, constituents.yarn
    if fibre and not fibre.law.nu23 < 1:
        bound = (
            f"is not above E2_MPa / 4 = {fibre.E2_MPa / 4:g}, as E2 / (2 G23) - 1 = nu23 < 1 asks"
        )
        yield file.problem("fibre", "G23_MPa", f"{fibre.G23_MPa:g} {bound}", row)
    elif fibre and not fibre.law.margin > 0:
        yield file.problem("fibre", "nu12", _too_far(fibre.law), row)

    if yarn.law and not yarn.law.margin > 0:
        yield file.problem("yarn", "nu12", _too_far(yarn.law), row)


def _too_far(law: TransverselyIsotropic) -> str:
    """What is said of a nu12 with which a law is not positive definite."""
    most = math.sqrt((1 - law.nu23) * law.E1_MPa / law.E2_MPa / 2)
    within = f"-+sqrt((1 - nu23) E1 / (2 E2)) = -+{most:.4g}"
    return f"{law.nu12:g} is not between {within}: the material is not positive definite"
