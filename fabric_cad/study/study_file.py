"""A study's TOML file as it is read: its content, the lines of its keys, and all that is wrong in it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from ..support.errors import Problem, did_you_mean, quoted

KINDS: Mapping[type, str] = {
    str: "a text",
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    list: "a list",
    dict: "a table",
}
"""What a person calls a kind of value."""


def is_kind(value: object, kind: type) -> bool:
    """True where a value of TOML is of a kind.

    A whole number is a number, true and false are none.
    """
    if kind is float:
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return number and math.isfinite(value)  # type: ignore[arg-type]
    return isinstance(value, kind) and not (kind is int and isinstance(value, bool))


@dataclass(frozen=True)
class StudyFile:
    """The content of a study's file.

    ``lines`` are those of its keys, ``problems`` are gathered as it is read.
    """

    path: Path
    content: Mapping
    lines: Mapping[str, int]
    problems: list[Problem] = field(default_factory=list)

    def wrong(self, message: str, key: str, shown: str = "") -> None:
        """Note a problem at a key, which is told as ``shown`` where that says more."""
        line = self.lines.get(key)
        while line is None and "." in key:  # within an inline table: the line of the whole
            key = key.rpartition(".")[0]
            line = self.lines.get(key)
        self.problems.append(Problem(message, str(self.path), line, shown or key))

    def of_kind(self, content: Mapping, keys: Mapping[str, type], prefix: str = "") -> dict:
        """The values that are of their kind; the others, and unknown keys, are problems."""
        found = {}
        for name, value in content.items():
            if name not in keys:
                hint = did_you_mean(name.lower(), keys, cutoff=0.3)
                self.wrong(f"unknown key{hint}", prefix + name, name)
            elif not is_kind(value, keys[name]):
                self.wrong(f"{quoted(value)} is not {KINDS[keys[name]]}", prefix + name)
            else:
                found[name] = value
        return found

    def one_of(self, value: str, known: Iterable[str], key: str) -> bool:
        """Whether a text is one of the known ones; a problem where it is not."""
        known = tuple(known)
        if value in known:
            return True
        hint = did_you_mean(value, known, cutoff=0.3)
        self.wrong(f"{quoted(value)} is none of {', '.join(known)}{hint}", key)
        return False
