"""How fine a mesh is."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

from ..errors import InputError, Problem
from ..solved import SolvedFabric


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
            if value < least:
                raise InputError(Problem(f"{value} is not at least {least} (elements)", column=name))
        if self.gap % 2:
            raise InputError(
                Problem(f"{self.gap} is odd; the cell is cut at mid-gap, so a gap has an even number", column="gap")
            )

    def check(self, fabric: SolvedFabric) -> None:
        """Raise :class:`InputError` where the section of a fabric cannot be filled so."""
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
    follows ``across``. Raises :class:`InputError`.
    """
    if size is not None and not size > 0:
        raise InputError(Problem(f"{size:g} is not above 0", column="size"))
    pointed, rounded = fabric.section == "lenticular", fabric.section == "round"
    default = MeshOptions(through=4) if rounded else MeshOptions()
    if size is None:
        across = across or max(default.across, 3 * (through or 0) if pointed else 0)
        asked = MeshOptions(across, crossing or across, through or default.through, gap or default.gap)
    else:
        thickness = max(fabric.weft.thickness, fabric.warp.thickness)
        if through is None:
            through = ceil(thickness / size)
            through += through % 2 if pointed or rounded else 0
            through = max(through, 4) if rounded else through
        least = 2 * through if pointed else 2
        spare = [fabric.directions[d].crossed_spacing - fabric.crossed(d).width for d in ("weft", "warp")]
        asked = MeshOptions(
            across or max(least, ceil(fabric.weft.width / size)),
            crossing or max(least, ceil(fabric.warp.width / size)),
            through,
            gap or 2 * ceil(max(spare) / size / 2),
        )
    asked.check(fabric)
    return asked
