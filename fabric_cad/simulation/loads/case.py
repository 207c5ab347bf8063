"""What a load case says of itself; all else that a case needs is the same for every one.

The command, the table of ``simulation.toml``, decks, solver runs, report and series follow from it,
and the depth of a study where it is studied.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from ...decks.model import Load
from ...measured.settings_files import Check
from ...weave.lattice import Lattice
from ..laws import ContactLaw

if TYPE_CHECKING:
    from ..case_run import CaseRun
    from ..case_table import CaseTable
    from ..reached import Deformed
    from ..report import CaseReport

State = TypeVar("State")

CONDITION = (
    "contact_penetration_mm",
    "penetration_mm",
    "contact_share",
    "strain_energy_N_mm",
    "least_volume_ratio",
)
"""Columns that end every line of every case's table: what tells whether a state can be trusted."""


@dataclass(frozen=True)
class Line:
    """A line of a case's table before its results: which of the states it shows.

    ``number`` counts the states from 0, the one at rest included where there is one; ``time`` is
    the line's in the series for ParaView; ``columns`` name the state and come first.
    """

    number: int
    time: float
    columns: Mapping[str, float]


class LoadCase(ABC, Generic[State]):
    """A load case as ``simulation.toml`` sets it: a frozen dataclass whose fields are the keys of its table.

    ``name`` is that of the command, of the table of settings, and the stem of every file; ``text``
    is what the command's help says; ``checks`` tell what each key may hold. A field with a default
    needs no value in the shipped file. With ``is_studied`` the case is a depth of studies, whose
    usual figures ``headline`` are. A state is whatever the case tells its loads by: strains, an
    angle.
    """

    name: ClassVar[str]
    text: ClassVar[str]
    checks: ClassVar[Mapping[str, Check]]
    is_studied: ClassVar[bool] = False
    headline: ClassVar[tuple[str, ...]] = ()

    @abstractmethod
    def paths(self, contact: ContactLaw) -> Sequence[Sequence[State]]:
        """The states of every solver job, in the order in which it goes through them from rest."""

    @abstractmethod
    def load(self, state: State, lattice: Lattice) -> Load:
        """How a state changes the periods that the cell has at rest."""

    def at_rest(self) -> State | None:
        """The state that stands for rest and comes before those computed.

        None where the table does not have it.
        """
        return None

    @abstractmethod
    def lines(self, states: Sequence[State]) -> Sequence[Line]:
        """The lines of the table of the states that there are, in its order.

        A state may come twice.
        """

    @abstractmethod
    def measures(self, state: State, deformed: Deformed) -> dict[str, float]:
        """Columns of a state between those that name it and :data:`CONDITION`."""

    @abstractmethod
    def label(self, row: Mapping[str, float]) -> str:
        """A line of the table in words."""

    def draw(self, run: CaseRun, table: CaseTable) -> None:
        """Curves and pictures of the states, beside the series that every case has."""
        return

    def findings(self, run: CaseRun, table: CaseTable) -> dict[str, Any]:
        """What the report holds of this case alone, as JSON knows it."""
        return {}

    def summary(self, report: CaseReport) -> list[str]:
        """Lines of a report for a person."""
        return []

    def figure_names(self) -> tuple[str, ...]:
        """Names of the figures (numbers) that a study may have of this case."""
        return ()

    def figures(self, findings: Mapping[str, Any]) -> dict[str, Any]:
        """Those figures of a report's findings."""
        return {}
