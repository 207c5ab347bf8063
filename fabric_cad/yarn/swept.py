"""A yarn as it is swept: control planes, trajectory, control sections and skin, made once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ..model.solved import SolvedFabric
from ..section.strips import Section
from ..weave.weaves import Yarn, yarns_of
from .planes import ControlPlane, control_planes
from .sections import control_sections
from .skin import Skin, skin
from .trajectory import Trajectory, trajectory


@dataclass(frozen=True, eq=False)
class SweptYarn:
    """One yarn of a fabric's cell.

    In each control plane stands a section, and the sections are swept along the trajectory
    (Fig. 9, 11, 12).
    """

    fabric: SolvedFabric
    yarn: Yarn

    @cached_property
    def planes(self) -> tuple[ControlPlane, ...]:
        """The control planes along the cell. (Fig. 12)"""
        return control_planes(self.fabric, self.yarn)

    @cached_property
    def trajectory(self) -> Trajectory:
        """The midline between the control planes. (Fig. 11, 16)"""
        return trajectory(self.fabric, self.yarn, self.planes)

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """The section in every control plane. (Fig. 9, 13, 17)"""
        return control_sections(self.fabric, self.yarn, self.planes)

    @cached_property
    def skin(self) -> Skin:
        """The exact surface, its two ends excepted."""
        return skin(self.trajectory, self.sections)


def swept_yarns(fabric: SolvedFabric) -> tuple[SweptYarn, ...]:
    """Every yarn of a fabric's cell, wefts first."""
    return tuple(SweptYarn(fabric, yarn) for yarn in yarns_of(fabric.weave.interlacement()))
