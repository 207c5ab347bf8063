"""How fine a mesh is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import ceil, isfinite
from numbers import Integral
from types import MappingProxyType

from ..model.solved import SolvedFabric
from ..support.errors import InputError, Problem
from ..support.memory import available_memory
from .count import hexahedra, needed_memory

MOST = 100_000
"""Most elements an option may ask for in one direction."""


@dataclass(frozen=True)
class MeshOptions:
    """Elements of a yarn, in numbers.

    ``across`` the width of a weft, ``crossing`` along its crossings (the warps have the two
    exchanged, since the nodes of a contact coincide), ``through`` the thickness, ``gap``
    along the gap between two crossings.
    """

    across: int = 12
    crossing: int = 12
    through: int = 2
    gap: int = 4

    def __post_init__(self) -> None:
        for name, least in (("across", 1), ("crossing", 1), ("through", 1), ("gap", 2)):
            value = getattr(self, name)
            if not isinstance(value, Integral):
                raise InputError(Problem(f"{value!r} is not a whole number", column=name))
            if value > MOST:
                shown = str(value) if value < 1e12 else "this"
                raise InputError(Problem(f"{shown} is above {MOST} (elements)", column=name))
            if value < least:
                raise InputError(Problem(f"{value} is not at least {least} (elements)", column=name))
        if self.gap % 2:
            raise InputError(
                Problem(f"{self.gap} is odd; the cell is cut at mid-gap, so a gap has an even number", column="gap")
            )

    def check(self, fabric: SolvedFabric, instead: Mapping[str, str] = MappingProxyType({})) -> None:
        """Raise :class:`InputError` where the section of a fabric cannot be filled so, or no memory holds the mesh.

        ``instead`` names, for an option that follows from another, that other one to blame.
        """
        self._check_section(fabric)
        needed, available = needed_memory(fabric, self), available_memory()
        if available is None or needed <= available:
            return
        finest = max(_DEFAULTS, key=lambda name: getattr(self, name) / _DEFAULTS[name])
        blamed = instead.get(finest, finest)
        asked = f"{self.across} across, {self.crossing} crossing, {self.through} through, {self.gap} in a gap"
        raise InputError(
            Problem(
                f"the mesh would have {hexahedra(fabric, self)} hexahedra ({asked}), which take about "
                f"{needed / 1e9:.3g} GB, more than the {available / 1e9:.3g} GB of memory there are; "
                f"{'raise' if blamed == 'size' else 'reduce'} {blamed}",
                column=blamed,
            )
        )

    def _check_section(self, fabric: SolvedFabric) -> None:
        if fabric.section == "round" and (self.through % 2 or self.through < 4):
            raise InputError(
                Problem(
                    f"{self.through} is not an even number of at least 4, as a round section needs", column="through"
                )
            )
        if fabric.section != "lenticular":
            return
        if self.through % 2:
            raise InputError(
                Problem(f"{self.through} is odd; a lenticular section has an even number of layers", column="through")
            )
        for name in ("across", "crossing"):
            if getattr(self, name) < 2 * self.through:
                raise InputError(
                    Problem(
                        f"{getattr(self, name)} is below {2 * self.through}, twice the {self.through} layers "
                        "through the thickness, which the pointed edges of a lenticular section take",
                        column=name,
                    )
                )


_DEFAULTS = asdict(MeshOptions())


def mesh_options(
    fabric: SolvedFabric,
    size: float | None = None,
    across: int | None = None,
    crossing: int | None = None,
    through: int | None = None,
    gap: int | None = None,
) -> MeshOptions:
    """Options for a fabric from what a user asked for; the rest follows.

    ``size`` is a target element size in mm. Without it the defaults hold, except that the
    pointed edges get three columns for every layer of ``through``, and that ``crossing``
    follows ``across``. Raises :class:`InputError`, also for a mesh that memory does not hold.
    """
    default = MeshOptions(through=4) if fabric.section == "round" else MeshOptions()
    given = {"across": across, "crossing": crossing, "through": through, "gap": gap}
    given = {name: value for name, value in given.items() if value is not None}
    if size is not None:
        asked = MeshOptions(**(_sized(fabric, size, given) | given))
        asked.check(fabric, dict.fromkeys(_DEFAULTS.keys() - given.keys(), "size"))
        return asked
    pointed = 3 * given.get("through", 0) if fabric.section == "lenticular" else 0
    given.setdefault("across", max(default.across, pointed))
    given.setdefault("crossing", given["across"])
    asked = replace(default, **given)
    asked.check(fabric)
    return asked


def _sized(fabric: SolvedFabric, size: float, given: Mapping[str, int]) -> dict[str, int]:
    """The numbers of elements that a target size (mm) asks for, where ``given`` says nothing else."""
    if not (size > 0 and isfinite(size)):
        raise InputError(Problem(f"{size:g} is not above 0" + " and finite" * (size > 0), column="size"))

    def parts(length: float) -> int:
        if length > MOST * size:
            raise InputError(Problem(f"{size:g} makes more than {MOST} elements of {length:.4g} mm", column="size"))
        return ceil(length / size)

    pointed, rounded = fabric.section == "lenticular", fabric.section == "round"
    through = given.get("through")
    if through is None:
        through = parts(max(fabric.weft.thickness, fabric.warp.thickness))
        through += through % 2 if pointed or rounded else 0
        through = max(through, 4) if rounded else through
    least = 2 * through if pointed else 2
    spare = [fabric.directions[d].crossed_spacing - fabric.crossed(d).width for d in ("weft", "warp")]
    return {
        "across": max(least, parts(fabric.weft.width)),
        "crossing": max(least, parts(fabric.warp.width)),
        "through": through,
        "gap": 2 * parts(max(spare) / 2),
    }
