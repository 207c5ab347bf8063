"""Options of the commands that fill the space between the yarns."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..support.numerals import number, whole
from .options import MeshedRowOptions

if TYPE_CHECKING:
    from ..composite.options import CompositeOptions


@dataclass(frozen=True, kw_only=True)
class BoxOptions(MeshedRowOptions):
    """Rows, their meshes, and how the matrix fills the box; None: nothing is said."""

    margin: str | None = None
    layers: int | None = None
    grading: float | None = None

    @property
    def box(self) -> CompositeOptions:
        """What is said of the matrix. Raises :class:`InputError` for what cannot be."""
        from ..composite.options import CompositeOptions, Margin

        asked = {
            name: value
            for name in ("layers", "grading")
            if (value := getattr(self, name)) is not None
        }
        margin = Margin() if self.margin is None else Margin.read(self.margin)
        return CompositeOptions(margin=margin, **asked)


def declare_margin(parser: argparse.ArgumentParser) -> None:
    """Add the argument for the clearance between the yarns and the box."""
    parser.add_argument(
        "--margin",
        metavar="MM|%",
        help="clearance above and below the yarns: 5%% of the fabric's thickness, or 0.04 mm (default: 5%%)",
    )


def declare_box(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for the matrix and its mesh."""
    declare_margin(parser)
    parser.add_argument(
        "--layers",
        type=whole,
        metavar="N",
        help="layers of matrix between the yarns and either face of the box (default 4)",
    )
    parser.add_argument(
        "--grading",
        type=number,
        metavar="R",
        help="height of the layer at the box over that at the yarns (default 1)",
    )
