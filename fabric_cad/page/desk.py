"""What the page asks and is answered: one session a tab, plain values in, plain values out, no server.

Every answer is JSON: ``row`` (name, family, grid, quantities, refusals), and, where the fabric is
another one, ``scene``, so that a changed number is drawn after one question. Figures and cuts are
asked for after that.
"""

from __future__ import annotations

import tempfile
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from ..measured.columns import CHOICES, WEAVE_COLUMNS
from ..measured.wif import read_wif
from ..support.errors import FabricCadError, InputError, Problem
from ..weave.directions import Direction
from ..weave.patterns import written
from .cuts import cut_fabric
from .document import fabric_page, kind_of
from .drawing import cut_caption, cut_drawing
from .edited import EditedRow
from .figures import comparisons, expected_quality, figures, warnings
from .links import link_of, row_of
from .saving import RowExistsError, save_row
from .scene import scene
from .session import Session

MOST_TABS = 40
"""Tabs that are remembered; the one not used for longest is forgotten first."""

LARGEST_DRAFT = 1_000_000
"""Characters of a draft that is dropped onto the page."""

Answer = dict[str, Any]


@dataclass(frozen=True)
class Places:
    """Where rows are saved and results are written.

    Both below the folder that the page was started in.
    """

    families: Path
    out: Path


class Desk:
    """The sessions of all tabs, and every question that a page may ask (:meth:`ask`)."""

    def __init__(self, row: EditedRow, places: Places) -> None:
        Session(row)  # raises where it is no fabric
        self._first, self.places = row, places
        self._tabs: OrderedDict[str, Session] = OrderedDict()

    def ask(self, tab: str, question: str, *arguments: Any) -> Answer:
        """The answer to a question of one tab; what was wrong is under ``problem``, in a sentence.

        Arguments come from a browser: every one of the wrong kind is answered so too.
        """
        answers: Mapping[str, Callable[..., Answer]] = {
            "open": self._open,
            "change": self._change,
            "flip": self._flip,
            "resize": self._resize,
            "weave": self._weave,
            "draft": self._draft,
            "undo": self._undo,
            "redo": self._redo,
            "figures": self._figures,
            "cut": self._cut,
            "save": self._save,
            "page": self._page,
        }
        try:
            return answers[question](_text(tab, 80), *arguments)
        except RowExistsError as error:
            return {"problem": _sentence(error), "exists": True}
        except FabricCadError as error:
            return {"problem": _sentence(error)}
        except (KeyError, TypeError, ValueError, IndexError):
            return {"problem": f"the page asked what has no answer: {question!r:.40}"}

    def row(self, tab: str) -> EditedRow:
        """The row of a tab that is a fabric. Raises :class:`InputError` where what stands is refused."""
        session = self._tabs[tab]
        if session.refused:
            raise InputError(session.problems)
        return session.row

    def _session(self, tab: str) -> Session:
        self._tabs.move_to_end(tab)
        return self._tabs[tab]

    def _open(self, tab: str, link: str) -> Answer:
        """A tab's first question, with the link in its address.

        Where that is none, the row of the command.
        """
        told = {}
        try:
            session = Session(row_of(_text(link, 40_000))) if link else Session(self._first)
        except InputError as error:
            session, told = (
                Session(self._first),
                {"problem": f"the address holds no fabric: {_sentence(error)}"},
            )

        self._tabs[tab] = session
        while len(self._tabs) > MOST_TABS:
            self._tabs.popitem(last=False)

        return self._answer(session, None) | told

    def _change(self, tab: str, column: str, text: str, moving: bool) -> Answer:
        return self._after(
            tab, lambda s: s.change(_text(column, 80), _text(text, 400), bool(moving))
        )

    def _flip(self, tab: str, crossings: Sequence[Sequence[int]]) -> Answer:
        pairs = [(int(weft), int(warp)) for weft, warp in crossings]
        return self._after(tab, lambda s: s.edit(s.row.flipped(pairs)))

    def _resize(self, tab: str, wefts: int, warps: int) -> Answer:
        return self._after(tab, lambda s: s.edit(s.row.resized(int(wefts), int(warps))))

    def _weave(self, tab: str, family: str, cells: Mapping[str, object]) -> Answer:
        """Another weave: a family with its columns; a pattern starts from the weave that stands."""
        texts = {
            column: _text(str(cells[column]), 11_000) for column in WEAVE_COLUMNS[_text(family, 20)]
        }
        return self._after(tab, lambda s: s.edit(s.row.woven(family, **texts)))

    def _draft(self, tab: str, name: str, text: str) -> Answer:
        """A .wif dropped onto the page, read as one of the command line is."""
        name = Path(_text(name, 300)).name
        with tempfile.TemporaryDirectory() as scratch:
            copy = Path(scratch) / "dropped.wif"
            copy.write_text(_text(text, LARGEST_DRAFT), encoding="utf-8")
            try:
                pattern = written(read_wif(copy))
            except InputError as error:
                raise InputError(
                    [replace(problem, path=name) for problem in error.problems]
                ) from error
        return self._after(tab, lambda s: s.edit(s.row.woven("pattern", pattern=pattern)))

    def _undo(self, tab: str) -> Answer:
        return self._after(tab, Session.undo)

    def _redo(self, tab: str) -> Answer:
        return self._after(tab, Session.redo)

    def _after(self, tab: str, edit: Callable[[Session], None]) -> Answer:
        session = self._session(tab)
        before = session.good
        edit(session)
        return self._answer(session, before)

    def _answer(self, session: Session, before: object) -> Answer:
        """The row as it stands, and the scene where the fabric is another one."""
        row, good = session.row, session.good
        listed = {name: list(choices) for name, choices in CHOICES.items()}
        told = {
            "row": {
                "name": row.name,
                "family": row.family,
                "weave": {
                    column: row.cells.get(column, "") for column in WEAVE_COLUMNS[row.family]
                },
                "grid": list(row.grid()),
                "texts": {name: row.cells.get(name, "") for name in (*CHOICES, "source", "notes")},
                "choices": listed,
                "quantities": [asdict(quantity) for quantity in session.quantities()],
                "refused": session.refused,
                "problems": [_told(problem) for problem in session.problems],
                "undo": session.can_undo,
                "redo": session.can_redo,
                "link": link_of(row),
                "kind": kind_of(good),
            }
        }

        return told if good is before else told | {"scene": scene(good.fabric)}

    def _figures(self, tab: str) -> Answer:
        """Figures, what was measured beyond need, and warnings of the fabric in view."""
        good = self._session(tab).good
        shown = (*figures(good), expected_quality(good))
        return {
            "figures": [{"label": figure.label, "text": figure.text} for figure in shown],
            "comparisons": [
                f"{column}: measured {measured:.4g}, model {model:.4g} ({100 * (model - measured) / measured:+.1f} %)"
                for column, measured, model in comparisons(good)
            ],
            "warnings": list(warnings(good)),
        }

    def _cut(self, tab: str, direction: str, share: float) -> Answer:
        """The cut along a direction's yarns at a share, 0 to 1, of the cell across them."""
        fabric = self._session(tab).good.fabric
        along = Direction(direction)
        place = min(max(float(share), 0.0), 1.0) * fabric.period[along.other.axis]
        cut = cut_fabric(fabric, along, place)
        return {
            "svg": cut_drawing(fabric, cut),
            "caption": cut_caption(fabric, cut),
            "place": place,
        }

    def _save(self, tab: str, name: str, over: bool) -> Answer:
        """Save the row into its table; never over one that is there unless ``over`` says so."""
        session = self._session(tab)
        row = session.row.changed(name=_text(name, 200))
        saved = save_row(row, self.places.families, bool(over))
        session.edit(row)
        added = f", with the new columns {', '.join(saved.added)}" if saved.added else ""
        verb = "changed in" if saved.replaced else "added to"
        return self._answer(session, session.good) | {
            "done": f"{row.name} {verb} {saved.path}{added}"
        }

    def _page(self, tab: str) -> Answer:
        """The fabric in view as one HTML file."""
        page = fabric_page(self._session(tab).good)
        return {"name": f"{page.name}.html", "text": page.text}


def _text(value: object, most: int) -> str:
    if not isinstance(value, str) or len(value) > most:
        raise ValueError("no text, or a longer one than is read")
    return value


def _told(problem: Problem) -> dict[str, str]:
    """A problem for the page: the column it names, and its sentence."""
    return {"column": problem.column or "", "message": problem.message}


def _sentence(error: FabricCadError) -> str:
    if isinstance(error, InputError):
        return "; ".join(str(replace(problem, row=None)) for problem in error.problems)
    return str(error)
