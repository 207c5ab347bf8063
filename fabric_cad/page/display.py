"""A fabric in a notebook: its page in a frame of its own, and its picture and table where an object is shown.

The frame may run the viewer's script and nothing else: no access to the notebook, no network.
"""

from __future__ import annotations

from html import escape

from ..measured.family import Family, expect_row
from ..model.solved import SolvedFabric
from ..weave.directions import DIRECTIONS
from .cuts import cut_fabric
from .document import fabric_page
from .drawing import cut_caption, cut_drawing
from .edited import solution_of

_QUANTITIES = (
    ("crimp %", "crimp", 100.0),
    ("thickness mm", "thickness", 1.0),
    ("width mm", "width", 1.0),
)


class Shown:
    """What a notebook draws as the page of a fabric; ``text`` is its HTML."""

    def __init__(self, text: str) -> None:
        self.text = text

    def _repr_html_(self) -> str:
        return self.text


def show(row: Family, height: int = 640) -> Shown:
    """The page of a table of one row, to be turned and cut in a notebook; ``height`` in pixels.

    Raises :class:`ArgumentError` where it is no table of one row, :class:`InputError` where it is
    no fabric.
    """
    expect_row(row)
    page = escape(fabric_page(solution_of(row)).text, quote=True)
    style = f"width: 100%; height: {int(height)}px; border: 1px solid #ccc"
    return Shown(
        f'<iframe sandbox="allow-scripts" srcdoc="{page}" style="{style}" title="{row.names[0]}"></iframe>'
    )


def picture_and_table(fabric: SolvedFabric) -> str:
    """HTML of a fabric: a cut along its first weft, and a short table."""
    cut = cut_fabric(fabric, DIRECTIONS[0], fabric.warp.crossed_spacing / 2)
    lines = []
    for label, name, factor in _QUANTITIES:
        values = (f"{factor * getattr(solved, name):.4g}" for solved in (fabric.weft, fabric.warp))
        lines.append(f"<tr><th>{label}</th>{''.join(f'<td>{value}</td>' for value in values)}</tr>")
    return (
        f'<div style="max-width: 40rem"><strong>{escape(fabric.name)}</strong>, '
        f"{escape(fabric.weave.name(fabric.family))}, {fabric.fabric_thickness:.4g} mm"
        f"{cut_drawing(fabric, cut)}<small>{escape(cut_caption(fabric, cut))}</small>"
        f"<table><tr><th></th><th>weft</th><th>warp</th></tr>{''.join(lines)}</table></div>"
    )
