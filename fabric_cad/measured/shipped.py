"""Where the family tables and ``simulation.toml`` that come with the package are."""

from __future__ import annotations

from pathlib import Path


def shipped_families() -> Path:
    """Folder of the family tables that come with the package, ``simulation.toml`` beside them."""
    inside = Path(__file__).parents[1] / "families"  # an installed package
    beside = Path(__file__).parents[2] / "families"  # a checkout

    return inside if inside.is_dir() else beside
