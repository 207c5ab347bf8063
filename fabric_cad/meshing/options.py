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
from .section_mesh import section_mesh

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
            value: int = getattr(self, name)
            if not isinstance(value, Integral):
                raise InputError(Problem(f"{value!r} is not a whole number", column=name))
            if value > MOST:
                shown = str(value) if value < 1e12 else "this"
                raise InputError(Problem(f"{shown} is above {MOST} (elements)", column=name))

            if value < least:
                raise InputError(
                    Problem(f"{value} is not at least {least} (elements)", column=name)
                )

        if self.gap % 2:
            raise InputError(
                Problem(
                    f"{self.gap} is odd; the cell is cut at mid-gap, so a gap has an even number",
                    column="gap",
                )
            )

    def check(
        self, fabric: SolvedFabric, instead: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        """Raise :class:`InputError` where the section of a fabric cannot be filled so, or no memory holds the mesh.

        ``instead`` names, for an option that follows from another, that other one to blame.
        """
        if fault := section_mesh(fabric.form).fault(self):
            raise InputError(fault)
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
    mesh = section_mesh(fabric.form)
    default = MeshOptions(through=mesh.usual_through)
    asked_for = {"across": across, "crossing": crossing, "through": through, "gap": gap}
    given = {name: value for name, value in asked_for.items() if value is not None}
    if size is not None:
        asked = MeshOptions(**(_sized(fabric, size, given) | given))
        asked.check(fabric, dict.fromkeys(_DEFAULTS.keys() - given.keys(), "size"))
        return asked

    given.setdefault("across", max(default.across, mesh.usual_across(given.get("through", 0))))
    given.setdefault("crossing", given["across"])
    asked = replace(default, **given)
    asked.check(fabric)
    return asked


def _sized(fabric: SolvedFabric, size: float, given: Mapping[str, int]) -> dict[str, int]:
    """The numbers of elements that a target size (mm) asks for, where ``given`` says nothing else."""
    if not (size > 0 and isfinite(size)):
        raise InputError(
            Problem(f"{size:g} is not above 0" + " and finite" * (size > 0), column="size")
        )

    def parts(length: float) -> int:
        if length > MOST * size:
            raise InputError(
                Problem(
                    f"{size:g} makes more than {MOST} elements of {length:.4g} mm", column="size"
                )
            )
        return ceil(length / size)

    mesh, through = section_mesh(fabric.form), given.get("through")
    if through is None:
        through = mesh.layers(parts(max(fabric.weft.thickness, fabric.warp.thickness)))
    least = mesh.least_across(through)

    spare = [
        fabric.directions[d].crossed_spacing - fabric.crossed(d).width for d in ("weft", "warp")
    ]
    return {
        "across": max(least, parts(fabric.weft.width)),
        "crossing": max(least, parts(fabric.warp.width)),
        "through": through,
        "gap": 2 * parts(max(spare) / 2),
    }
