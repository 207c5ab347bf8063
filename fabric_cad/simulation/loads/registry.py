"""The load cases that there are, by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from .case import LoadCase

_TAKEN = ("yarn", "contact", "mesh", "rows")  # tables of simulation.toml that are no case's
_CASES: dict[str, type[LoadCase[Any]]] = {}


def register(case: type[LoadCase[Any]]) -> None:
    """Make a load case known. Raises ValueError where its name is taken."""
    if case.name in _TAKEN or case.name in _CASES:
        raise ValueError(f"a load case cannot be called {case.name}: the name is taken")
    _CASES[case.name] = case


def unregister(name: str) -> None:
    """Forget a load case."""
    del _CASES[name]


def load_cases() -> Mapping[str, type[LoadCase[Any]]]:
    """Every load case by name, in the order in which they were registered."""
    return MappingProxyType(_CASES)
