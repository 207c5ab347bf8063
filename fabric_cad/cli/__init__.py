"""The command ``fabric-cad``."""

from .command import main

__all__ = ["main"]
