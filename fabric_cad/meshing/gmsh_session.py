"""The door to gmsh: no other module imports it."""

from __future__ import annotations

import atexit
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..support.interrupts import uninterrupted

HEXAHEDRON, QUADRILATERAL = 5, 3
"""Types of elements, by gmsh's numbers."""


@contextmanager
def gmsh_session() -> Iterator[Any]:
    """gmsh with an empty model and its own options; started once a process and ended with it."""
    with uninterrupted():
        import gmsh

        if not gmsh.isInitialized():
            gmsh.initialize(["-nopopup"], readConfigFiles=False, interruptible=False)
            atexit.register(_end, gmsh)

    try:
        gmsh.option.restoreDefaults()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.AbortOnError", 2)
        yield gmsh
    finally:
        gmsh.clear()


def _end(gmsh: Any) -> None:
    if gmsh.isInitialized():
        gmsh.finalize()
