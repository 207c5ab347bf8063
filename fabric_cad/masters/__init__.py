"""The generic models, one per weave type; each opens in CQ-editor as it is."""

from __future__ import annotations

from importlib import import_module

from ..model.solved import SolvedFabric
from ..support.errors import expect


def build_cell(fabric: SolvedFabric):
    """The :class:`~fabric_cad.cad.Cell` of a solved fabric, built by the master of its family.

    Raises :class:`~fabric_cad.support.errors.BuildError` where OCCT makes no valid solid of a yarn.
    """
    expect(fabric, SolvedFabric, "fabric", " (identify(table)['name'] gives one)")
    return import_module(f"{__name__}.{fabric.family}").cell(fabric)
