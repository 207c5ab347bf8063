"""Reading a study from its TOML file; all that is wrong in it is listed at once."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..cell.pipeline import find_row
from ..measured.columns import CHOICES, MEASURED, OTHER_UNITS, WEAVE_COLUMNS, is_safe_name, kept_column
from ..measured.family import Family
from ..measured.rules import bound_fault
from ..simulation.loads import load_cases
from ..simulation.settings import Settings, read_settings
from ..support.errors import InputError, Problem, did_you_mean, quoted
from ..support.toml_files import read_toml
from ..weave.faults import weave_fault
from .design import DESIGNS, RANDOM
from .factors import Factor, Normal, Uniform, Values
from .names import figure_fault
from .rows import base_value, weave_cells
from .units import Work, depths

_MESH = {"size": float, "across": int, "crossing": int, "through": int, "gap": int}
_FACTOR_KEYS = {"uniform": ("from", "to", "steps"), "normal": ("mean", "std")}
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
    return _Reader(Path(path), content, lines).read(families)


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
_KINDS = {
    str: "a text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    list: "a list",
    dict: "a table",
}


def _is(value: object, kind: type) -> bool:
    if kind is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    return isinstance(value, kind) and not (kind is int and isinstance(value, bool))


class _Reader:
    """Reads one study, gathering problems as it goes."""

    def __init__(self, path: Path, content: dict, lines: dict[str, int]) -> None:
        self.path, self.content, self.lines = path, content, lines
        self.problems: list[Problem] = []

    def wrong(self, message: str, key: str, shown: str = "") -> None:
        line = self.lines.get(key)
        while line is None and "." in key:  # within an inline table: the line of the whole
            key = key.rpartition(".")[0]
            line = self.lines.get(key)
        self.problems.append(Problem(message, str(self.path), line, shown or key))

    def unknown(self, name: str, known, key: str, what: str) -> None:
        self.wrong(f"unknown {what}{did_you_mean(name.lower(), known, cutoff=0.3)}", key, name)

    def of_kind(self, content: Mapping, keys: Mapping[str, type], prefix: str = "") -> dict:
        """The values that are of their kind; the others, and unknown keys, are problems."""
        found = {}
        for name, value in content.items():
            if name not in keys:
                self.unknown(name, keys, prefix + name, "key")
            elif not _is(value, keys[name]):
                self.wrong(f"{quoted(value)} is not {_KINDS[keys[name]]}", prefix + name)
            else:
                found[name] = value
        return found

    def read(self, families: str | Path) -> Study:
        found = self.of_kind(self.content, _KEYS)
        for key in ("base", "design", "factors"):
            if key not in self.content:
                self.wrong("this key is missing", key)
        if not is_safe_name(self.path.stem):
            self.wrong(
                f"{quoted(self.path.stem)} cannot name a folder of results; letters, digits, '_' and '-' only", ""
            )
        for key, known in (("design", DESIGNS), ("depth", depths())):
            if key in found and found[key] not in known:
                hint = did_you_mean(found[key], known, cutoff=0.3)
                self.wrong(f"{quoted(found.pop(key))} is none of {', '.join(known)}{hint}", key)
        design, depth = found.get("design"), found.get("depth", "identify")
        self.check_samples(found, design)
        if "limit_seconds" in found and not found["limit_seconds"] > 0:
            self.wrong(f"{found['limit_seconds']:g} is not above 0", "limit_seconds")
        figures = found.get("figures", [])
        if not all(isinstance(each, str) for each in figures):
            self.wrong(f"{quoted(figures)} is not a list of texts", "figures")
            figures = []
        mesh = self.of_kind(found.get("mesh", {}), _MESH, "mesh.")
        if mesh and depth in ("identify", "cell"):
            self.wrong(f"has no meaning at depth {depth}", "mesh")
        base = self.base(found.get("base"), families)
        if base is not None:
            self.check_mesh(base, mesh)
        factors = self.factors(base, found.get("factors", {}), design) if base is not None else {}
        if base is not None and not self.problems:
            self.check_size(factors, design, found.get("samples", 0))
        settings = None
        if depth in load_cases() and base is not None:
            settings = read_settings(families, base.names[0])
        if base is not None and ("depth" in found or "depth" not in self.content):
            self.check_figures(figures, depth, settings)
        if self.problems or base is None or design is None:
            raise InputError(self.problems)
        return Study(
            name=self.path.stem,
            base=base,
            factors=factors,
            design=design,
            samples=found.get("samples", 0),
            seed=found.get("seed", 0),
            work=Work(depth, mesh, float(found.get("limit_seconds", 600.0)), settings),
            figures=tuple(figures),
            keep=found.get("keep", False),
        )

    def check_figures(self, figures: list[str], depth: str, settings: Settings | None) -> None:
        for name in figures:
            if fault := figure_fault(name, depth, settings):
                self.wrong(fault, "figures")

    def check_samples(self, found: dict, design: str | None) -> None:
        for key, least in (("samples", 1), ("seed", 0)):
            if key in found and found[key] < least:
                self.wrong(f"{found[key]} is not at least {least}", key)
            elif key in found and design is not None and design not in RANDOM:
                self.wrong(f"has no meaning in a {design} design", key)
        if design in RANDOM and "samples" not in self.content:
            self.wrong(f"this key is missing; a {design} design needs the number of samples", "samples")
        samples = found.get("samples", 1)
        if design == "sobol" and samples > 0 and samples & (samples - 1):
            near = 2 ** round(math.log2(samples))
            self.wrong(f"{samples} is not a power of two, as a Sobol sequence needs; {near} is the nearest", "samples")

    def base(self, name: str | None, families: str | Path) -> Family | None:
        if name is None:
            return None
        try:
            return find_row(families, name)[0]
        except InputError as error:
            for problem in error.problems:
                if problem.line is None:
                    self.wrong(str(problem), "base")
                else:
                    self.problems.append(problem)
        return None

    def check_mesh(self, base: Family, mesh: Mapping) -> None:
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
                self.wrong(problem.message, f"mesh.{problem.column}")

    def factors(self, base: Family, content: Mapping, design: str | None) -> dict[str, Factor]:
        if not content and "factors" in self.content and isinstance(self.content["factors"], dict):
            self.wrong("is empty; a study needs at least one factor", "factors")
        weave = WEAVE_COLUMNS[base.family]
        known = [*weave, *CHOICES, *MEASURED, *(other for other in OTHER_UNITS if not other.endswith("_std"))]
        factors: dict[str, Factor] = {}
        kept: dict[str, str] = {}
        for column, value in content.items():
            key, shown = f"factors.{column}", f"factor {column}"
            if column not in known:
                hint = did_you_mean(column.lower(), known)
                self.wrong(f"no column of {base.family}.csv that can vary{hint}", key, shown)
                continue
            same = kept.setdefault(kept_column(column)[0], column)
            if same != column:
                self.wrong(f"the same quantity as factor {same}, in another unit", key, shown)
            if column.startswith("warp_") and base.balanced[0]:
                message = (
                    f"the base row {base.names[0]} is balanced (every warp cell is empty); its weft cells vary both"
                )
                self.wrong(message, key, shown)
                continue
            factor: Factor | None
            if column in (*weave, *CHOICES):
                factor = self.choice(base, column, value, key, shown)
            else:
                factor = self.number(base, column, value, key, shown, design)
            if factor is not None:
                factors[column] = factor
        return factors

    def choice(self, base: Family, column: str, value: object, key: str, shown: str) -> Values | None:
        """A factor of a weave column or of texts: a list."""
        if not isinstance(value, list) or not value:
            self.wrong(f"{quoted(value)} is not a list of values, as this column needs", key, shown)
            return None
        known, before = CHOICES.get(column), len(self.problems)
        kind = str if known or column == "pattern" else int
        for each in value:
            if not _is(each, kind):
                self.wrong(f"{quoted(each)} is not {_KINDS[kind]}", key, shown)
            elif known and each not in known:
                self.wrong(f"{quoted(each)} is none of {', '.join(known)}", key, shown)
            elif not known and len(value) == 1:
                fault = weave_fault(base.family, weave_cells(base) | {column: each})
                if fault:
                    self.wrong(fault[1], key, shown)
        return Values(tuple(value)) if len(self.problems) == before else None

    def number(
        self, base: Family, column: str, value: object, key: str, shown: str, design: str | None
    ) -> Factor | None:
        """A factor of a measured column: a list, a range or a distribution."""
        before = len(self.problems)
        if isinstance(value, list):
            if not value:
                self.wrong("is an empty list", key, shown)
            for each in value:
                self.check_bound(base, column, each, key, shown)
            return Values(tuple(map(float, value))) if len(self.problems) == before else None
        if isinstance(value, str):
            value = {"distribution": value}
        if not isinstance(value, dict):
            self.wrong(
                f"{quoted(value)} is not a list, a range like {{ from = 1, to = 2 }} or a distribution", key, shown
            )
            return None
        kind = value.get("distribution", "uniform" if "from" in value or "to" in value else None)
        if kind not in _FACTOR_KEYS:
            self.wrong(f"{quoted(kind)} is none of the distributions {', '.join(_FACTOR_KEYS)}", key, shown)
            return None
        given = {name: each for name, each in value.items() if name != "distribution"}
        for name, each in given.items():
            if name not in _FACTOR_KEYS[kind]:
                those = f"; those are {', '.join(_FACTOR_KEYS[kind])}"
                hint = did_you_mean(name, _FACTOR_KEYS[kind], cutoff=0.3) or those
                self.wrong(f"{name}: unknown key{hint}", f"{key}.{name}", shown)
            elif not _is(each, int if name == "steps" else float):
                self.wrong(f"{name}: {quoted(each)} is not {_KINDS[int if name == 'steps' else float]}", key, shown)
        if len(self.problems) > before:
            return None
        read = self.uniform if kind == "uniform" else self.normal
        factor: Factor | None = read(base, column, given, key, shown)
        if design == "grid" and len(self.problems) == before and not (given.get("steps") and kind == "uniform"):
            self.wrong("a grid takes a list, or a range with steps", key, shown)
        return factor if len(self.problems) == before else None

    def check_bound(self, base: Family, column: str, value: object, key: str, shown: str) -> None:
        """What the column's bounds say of one value; the rest of its row is the unit's own business."""
        if not _is(value, float):
            self.wrong(f"{quoted(value)} is not a number", key, shown)
        elif isinstance(value, (int, float)) and (fault := bound_fault(column, value)):
            self.wrong(fault, key, shown)

    def scatter(self, base: Family, column: str, key: str, shown: str) -> tuple[float, float] | None:
        """Mean and standard deviation of the base row's measurement, in the unit of the column."""
        kept, unit = kept_column(column)
        mean, std = base_value(base, column), float(base.scatter[kept][0]) / unit
        if math.isnan(mean) or not std > 0:
            missing = column if math.isnan(mean) else f"{column}_std"
            self.wrong(f"the base row {base.names[0]} has no {missing}; give it here or there", key, shown)
            return None
        return mean, std

    def uniform(self, base: Family, column: str, given: Mapping, key: str, shown: str) -> Uniform | None:
        if given.get("steps", 2) < 2:
            self.wrong(f"steps: {given['steps']} is not at least 2", key, shown)
        if not {"from", "to"} & set(given):
            found = self.scatter(base, column, key, shown)
            if found is None:
                return None
            half = math.sqrt(3) * found[1]  # the same standard deviation
            return Uniform(found[0] - half, found[0] + half, given.get("steps"))
        for end in ("from", "to"):
            if end not in given:
                self.wrong(f"{end}: this key is missing", key, shown)
            else:
                self.check_bound(base, column, given[end], key, shown)
        if {"from", "to"} <= set(given) and not given["from"] < given["to"]:
            self.wrong(f"from {given['from']:g} is not below to {given['to']:g}", key, shown)
            return None
        return Uniform(float(given["from"]), float(given["to"]), given.get("steps")) if len(given) > 1 else None

    def normal(self, base: Family, column: str, given: Mapping, key: str, shown: str) -> Normal | None:
        mean, std = given.get("mean"), given.get("std")
        if std is not None and not std > 0:
            self.wrong(f"std: {std:g} is not above 0", key, shown)
        if mean is not None:
            self.check_bound(base, column, mean, key, shown)
        if mean is None and std is not None and not math.isnan(base_value(base, column)):
            mean = base_value(base, column)
        if mean is None or std is None:
            found = self.scatter(base, column, key, shown)
            if found is None:
                return None
            mean, std = mean or found[0], std or found[1]
        return Normal(float(mean), float(std))

    def check_size(self, factors: Mapping[str, Factor], design: str | None, samples: int) -> None:
        from .factors import levels

        if design == "grid":
            units = math.prod(len(levels(factor)) for factor in factors.values())
        else:
            units = samples * (len(factors) + 2 if design == "sobol" else 1)
        if units > MOST_UNITS:
            self.wrong(f"{units} units are more than {MOST_UNITS}", "samples" if design in RANDOM else "factors")
