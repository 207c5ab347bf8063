"""How sections of a form are filled with quadrilaterals: one object a form, registered for its class."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import singledispatch
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..section.forms import Form
from ..section.frame import Frame
from ..support.errors import Problem
from .templates import Template

if TYPE_CHECKING:
    from .options import MeshOptions
    from .plan import Plan


class StripNodes(NamedTuple):
    """The nodes of a strip: their places in the section's outline, and their shares of the strip, 0 to 1."""

    slots: np.ndarray
    shares: np.ndarray

    @classmethod
    def evenly(cls, slots: np.ndarray) -> StripNodes:
        """Nodes that are equally far from each other."""
        return cls(slots, np.linspace(0.0, 1.0, len(slots)))


class Outline(NamedTuple):
    """A section's template, None where the sections choose it later, and each strip's nodes in its outline."""

    template: Template | None
    strips: dict[str, StripNodes]


class Around(NamedTuple):
    """Places in an outline by its four sides, ends shared: left to right and upwards."""

    bottom: np.ndarray
    right: np.ndarray
    top: np.ndarray
    left: np.ndarray

    @classmethod
    def of(cls, across: int, upright: int) -> Around:
        """Of an outline with ``across`` elements on bottom and top, ``upright`` on left and right::

              2a+u .. top .. a+u
        left  |               |  right
              0 ... bottom .. a
        """
        outline = 2 * (across + upright)
        around = np.arange(outline + 1) % outline
        return cls(
            bottom=around[: across + 1],
            right=around[across : across + upright + 1],
            top=around[across + upright : 2 * across + upright + 1][::-1],
            left=around[2 * across + upright :][::-1],
        )


class SectionMesh(ABC):
    """What mesh options, plans and counts ask of a form."""

    usual_through: int = 2
    """Layers through the thickness where nobody asks for a number."""

    @abstractmethod
    def columns(self, frame: Frame, side: str, across: int) -> list[np.ndarray]:
        """Places v (mm) of the nodes across the ``bottom`` or ``top``, strip by strip from left to right.

        The yarn that is crossed there has its layers of nodes at these places, so that contact
        nodes coincide.
        """

    @abstractmethod
    def column_count(self, frame: Frame, side: str, across: int) -> int:
        """Elements across the ``bottom`` or ``top``: those between the places of :meth:`columns`."""

    @abstractmethod
    def quadrilaterals(self, frame: Frame, across: int, through: int) -> int:
        """The number of them in a section's template."""

    @abstractmethod
    def outline(self, frame: Frame, across: int, through: int) -> Outline:
        """The template of a section and where its strips have their nodes."""

    def completed(self, plans: list[Plan], options: MeshOptions) -> list[Plan]:
        """The plans of all yarns, with what needs all their sections where anything does."""
        return plans

    def fault(self, options: MeshOptions) -> Problem | None:
        """Why a section cannot be filled so, if it cannot."""
        return None

    def layers(self, through: int) -> int:
        """The least number of layers from ``through`` on that fills a section."""
        return through

    def least_across(self, through: int) -> int:
        """Fewest columns that a target size may lead to."""
        return 2

    def usual_across(self, through: int) -> int:
        """Columns to have at least where ``through`` layers, but no columns, are asked for."""
        return 0


@singledispatch
def section_mesh(form: Form) -> SectionMesh:
    """How sections of a form are meshed."""
    raise NotImplementedError(f"{type(form).__name__} has no mesh")


def mesh_form(form: type[Form], mesh: SectionMesh) -> None:
    """Let sections of a class of forms be meshed so."""
    section_mesh.register(form, lambda _: mesh)
