"""Reading what varies in a study: lists, ranges and distributions of a row's columns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from ..measured.columns import CHOICES, MEASURED, OTHER_UNITS, WEAVE_COLUMNS, kept_column
from ..measured.family import Family
from ..measured.rules import bound_fault
from ..support.errors import did_you_mean, quoted
from ..weave.faults import weave_fault
from .factors import Factor, Normal, Uniform, Values
from .rows import base_value, weave_cells
from .study_file import KINDS, StudyFile, is_kind

_DISTRIBUTION_KEYS = {"uniform": ("from", "to", "steps"), "normal": ("mean", "std")}


def read_factors(
    file: StudyFile, base: Family, content: Mapping, design: str | None
) -> dict[str, Factor]:
    """The factors of a study by column; what is wrong with them becomes problems of the file."""
    if not content and isinstance(file.content.get("factors"), dict):
        file.wrong("is empty; a study needs at least one factor", "factors")

    factors: dict[str, Factor] = {}
    kept: dict[str, str] = {}
    for column, value in content.items():
        reader = _FactorReader(file, base, column, design)
        if not reader.can_vary():
            continue

        same = kept.setdefault(kept_column(column)[0], column)
        if same != column:
            reader.wrong(f"the same quantity as factor {same}, in another unit")
        if reader.is_balanced_away():
            continue

        factor = reader.read(value)
        if factor is not None:
            factors[column] = factor

    return factors


@dataclass(frozen=True)
class _FactorReader:
    """Reads the factor of one column of a base row."""

    file: StudyFile
    base: Family
    column: str
    design: str | None

    def wrong(self, message: str, part: str = "") -> None:
        """Note a problem of this factor, or of one key of it."""
        key = f"factors.{self.column}" + (f".{part}" if part else "")
        self.file.wrong(message, key, f"factor {self.column}")

    def can_vary(self) -> bool:
        """Whether the column is one of the base row's table that a study may vary."""
        weave = WEAVE_COLUMNS[self.base.family]
        units = (other for other in OTHER_UNITS if not other.endswith("_std"))
        known = [*weave, *CHOICES, *MEASURED, *units]
        if self.column in known:
            return True

        hint = did_you_mean(self.column.lower(), known)
        self.wrong(f"no column of {self.base.family}.csv that can vary{hint}")
        return False

    def is_balanced_away(self) -> bool:
        """Whether it is a warp's column of a balanced row, whose weft cells vary both."""
        if not (self.column.startswith("warp_") and self.base.balanced[0]):
            return False

        name = self.base.names[0]
        self.wrong(
            f"the base row {name} is balanced (every warp cell is empty); its weft cells vary both"
        )
        return True

    def read(self, value: object) -> Factor | None:
        """The factor, None where something is wrong with it."""
        before = len(self.file.problems)
        factor: Factor | None
        if self.column in (*WEAVE_COLUMNS[self.base.family], *CHOICES):
            factor = self._choice(value)
        else:
            factor = self._number(value)
        return factor if len(self.file.problems) == before else None

    def _choice(self, value: object) -> Values | None:
        """A factor of a weave column or of texts: a list."""
        if not isinstance(value, list) or not value:
            self.wrong(f"{quoted(value)} is not a list of values, as this column needs")
            return None

        known = CHOICES.get(self.column)
        kind = str if known or self.column == "pattern" else int
        for choice in value:
            if not is_kind(choice, kind):
                self.wrong(f"{quoted(choice)} is not {KINDS[kind]}")
            elif known and choice not in known:
                self.wrong(f"{quoted(choice)} is none of {', '.join(known)}")
            elif not known and len(value) == 1:
                cells = weave_cells(self.base) | {self.column: choice}
                if fault := weave_fault(self.base.family, cells):
                    self.wrong(fault[1])

        return Values(tuple(value))

    def _number(self, value: object) -> Factor | None:
        """A factor of a measured column: a list, a range or a distribution."""
        if isinstance(value, list):
            return self._list(value)
        if isinstance(value, str):
            value = {"distribution": value}
        if not isinstance(value, dict):
            expected = "a list, a range like { from = 1, to = 2 } or a distribution"
            self.wrong(f"{quoted(value)} is not {expected}")
            return None

        kind = value.get("distribution", "uniform" if "from" in value or "to" in value else None)
        if kind not in _DISTRIBUTION_KEYS:
            known = ", ".join(_DISTRIBUTION_KEYS)
            self.wrong(f"{quoted(kind)} is none of the distributions {known}")
            return None

        given = {name: number for name, number in value.items() if name != "distribution"}
        before = len(self.file.problems)
        self._check_keys(given, _DISTRIBUTION_KEYS[kind])
        if len(self.file.problems) > before:
            return None

        factor = self._uniform(given) if kind == "uniform" else self._normal(given)
        has_steps = kind == "uniform" and bool(given.get("steps"))
        if self.design == "grid" and len(self.file.problems) == before and not has_steps:
            self.wrong("a grid takes a list, or a range with steps")
        return factor

    def _list(self, values: list) -> Values | None:
        before = len(self.file.problems)
        if not values:
            self.wrong("is an empty list")
        for value in values:
            self._check_bound(value)
        return Values(tuple(map(float, values))) if len(self.file.problems) == before else None

    def _check_keys(self, given: Mapping, known: tuple[str, ...]) -> None:
        """What is wrong with the keys of a range or a distribution, and with their values' kinds."""
        for name, value in given.items():
            kind = int if name == "steps" else float
            if name not in known:
                hint = did_you_mean(name, known, cutoff=0.3) or f"; those are {', '.join(known)}"
                self.wrong(f"{name}: unknown key{hint}", name)
            elif not is_kind(value, kind):
                self.wrong(f"{name}: {quoted(value)} is not {KINDS[kind]}")

    def _check_bound(self, value: object) -> None:
        """What the column's bounds say of one value.

        The rest of its row is the unit's own business.
        """
        if not is_kind(value, float):
            self.wrong(f"{quoted(value)} is not a number")
        elif isinstance(value, (int, float)) and (fault := bound_fault(self.column, value)):
            self.wrong(fault)

    def _scatter(self) -> tuple[float, float] | None:
        """Mean and standard deviation of the base row's measurement, in the unit of the column."""
        kept, unit = kept_column(self.column)
        mean, std = base_value(self.base, self.column), float(self.base.scatter[kept][0]) / unit
        if math.isnan(mean) or not std > 0:
            missing = self.column if math.isnan(mean) else f"{self.column}_std"
            self.wrong(f"the base row {self.base.names[0]} has no {missing}; give it here or there")
            return None
        return mean, std

    def _uniform(self, given: Mapping) -> Uniform | None:
        steps = given.get("steps")
        if steps is not None and steps < 2:
            self.wrong(f"steps: {steps} is not at least 2")

        if not {"from", "to"} & set(given):
            if (scatter := self._scatter()) is None:
                return None
            mean, std = scatter
            half = math.sqrt(3) * std  # the same standard deviation
            return Uniform(mean - half, mean + half, steps)

        for end in ("from", "to"):
            if end not in given:
                self.wrong(f"{end}: this key is missing")
            else:
                self._check_bound(given[end])

        if not {"from", "to"} <= set(given):
            return None

        if not given["from"] < given["to"]:
            self.wrong(f"from {given['from']:g} is not below to {given['to']:g}")
            return None

        return Uniform(float(given["from"]), float(given["to"]), steps)

    def _normal(self, given: Mapping) -> Normal | None:
        mean, std = given.get("mean"), given.get("std")
        if std is not None and not std > 0:
            self.wrong(f"std: {std:g} is not above 0")
        if mean is not None:
            self._check_bound(mean)

        measured = base_value(self.base, self.column)
        if mean is None and std is not None and not math.isnan(measured):
            mean = measured
        if mean is None or std is None:
            if (scatter := self._scatter()) is None:
                return None
            mean, std = mean or scatter[0], std or scatter[1]
        return Normal(float(mean), float(std))
