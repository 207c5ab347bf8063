"""Reading a study from its TOML file; all that is wrong in it is listed at once."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..cell.pipeline import find_row
from ..composite.constituents import read_constituents
from ..measured.columns import is_safe_name
from ..measured.family import Family
from ..simulation.loads import load_cases
from ..simulation.settings import Settings, read_settings
from ..support.errors import InputError, quoted
from ..support.toml_files import read_toml
from .design import DESIGNS, RANDOM
from .factor_reader import read_factors
from .factors import Factor, levels
from .figures import STIFFNESS
from .names import figure_fault
from .study_file import StudyFile
from .units import Work, depths

_KEYS = {
    "base": str,
    "depth": str,
    "design": str,
    "samples": int,
    "seed": int,
    "figures": list,
    "limit_seconds": float,
    "keep": bool,
    "factors": dict,
    "mesh": dict,
}
_MESH = {"size": float, "across": int, "crossing": int, "through": int, "gap": int}

MOST_UNITS = 10_000_000
"""Most units a study may have."""


@dataclass(frozen=True)
class Study:
    """A study as its file defines it; ``base`` is a table of one row.

    ``factors`` maps columns of that table to what varies, ``work`` is what is done with every unit,
    ``figures`` names the figures whose sensitivity is asked for (none: the usual ones).
    """

    name: str
    base: Family
    factors: Mapping[str, Factor]
    design: str
    samples: int
    seed: int
    work: Work
    figures: tuple[str, ...]
    keep: bool


def read_study(path: str | Path, families: str | Path = "families") -> Study:
    """Read a study and its base row from the family tables of a folder.

    Raises :class:`InputError` with every problem of the file: its place, key, value and bound.
    """
    content, lines = read_toml(path)
    file = StudyFile(Path(path), content, lines)
    found = _known_values(file)
    design, depth = found.get("design"), found.get("depth", "identify")
    _check_samples(file, found)
    if "limit_seconds" in found and not found["limit_seconds"] > 0:
        file.wrong(f"{found['limit_seconds']:g} is not above 0", "limit_seconds")
    figures = _figures(file, found)
    mesh = file.of_kind(found.get("mesh", {}), _MESH, "mesh.")
    if mesh and depth in ("identify", "cell"):
        file.wrong(f"has no meaning at depth {depth}", "mesh")

    base = _base(file, found.get("base"), families)
    factors: dict[str, Factor] = {}
    settings = constituents = None
    if base is not None:
        _check_mesh(file, base, mesh)
        factors = read_factors(file, base, found.get("factors", {}), design)
        if not file.problems:
            _check_size(file, factors, design, found.get("samples", 0))
        if depth in load_cases():
            settings = read_settings(families, base.names[0])
        elif depth == STIFFNESS:
            constituents = read_constituents(families, base.names[0])

        if "depth" in found or "depth" not in content:
            _check_figures(file, figures, depth, settings)

    if file.problems or base is None or design is None:
        raise InputError(file.problems)
    return Study(
        name=file.path.stem,
        base=base,
        factors=factors,
        design=design,
        samples=found.get("samples", 0),
        seed=found.get("seed", 0),
        work=Work(depth, mesh, float(found.get("limit_seconds", 600.0)), settings, constituents),
        figures=tuple(figures),
        keep=found.get("keep", False),
    )


def _known_values(file: StudyFile) -> dict:
    """The values of the file's keys that are of their kind, and among those it may be."""
    found = file.of_kind(file.content, _KEYS)
    for key in ("base", "design", "factors"):
        if key not in file.content:
            file.wrong("this key is missing", key)

    stem = file.path.stem
    if not is_safe_name(stem):
        message = "cannot name a folder of results; letters, digits, '_' and '-' only"
        file.wrong(f"{quoted(stem)} {message}", "")

    for key, known in (("design", DESIGNS), ("depth", depths())):
        if key in found and not file.one_of(found[key], known, key):
            del found[key]

    return found


def _figures(file: StudyFile, found: Mapping) -> list[str]:
    figures = found.get("figures", [])
    if all(isinstance(name, str) for name in figures):
        return figures
    file.wrong(f"{quoted(figures)} is not a list of texts", "figures")
    return []


def _check_figures(
    file: StudyFile, figures: list[str], depth: str, settings: Settings | None
) -> None:
    for name in figures:
        if fault := figure_fault(name, depth, settings):
            file.wrong(fault, "figures")


def _check_samples(file: StudyFile, found: Mapping) -> None:
    """What is wrong with the number of samples and the seed of a design."""
    design = found.get("design")
    for key, least in (("samples", 1), ("seed", 0)):
        if key in found and found[key] < least:
            file.wrong(f"{found[key]} is not at least {least}", key)
        elif key in found and design is not None and design not in RANDOM:
            file.wrong(f"has no meaning in a {design} design", key)

    if design in RANDOM and "samples" not in file.content:
        message = f"this key is missing; a {design} design needs the number of samples"
        file.wrong(message, "samples")

    samples = found.get("samples", 1)
    if design == "sobol" and samples > 0 and samples & (samples - 1):
        near = 2 ** round(math.log2(samples))
        message = "is not a power of two, as a Sobol sequence needs"
        file.wrong(f"{samples} {message}; {near} is the nearest", "samples")


def _base(file: StudyFile, name: str | None, families: str | Path) -> Family | None:
    """The base row; where there is none, its errors become problems of the file."""
    if name is None:
        return None
    try:
        return find_row(families, name)[0]
    except InputError as error:
        for problem in error.problems:
            if problem.line is None:
                file.wrong(str(problem), "base")
            else:
                file.problems.append(problem)
    return None


def _check_mesh(file: StudyFile, base: Family, mesh: Mapping) -> None:
    """What the base row cannot be meshed with."""
    from ..meshing.options import mesh_options
    from ..model.identification import identify

    try:
        fabric = identify(base)[base.names[0]]
    except InputError:
        return  # a factor may make it one

    try:
        mesh_options(fabric, **mesh)
    except InputError as error:
        for problem in error.problems:
            file.wrong(problem.message, f"mesh.{problem.column}")


def _check_size(
    file: StudyFile, factors: Mapping[str, Factor], design: str | None, samples: int
) -> None:
    if design == "grid":
        units = math.prod(len(levels(factor)) for factor in factors.values())
    else:
        units = samples * (len(factors) + 2 if design == "sobol" else 1)
    if units > MOST_UNITS:
        key = "samples" if design in RANDOM else "factors"
        file.wrong(f"{units} units are more than {MOST_UNITS}", key)
