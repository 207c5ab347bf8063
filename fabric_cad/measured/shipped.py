"""Where the family tables that come with the package are, and the TOML files beside them."""

from __future__ import annotations

from pathlib import Path


def shipped_families() -> Path:
    """Folder of the family tables that come with the package, the shipped TOML files beside them."""
    inside = Path(__file__).parents[1] / "families"  # an installed package
    beside = Path(__file__).parents[2] / "families"  # a checkout

    return inside if inside.is_dir() else beside
