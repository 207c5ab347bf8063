"""What keys of ``simulation.toml`` may hold, beside what :mod:`fabric_cad.measured.settings_files` has for any file."""

from __future__ import annotations

from collections.abc import Callable

from ..measured.settings_files import Check


def whole(least: int, most: int) -> Check:
    """A whole number in a closed interval."""
    return int, is_from_to(least, most), f"is not a whole number from {least} to {most}"


def is_from_to(least: float, most: float) -> Callable[[float], bool]:
    """Whether a number is in a closed interval."""
    return lambda value: least <= value <= most


def is_number(value: object) -> bool:
    """Whether a value is a number, which true and false are not."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)
