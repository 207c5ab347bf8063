"""One fabric as one HTML file that opens without a server or network: the cell to turn, its numbers, its cuts.

The cell is drawn by the viewer beside this module, 200 lines of WebGL2. Of what is installed anyway
only trame-vtk brings a client that draws in three dimensions, 1.7 MB of script for each file, and
three.js comes with no package of the environment; tiles need instancing, one shader and an orbit.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from pathlib import Path

from .. import __version__
from ..measured.columns import NUMBERS
from ..weave.directions import DIRECTIONS
from .cuts import cut_fabric
from .drawing import cut_caption, cut_drawing
from .edited import Solution
from .figures import comparisons, expected_quality, figures, warnings
from .scene import scene

_CLIENT = Path(__file__).with_name("client")
_POLICY = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:"

_CONTROLS = """\
<div class="controls" role="group" aria-label="what is shown">
<label>cells <select id="cells"><option>1</option>\
<option>2</option><option>3</option><option>4</option></select></label>
<label><input type="checkbox" id="show-weft" checked> wefts</label>
<label><input type="checkbox" id="show-warp" checked> warps</label>
<label><input type="checkbox" id="contact"> contact</label>
<label>cut <select id="cut-axis"><option value="">none</option><option>x</option><option>y</option></select></label>
<label>at <input type="range" id="cut-place" min="0" max="1" step="0.005" value="0.5" disabled></label>
</div>
"""


@lru_cache
def client(name: str) -> str:
    """The text of one of the client's files."""
    return (_CLIENT / name).read_text(encoding="utf-8")


@dataclass(frozen=True)
class Page:
    """One HTML file: its ``name`` without suffix, and its text."""

    name: str
    text: str


def kind_of(solution: Solution) -> str:
    """A fabric's weave and sections in words."""
    fabric = solution.fabric
    weave = fabric.weave
    size = "" if weave.pattern else f", {weave.wefts} wefts \u00d7 {weave.warps} warps"
    return f"{weave.name(fabric.family)}{size}, {fabric.section} sections"


def fabric_page(solution: Solution) -> Page:
    """The page of a fabric. It asks for nothing from outside, and its policy forbids it."""
    name = solution.fabric.name
    cuts = [
        cut_fabric(
            solution.fabric, direction, solution.fabric.crossed(direction).crossed_spacing / 2
        )
        for direction in DIRECTIONS
    ]
    drawn = "".join(
        f'{cut_drawing(solution.fabric, cut)}<p class="caption">{escape(cut_caption(solution.fabric, cut))}</p>'
        for cut in cuts
    )
    body = (
        f'<h1>{escape(name)}</h1><p class="kind">{escape(kind_of(solution))}</p>'
        f'<canvas class="view" id="view" tabindex="0" role="img" aria-label="{escape(_label(solution))}"></canvas>'
        f"{_CONTROLS}"
        '<p class="note">Drag or arrow keys turn, with shift they move; wheel, + and - zoom.</p>'
        f"<h2>Cuts along weft 1 and warp 1</h2>{drawn}"
        f'<div class="columns"><div><h2>Figures of the model</h2>{_figures(solution)}{_notes(solution)}</div>'
        f"<div><h2>As measured</h2>{_row(solution)}</div></div>"
        f'<p class="note">fabric-cad {escape(__version__)}. Lengths in mm.</p>'
        f'<script type="application/json" id="scene">{_json(scene(solution.fabric))}</script>'
        f"<script>{client('viewer.js')}</script><script>{client('page.js')}</script>"
    )

    return Page(name, html(name, body))


def gallery_page(solutions: Iterable[Solution], title: str = "Fabrics") -> Page:
    """An index of fabrics, each with a cut along its first weft and a link to its page."""
    entries = []
    for solution in solutions:
        fabric = solution.fabric
        cut = cut_fabric(fabric, DIRECTIONS[0], fabric.warp.crossed_spacing / 2)
        entries.append(
            f'<li><a href="{escape(fabric.name)}.html"><strong>{escape(fabric.name)}</strong>'
            f"{cut_drawing(fabric, cut)}<span>{escape(kind_of(solution))}</span></a></li>"
        )
    return Page(
        "index", html(title, f'<h1>{escape(title)}</h1><ul class="gallery">{"".join(entries)}</ul>')
    )


def html(title: str, body: str) -> str:
    """A whole document."""
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{client('page.css')}</style></head>\n<body>{body}</body></html>\n"
    )


def _label(solution: Solution) -> str:
    told = ", ".join(f"{figure.label} {figure.text}" for figure in figures(solution)[:3])
    return f"the cell of {solution.fabric.name}, {kind_of(solution)}: {told}"


def _figures(solution: Solution) -> str:
    known = (*figures(solution), expected_quality(solution))
    lines = "".join(
        f'<tr><th scope="row">{escape(figure.label)}</th><td class="number">{escape(figure.text)}</td></tr>'
        for figure in known
    )
    return f"<table>{lines}</table>"


def _notes(solution: Solution) -> str:
    """What was measured beyond need, and warnings."""
    told = [
        f"{column}: measured {measured:.4g}, model {model:.4g} ({100 * (model - measured) / measured:+.1f} %)"
        for column, measured, model in comparisons(solution)
    ]
    return "".join(f'<p class="note">{escape(text)}</p>' for text in (*told, *warnings(solution)))


def _row(solution: Solution) -> str:
    """The row as it was measured."""
    used = solution.identified_by
    lines = []
    for column, text in solution.row.cells.items():
        unit = NUMBERS[column].unit if column in NUMBERS else ""
        mark = " (identifies)" if column in used else ""
        lines.append(
            f'<tr><th scope="row">{escape(column)}{mark}</th>'
            f'<td class="{"number" if column in NUMBERS else "text"}">{escape(text)} {escape(unit)}</td></tr>'
        )
    return f"<table>{''.join(lines)}</table>"


def _json(value: object) -> str:
    """JSON that ends no script element."""
    return json.dumps(value, separators=(",", ":")).replace("<", "\\u003c")
