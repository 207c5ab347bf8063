"""Deck keywords: each a small value that prints its own card.

``str(keyword)`` is its text for CalculiX; :func:`write_keywords` writes many, for either solver.
The solvers read the same text but for what :data:`DIALECTS` names: Abaqus asks for the columns of
a distribution to be declared and has output requests of its own, and the second number of
``*FRICTION`` means something else to it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

DIALECTS = ("calculix", "abaqus")
_CHUNK = 50_000
_AT_END = 9999  # increments between two results: more than a step has, so at its end only


class Keyword:
    """A card of a deck, with its data lines."""

    def lines(self, dialect: str) -> Iterator[str]:
        """The text in pieces, each ending with a line's end."""
        raise NotImplementedError

    def __str__(self) -> str:
        return "".join(self.lines("calculix"))


def write_keywords(
    keywords: Iterable[Keyword], path: str | Path, dialect: str = "calculix"
) -> None:
    """Write keywords as a deck, one after another. Raises ValueError where there is no such dialect."""
    if dialect not in DIALECTS:
        raise ValueError(f"dialect: expected one of {', '.join(DIALECTS)}, got {dialect!r}")
    with open(path, "w", encoding="ascii", newline="\n") as file:
        for keyword in keywords:
            file.writelines(keyword.lines(dialect))


@dataclass(frozen=True)
class Comment(Keyword):
    """Lines that both solvers pass over."""

    text: str

    def lines(self, dialect: str) -> Iterator[str]:
        yield from (f"** {line}\n" for line in self.text.splitlines())


@dataclass(frozen=True, eq=False)
class Nodes(Keyword):
    """``*NODE``: places ``points`` (nodes, 3), mm, numbered from ``first``, all in the set ``name``."""

    name: str
    points: np.ndarray
    first: int = 1

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*NODE, NSET={self.name}\n"
        numbers = np.arange(self.first, self.first + len(self.points))
        yield from _rows("%d, %.12g, %.12g, %.12g\n", numbers, self.points)


@dataclass(frozen=True, eq=False)
class Hexahedra(Keyword):
    """``*ELEMENT, TYPE=C3D8``: elements ``numbers`` with their node numbers ``nodes`` (elements, 8), set ``name``."""

    name: str
    numbers: np.ndarray
    nodes: np.ndarray

    def __post_init__(self) -> None:
        if self.nodes.shape != (len(self.numbers), 8):
            raise ValueError(f"nodes: expected ({len(self.numbers)}, 8), got {self.nodes.shape}")

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*ELEMENT, TYPE=C3D8, ELSET={self.name}\n"
        yield from _rows("%d" + ", %d" * 8 + "\n", self.numbers, self.nodes)


@dataclass(frozen=True, eq=False)
class NodeSet(Keyword):
    """``*NSET`` of node numbers, or of other sets by name."""

    name: str
    members: np.ndarray | tuple[str, ...]

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*NSET, NSET={self.name}\n"
        yield _listed(self.members)


@dataclass(frozen=True, eq=False)
class ElementSet(Keyword):
    """``*ELSET`` of element numbers, or of other sets by name."""

    name: str
    members: np.ndarray | tuple[str, ...]

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*ELSET, ELSET={self.name}\n"
        yield _listed(self.members)


@dataclass(frozen=True, eq=False)
class Surface(Keyword):
    """``*SURFACE, TYPE=ELEMENT``: faces ``sides`` (1: S1 ... 6: S6) of ``elements``, both (faces,)."""

    name: str
    elements: np.ndarray
    sides: np.ndarray

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*SURFACE, NAME={self.name}, TYPE=ELEMENT\n"
        yield from _rows("%d, S%d\n", self.elements, self.sides[:, None])


@dataclass(frozen=True, eq=False)
class FibreOrientation(Keyword):
    """``*DISTRIBUTION`` and ``*ORIENTATION`` ``name``: axes 1 and 2 (elements, 6) of elements 1, 2, ..."""

    name: str
    axes: np.ndarray

    def lines(self, dialect: str) -> Iterator[str]:
        if dialect == "abaqus":
            yield "*DISTRIBUTION TABLE, NAME=fibre_table\nCOORD3D, COORD3D\n"
        yield "*DISTRIBUTION, NAME=fibre_axes, LOCATION=ELEMENT, TABLE=fibre_table\n, 1., 0., 0., 0., 1., 0.\n"
        yield from _rows("%d" + ", %.8g" * 6 + "\n", np.arange(1, len(self.axes) + 1), self.axes)
        yield f"*ORIENTATION, NAME={self.name}, SYSTEM=RECTANGULAR\nfibre_axes\n3, 0.\n"


@dataclass(frozen=True)
class EngineeringConstants(Keyword):
    """``*ELASTIC, TYPE=ENGINEERING CONSTANTS``; moduli MPa, axis 1 the fibre's."""

    e1: float
    e2: float
    e3: float
    nu12: float
    nu13: float
    nu23: float
    g12: float
    g13: float
    g23: float

    def lines(self, dialect: str) -> Iterator[str]:
        values = [f"{getattr(self, each.name):.10g}" for each in fields(self)]
        yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
        yield ", ".join(values[:8]) + "\n" + values[8] + "\n"


@dataclass(frozen=True)
class IsotropicElasticity(Keyword):
    """``*ELASTIC``: Young's modulus, MPa, and Poisson's ratio."""

    modulus: float
    ratio: float

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*ELASTIC\n{self.modulus:.10g}, {self.ratio:.10g}\n"


@dataclass(frozen=True)
class Compaction(Keyword):
    """``*HYPERELASTIC, REDUCED POLYNOMIAL`` of second order with energy ``hardening / 4 (J - 1)**4`` alone (MPa).

    Its bulk modulus 3 hardening (J - 1)**2 starts from nothing. Both solvers ask for the other
    constants too: 1e-6 MPa of shear and 1e-12 MPa of bulk.
    """

    hardening: float

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*HYPERELASTIC, REDUCED POLYNOMIAL, N=2\n1e-6, 0., 1e12, {4 / self.hardening:.10g}\n"


@dataclass(frozen=True)
class Material(Keyword):
    """``*MATERIAL`` and its law."""

    name: str
    law: Keyword

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*MATERIAL, NAME={self.name}\n"
        yield from self.law.lines(dialect)


@dataclass(frozen=True)
class SolidSection(Keyword):
    """``*SOLID SECTION``: the elements of a set are of a material, in an orientation if there is one."""

    elements: str
    material: str
    orientation: str = ""

    def lines(self, dialect: str) -> Iterator[str]:
        axes = f", ORIENTATION={self.orientation}" if self.orientation else ""
        yield f"*SOLID SECTION, ELSET={self.elements}, MATERIAL={self.material}{axes}\n"


@dataclass(frozen=True)
class PenaltyInteraction(Keyword):
    """``*SURFACE INTERACTION`` of a linear penalty (N/mm3) and friction.

    ``stick`` (N/mm3) is CalculiX' stick slope.
    """

    name: str
    stiffness: float
    friction: float = 0.0
    stick: float = 0.0

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*SURFACE INTERACTION, NAME={self.name}\n"
        yield f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{self.stiffness:.10g}\n"
        if self.friction:
            slope = f", {self.stick:.10g}" if dialect == "calculix" else ""
            yield f"*FRICTION\n{self.friction:.10g}{slope}\n"


@dataclass(frozen=True)
class ContactPair(Keyword):
    """``*CONTACT PAIR``, surface to surface: what a slave surface does to a master surface."""

    interaction: str
    slave: str
    master: str

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*CONTACT PAIR, INTERACTION={self.interaction}, TYPE=SURFACE TO SURFACE\n{self.slave}, {self.master}\n"


@dataclass(frozen=True)
class Tie(Keyword):
    """``*TIE``: a slave surface glued to a master surface within ``tolerance`` (mm)."""

    name: str
    slave: str
    master: str
    tolerance: float

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*TIE, NAME={self.name}, POSITION TOLERANCE={self.tolerance:.6g}\n{self.slave}, {self.master}\n"


@dataclass(frozen=True)
class Equation(Keyword):
    """``*EQUATION``: the sum of factor times displacement over terms (node, direction 1 to 3, factor) is zero."""

    terms: tuple[tuple[int, int, float], ...]

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"*EQUATION\n{len(self.terms)}\n"
        yield (
            ", ".join(
                f"{node}, {direction}, {factor:.10g}" for node, direction, factor in self.terms
            )
            + "\n"
        )


@dataclass(frozen=True)
class Boundary(Keyword):
    """``*BOUNDARY``: displacements (mm) of nodes, as (node, direction 1 to 3, value)."""

    displacements: tuple[tuple[int, int, float], ...]

    def lines(self, dialect: str) -> Iterator[str]:
        yield "*BOUNDARY\n"
        yield from (
            f"{node}, {direction}, {direction}, {value:.12g}\n"
            for node, direction, value in self.displacements
        )


@dataclass(frozen=True)
class Output(Keyword):
    """Results to write at a step's end: fields, contact, and per set of ``force_sets`` the sum of its nodes' forces."""

    force_sets: tuple[str, ...]
    contact: bool = True

    def lines(self, dialect: str) -> Iterator[str]:
        sums = f"TOTALS={'YES' if dialect == 'abaqus' else 'ONLY'}, FREQUENCY={_AT_END}"
        for name in self.force_sets:
            yield f"*NODE PRINT, NSET={name}, {sums}\nRF\n"
        if dialect == "abaqus":
            yield f"*OUTPUT, FIELD, FREQUENCY={_AT_END}\n*NODE OUTPUT\nU, RF\n*ELEMENT OUTPUT\nS, E\n"
            if self.contact:
                yield "*CONTACT OUTPUT\nCSTRESS, CDISP\n"
            return
        yield f"*NODE FILE, FREQUENCY={_AT_END}\nU\n*EL FILE, FREQUENCY={_AT_END}\nS, E\n"
        if self.contact:
            yield f"*CONTACT FILE, FREQUENCY={_AT_END}\nCDIS, CSTR\n"


@dataclass(frozen=True)
class StaticStep(Keyword):
    """``*STEP, NLGEOM`` with ``*STATIC``: ``content`` applied over a time of 1, ``first`` of it at once.

    CalculiX settles which points touch early in an increment; the short second one settles it anew,
    near the end, so that the state hardly depends on the one before. An increment that does not
    converge is cut down to ``smallest``; at most ``increments``.
    """

    title: str
    content: tuple[Keyword, ...]
    first: float = 0.95
    smallest: float = 1e-3
    increments: int = 200

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"** {self.title}\n*STEP, NLGEOM, INC={self.increments}\n*STATIC\n"
        yield f"{self.first:.6g}, 1., {self.smallest:.6g}, 1.\n"
        for keyword in self.content:
            yield from keyword.lines(dialect)
        yield "*END STEP\n"


@dataclass(frozen=True)
class StressOutput(Keyword):
    """Displacements, and the stresses at all integration points of the set ``elements``, in the axes of space.

    CalculiX prints them into the ``.dat``, with the elements' energies and volumes summed; Abaqus
    keeps the points' volumes with them.
    """

    elements: str

    def lines(self, dialect: str) -> Iterator[str]:
        if dialect == "abaqus":
            yield "*OUTPUT, FIELD\n*NODE OUTPUT\nU\n*ELEMENT OUTPUT, DIRECTIONS=YES\nS, IVOL\n"
            return
        yield "*NODE FILE\nU\n*EL FILE\nS\n"
        yield f"*EL PRINT, ELSET={self.elements}, GLOBAL=YES\nS\n"
        yield f"*EL PRINT, ELSET={self.elements}, TOTALS=ONLY\nELSE, EVOL\n"


@dataclass(frozen=True)
class LinearStep(Keyword):
    """``*STEP`` with ``*STATIC`` of a linear problem: ``content`` applied at once."""

    title: str
    content: tuple[Keyword, ...]

    def lines(self, dialect: str) -> Iterator[str]:
        yield f"** {self.title}\n*STEP\n*STATIC\n"
        for keyword in self.content:
            yield from keyword.lines(dialect)
        yield "*END STEP\n"


def _rows(form: str, numbers: np.ndarray, values: np.ndarray) -> Iterator[str]:
    """One formatted line per number and row of values, in large pieces."""
    for start in range(0, len(numbers), _CHUNK):
        part = slice(start, start + _CHUNK)
        flat: list = []
        for number, row in zip(numbers[part].tolist(), values[part].tolist()):
            flat.append(number)
            flat += row
        yield form * len(numbers[part]) % tuple(flat)


def _listed(members: np.ndarray | tuple[str, ...]) -> str:
    """Numbers, sixteen a line; names, one a line."""
    if isinstance(members, tuple):
        return "".join(f"{name}\n" for name in members)
    lines = [members[start : start + 16] for start in range(0, len(members), 16)]
    return "".join(", ".join(map(str, line.tolist())) + "\n" for line in lines)
