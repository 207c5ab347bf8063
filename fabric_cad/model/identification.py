"""From measured rows to the parameters of the model, whole tables at once.

Density and width known, the crimp of a yarn fixes its amplitude A through the length equation
and the reverse; the relations of :mod:`~fabric_cad.model.closing` give the rest. The first quantities
given, in the order of :data:`~fabric_cad.model.closing.CLOSING`, identify a row; what a row holds
beyond them is compared with the model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..measured.tables import Family
from ..section.sections import free_parabola, lateral_arc, round_between, round_free_side
from ..support.errors import InputError, Problem, expect
from ..weave.directions import DIRECTIONS
from .closing import ALONE, BOUNDED, CLOSING, ROUNDING, RULES, SYMBOLS, Closed
from .lengths import excess_length, slope_from_crimp
from .plausibility import LARGEST_SLOPE, responsible, too_steep
from .solved import PLATEAUX, SolvedTable, point_columns

CONTACT_SIDE = {"high": "bottom", "low": "top"}
"""The side of a yarn that touches at each plateau."""


@dataclass(frozen=True)
class _Measured:
    """The measured arrays of a table with a balanced row's weft cells used for its warp."""

    density: dict[str, np.ndarray]
    width: dict[str, np.ndarray]
    chord: dict[tuple[str, str], np.ndarray]  # by (direction, plateau) of the yarn itself
    offset: dict[tuple[str, str], np.ndarray]
    closing: np.ndarray  # (5, rows) in the order of CLOSING
    balanced: np.ndarray
    lateral: np.ndarray
    round: np.ndarray


def _measured(table: Family) -> _Measured:
    balanced = table.balanced
    values = table.measured

    def of(quantity: str) -> dict[str, np.ndarray]:
        weft = values[f"weft_{quantity}"]
        return {"weft": weft, "warp": np.where(balanced, weft, values[f"warp_{quantity}"])}

    width, chord, offset = of("width_mm"), {}, {}
    for plateau, side in CONTACT_SIDE.items():
        for direction in DIRECTIONS:
            given = of(f"contact_{side}_mm")[direction]
            chord[direction, plateau] = np.where(np.isnan(given), width[direction], given)
            offset[direction, plateau] = np.nan_to_num(of(f"offset_{side}_mm")[direction])
    closing = np.array([values[column] for column in CLOSING]).reshape(len(CLOSING), len(table))
    lateral = np.nan_to_num(values["lateral_height_mm"])
    rounded = np.array([form == "round" for form in table.sections], dtype=bool)
    return _Measured(of("density_per_mm"), width, chord, offset, closing, balanced, lateral, rounded)


@dataclass(frozen=True)
class _Transitions:
    """Geometry of one direction's transitions; arrays of shape (rows,), mm. (A.1)-(A.12)"""

    spacing: np.ndarray  # of the yarns it crosses
    projected: np.ndarray  # yarn length in projection per transition
    u_low: np.ndarray
    u_high: np.ndarray
    gap: np.ndarray

    def slope(self, crimp: np.ndarray) -> np.ndarray:
        return slope_from_crimp(crimp, self.projected, self.u_low + self.u_high, self.gap)

    def crimp(self, slope: np.ndarray) -> np.ndarray:
        return excess_length(slope, self.u_low + self.u_high, self.gap) / self.projected

    @property
    def rise(self) -> np.ndarray:
        """Amplitude per unit of slope, A = s rise. (A.27)-(A.29)"""
        return self.u_low / 2 + self.gap + self.u_high / 2


def _transitions(measured: _Measured, floats: dict[str, np.ndarray]) -> dict[str, _Transitions]:
    found = {}
    for direction, crossed in (("weft", "warp"), ("warp", "weft")):
        spacing = 1 / measured.density[crossed]
        projected = np.sum(floats[direction], axis=0) / 2 * spacing
        # on its low plateau a yarn touches the bottom of the one it crosses, which is high there
        half_low, half_high = measured.chord[crossed, "high"] / 2, measured.chord[crossed, "low"] / 2
        u_low = half_low - measured.offset[crossed, "high"]
        u_high = half_high - measured.offset[crossed, "low"]
        found[direction] = _Transitions(spacing, projected, u_low, u_high, spacing - half_low - half_high)
    return found


def _floats(table: Family) -> dict[str, np.ndarray]:
    """Mean lengths of a direction's low and high floats, each of shape (2, rows), in crossed yarns."""
    weaves = {id(weave): weave for weave in table.weaves}  # many rows share one
    known = {key: (*weave.floats("weft"), *weave.floats("warp")) for key, weave in weaves.items()}
    found = np.array([known[id(weave)] for weave in table.weaves], dtype=float).reshape(-1, 4).T
    return {"weft": found[:2], "warp": found[2:]}


@dataclass(frozen=True, eq=False)
class Identified:
    """What became of a table's rows.

    ``columns`` are those of the solved table, as arrays or lists of one value for each of ``rows``, the
    numbers of the rows that are fabrics; ``refused`` holds for every other row number what makes it none.
    ``closing`` and ``beyond``, shape (5, fabrics), are the measured quantities of
    :data:`~fabric_cad.model.closing.CLOSING` and whether they are beyond what identified the row.
    """

    columns: Mapping[str, Sequence]
    rows: np.ndarray
    refused: Mapping[int, Problem]
    closing: np.ndarray
    beyond: np.ndarray

    def comparisons(self) -> tuple[tuple[tuple[str, float, float], ...], ...]:
        """(quantity, measured, model) of what each fabric measured beyond need."""
        found: list[list] = [[] for _ in self.rows]
        for name, measured, beyond in zip(CLOSING, self.closing, self.beyond):
            at = np.flatnonzero(beyond)
            model = np.asarray(self.columns[name])[at].tolist()
            for row, *values in zip(at.tolist(), measured[at].tolist(), model):
                found[row].append((name, *values))
        return tuple(map(tuple, found))


def identify(table: Family) -> SolvedTable:
    """Solve every row of a table for the model's parameters.

    The paper's model (sections 3 to 5, appendix A): balanced rows from three parameters,
    unbalanced ones from seven or any other sufficient subset, and with contact chords,
    contact offsets and round sections the more general ones of 8, 12 and 18.
    Raises :class:`InputError` listing, for every row that is not a fabric, the number that
    makes it so; nothing unconverged is returned.
    """
    expect(table, Family, "table", " (read_family gives one)")
    found = identify_rows(table)
    if found.refused:
        raise InputError(sorted(found.refused.values(), key=lambda problem: problem.line or 0))
    lists = {name: v.tolist() if isinstance(v, np.ndarray) else v for name, v in found.columns.items()}
    return SolvedTable(lists, found.comparisons())


def identify_rows(table: Family) -> Identified:
    """The same row by row: what is no fabric is refused with its reason, and the others are solved."""
    with np.errstate(all="ignore"):  # refused rows may hold anything
        measured, floats = _measured(table), _floats(table)
        transitions = _transitions(measured, floats)
        used = _used(measured)
        first, second, least = _close(measured, transitions, used)
        refusals = [_refusals(table, measured, transitions, closed, least, used) for closed in (first, second)]
        second_chosen, two = _choose(table, first, second, *refusals)
        refused = {at: _insufficient(table, measured, at) for at in np.flatnonzero(used.number == 0).tolist()}
        for chosen, found in enumerate(refusals):
            refused |= {at: problem for at, problem in found.items() if second_chosen[at] == chosen}
        closed, other = second.where(second_chosen, first), first.where(second_chosen, second)
        columns = _solved(table, measured, transitions, floats, used, closed, other, two)
    beyond = ~np.isnan(measured.closing) & [used.where(lambda held: k not in held) for k in range(len(CLOSING))]
    rows = np.arange(len(table))
    if refused:
        rows = np.delete(rows, list(refused))
        columns = {
            name: values[rows] if isinstance(values, np.ndarray) else [values[at] for at in rows.tolist()]
            for name, values in columns.items()
        }
    return Identified(columns, rows, refused, measured.closing[:, rows], beyond[:, rows])


_SETS = ((), *RULES)
"""What can identify a row, by number of quantities in CLOSING; nothing where its measurements do not suffice."""


@dataclass(frozen=True, eq=False)
class _Used:
    """Which of CLOSING identify each row: ``number``, shape (rows,), indexes :data:`_SETS`."""

    number: np.ndarray

    def __getitem__(self, at: int) -> tuple[int, ...]:
        return _SETS[self.number[at]]

    def where(self, test: Callable[[tuple[int, ...]], bool]) -> np.ndarray:
        """Boolean (rows,): the row's set passes a test."""
        return np.array([bool(test(columns)) for columns in _SETS])[self.number]


def _used(measured: _Measured) -> _Used:
    given = ~np.isnan(measured.closing)
    # every combination of given quantities, as a binary number, and a last bit for balanced
    codes = 2 ** np.arange(len(CLOSING)) @ given + 2 ** len(CLOSING) * measured.balanced
    sets = np.zeros(2 ** (len(CLOSING) + 1), dtype=int)
    for code in range(len(sets)):
        held = tuple(k for k in range(len(CLOSING)) if code >> k & 1)
        alone = next(((k,) for k in (0, 2, 4) if k in held), ())
        three = held[:3] if len(held) >= 3 else ()
        sets[code] = _SETS.index(alone if code >> len(CLOSING) else three)
    return _Used(sets[codes])


def _insufficient(table: Family, measured: _Measured, at: int) -> Problem:
    if measured.balanced[at]:
        return table.problem(
            at,
            CLOSING[0],
            "this cell is empty, and so are weft_thickness_mm and fabric_thickness_mm; "
            "a balanced fabric needs one of the three",
        )
    given = [column for column, value in zip(CLOSING, measured.closing[:, at]) if not np.isnan(value)]
    missing = [column for column in CLOSING if column not in given]
    return table.problem(
        at,
        missing[0],
        f"this cell is empty; an unbalanced fabric needs three of {', '.join(CLOSING)}, "
        f"and {' and '.join(given) or 'none'} is given: fill {3 - len(given)} more of {', '.join(missing)}",
    )


def _close(measured, transitions, used) -> tuple[Closed, Closed, np.ndarray]:
    """Both solutions of the two relations for every row (the same twice where one exists).

    Third, the least fabric thickness the other two numbers allow where (15) bounds it, mm.
    """
    rows = len(used.number)
    amplitudes = [transitions[d].rise * transitions[d].slope(measured.closing[k]) for k, d in enumerate(DIRECTIONS)]
    values = np.concatenate([np.reshape(amplitudes, (2, rows)), measured.closing[2:]])
    solutions = [Closed(*np.full((4, rows), np.nan)) for _ in range(2)]
    least = np.full(rows, np.nan)
    for number in np.unique(used.number[used.number > 0]).tolist():
        columns, group = _SETS[number], np.flatnonzero(used.number == number)
        given = values[np.ix_(columns, group)]
        found = RULES[columns](*given)
        for solution, closed in zip(solutions, (found[0], found[-1])):
            for name in ("A1", "A2", "b1", "b2"):
                getattr(solution, name)[group] = getattr(closed, name)
        if columns in BOUNDED:
            least[group] = given[0] + given[1]
    return *solutions, least


def _refusals(table, measured, transitions, closed, least, used) -> dict[int, Problem]:
    """What makes a row no fabric under one solution, by row number."""
    found: dict[int, Problem] = {}

    def refuse(mask, column, message) -> None:
        for at in np.flatnonzero(mask).tolist():
            if used.number[at]:
                names = [CLOSING[k] for k in used[at]]
                found.setdefault(at, table.problem(at, column(names, at), message(at)))

    def last(names, at):
        return names[-1]

    with np.errstate(invalid="ignore"):
        refuse(
            np.isnan(closed.A1 + closed.A2 + closed.b1 + closed.b2),
            lambda names, at: names[0],
            lambda at: "no yarn of the model has this crimp",
        )
        for direction, A in zip(DIRECTIONS, (closed.A1, closed.A2)):
            slope = A / transitions[direction].rise
            refuse(
                slope > LARGEST_SLOPE,
                lambda names, at: responsible(direction, names),
                lambda at: too_steep(direction, slope[at], responsible(direction, [CLOSING[k] for k in used[at]])),
            )
        fabric = measured.closing[4]
        refuse(
            fabric < least * (1 - ROUNDING),
            last,
            lambda at: f"{fabric[at]:g} is below {' + '.join(SYMBOLS[k] for k in used[at][:2])} = {least[at]:.4g} mm",
        )
        refuse(
            used.where(ALONE.__contains__) & (fabric <= least * (1 + ROUNDING)),
            last,
            lambda at: (
                f"{fabric[at]:g} is A + b of the same direction again and says nothing of the "
                f"{ALONE[used[at]]}; fill {ALONE[used[at]]}_crimp or {ALONE[used[at]]}_thickness_mm"
            ),
        )
        arcs = _arcs(measured, transitions, closed)
        for direction, A, b, other in (("weft", closed.A1, closed.b1, "warp"), ("warp", closed.A2, closed.b2, "weft")):
            refuse(~(A > 0), last, lambda at: f"leaves the {direction} an amplitude A of {A[at]:.4g} mm, not above 0")
            refuse(~(b > 0), last, lambda at: f"leaves the {direction} a thickness of {b[at]:.4g} mm, not above 0")
            for plateau, side in CONTACT_SIDE.items():
                edge = arcs[direction, plateau].edge_rise
                refuse(
                    ~measured.round & ~(edge < b),
                    lambda names, at: f"{other}_crimp" if f"{other}_crimp" in names else names[-1],
                    lambda at: (
                        f"the contact rise at the {direction}'s edges, {edge[at]:.4g} mm, "
                        f"is not below the {direction} thickness {b[at]:.4g} mm"
                    ),
                )
                refuse(
                    ~measured.round & ~(edge + measured.lateral < b),
                    lambda names, at: "lateral_height_mm",
                    lambda at: (
                        f"{measured.lateral[at]:g} is not below the {b[at] - edge[at]:.4g} mm "
                        f"that the contact rise leaves at the {direction}'s edges"
                    ),
                )
                refuse(
                    measured.round & ~(arcs[direction, plateau].top < b),
                    lambda names, at: f"{'weft' if measured.balanced[at] else direction}_contact_{side}_mm",
                    lambda at: (
                        f"a chord of {measured.chord[direction, plateau][at]:.4g} mm leaves arcs "
                        f"{arcs[direction, plateau].top[at]:.4g} mm high, not below the "
                        f"{direction} thickness {b[at]:.4g} mm"
                    ),
                )
            half = _between_half_chord(measured, direction)
            refuse(
                measured.round & ~(measured.width[direction] / 2 - half < b / 2),
                lambda names, at: f"{'weft' if measured.balanced[at] else direction}_contact_top_mm",
                lambda at: (
                    f"between crossings the arcs would be {measured.width[direction][at] - 2 * half[at]:.4g} mm high, "
                    f"not below the {direction} thickness {b[at]:.4g} mm"
                ),
            )
    return found


@dataclass(frozen=True)
class _Arcs:
    """How a contact profile ends where the crossed yarn turns; arrays of shape (rows,), mm."""

    slope: np.ndarray  # at the end of the chord
    rise: np.ndarray  # there
    edge_rise: np.ndarray  # at the section's edge, where the parabola is carried on to it
    top: np.ndarray  # highest point of a round section's arc above the contact side, for either kind of side


def _arcs(measured, transitions, closed) -> dict[tuple[str, str], _Arcs]:
    """The contact profiles' ends by direction and plateau."""
    found = {}
    slopes = {d: A / transitions[d].rise for d, A in zip(DIRECTIONS, (closed.A1, closed.A2))}
    for d, crossed in (("weft", "warp"), ("warp", "weft")):
        for plateau in PLATEAUX:
            half, offset, width = measured.chord[d, plateau] / 2, measured.offset[d, plateau], measured.width[d]
            p = slopes[crossed] / (2 * (half - offset))
            rise = p * (half - offset) ** 2
            tops = []
            for height, slope in ((rise, slopes[crossed]), (0 * rise, 0 * rise)):
                radius, centre = lateral_arc(0.0, width, half, height, slope)
                tops.append(centre + radius)
            found[d, plateau] = _Arcs(slopes[crossed], rise, p * (width / 2 - offset) ** 2, np.maximum(*tops))
    return found


def _between_half_chord(measured, direction: str) -> np.ndarray:
    """Where parabolas and arcs of a round section between crossings meet: the mean half chord, mm."""
    return (measured.chord[direction, "high"] + measured.chord[direction, "low"]) / 4


def _choose(table, first, second, wrong_first, wrong_second) -> tuple[np.ndarray, np.ndarray]:
    """(second solution chosen, two solutions exist), each boolean (rows,).

    Where the fabric thickness leaves two solutions the row's ``thicker`` cell decides;
    without it the more nearly equal yarn thicknesses, on a tie the weft as the thicker.
    """
    with np.errstate(invalid="ignore"):
        differ = np.abs(first.b1 - second.b1) + np.abs(first.A1 - second.A1) > ROUNDING * first.fabric
        more_even = np.abs(second.b1 - second.b2) < np.abs(first.b1 - first.b2) * (1 - ROUNDING)
    possible_first, possible_second = np.ones((2, len(table)), dtype=bool)
    possible_first[list(wrong_first)] = possible_second[list(wrong_second)] = False
    asked_weft, asked_warp = (np.array([each == d for each in table.thicker], dtype=bool) for d in DIRECTIONS)
    by_default = np.where(possible_first & possible_second, more_even, possible_second)
    return differ & (asked_warp | (by_default & ~asked_weft)), differ & possible_first & possible_second


def _solved(table, measured, transitions, floats, used, closed, other, two) -> dict[str, Sequence]:
    amplitude = {"weft": closed.A1, "warp": closed.A2}
    thickness = {"weft": closed.b1, "warp": closed.b2}
    slope = {d: amplitude[d] / transitions[d].rise for d in DIRECTIONS}
    arcs = _arcs(measured, transitions, closed)
    # a pattern's warps may change sides more or less often than its wefts: then no one crimp is both's
    alike = transitions["weft"].projected == transitions["warp"].projected
    columns: dict[str, object] = {
        "name": list(table.names),
        "family": [table.family] * len(table),
        "over": [weave.over for weave in table.weaves],
        "under": [weave.under for weave in table.weaves],
        "step": [weave.step for weave in table.weaves],
        "pattern": [" ".join(weave.pattern) for weave in table.weaves],
        "section": list(table.sections),
        "lateral_height_mm": measured.lateral,
        "float_gap": list(table.float_gaps),
        "parameters": _parameters(table, measured),
        "identified_by": _texts([" ".join(CLOSING[k] for k in held) for held in _SETS], used.number),
        "fabric_thickness_mm": closed.fabric,
    }
    # the weft starts in the middle of its low float, the warp in that of its high one
    # (A.1)-(A.12); frame R of Fig. 15
    heights = {"weft": (0.0 * closed.A1, closed.A1), "warp": ((closed.A1 + closed.A2) / 2, (closed.A1 - closed.A2) / 2)}
    for d in DIRECTIONS:
        t = transitions[d]
        u_start, u_end = (t.u_low, t.u_high) if d == "weft" else (t.u_high, t.u_low)
        z_start, z_end = heights[d]
        sign = 1.0 if d == "weft" else -1.0
        p_start, p_end = sign * slope[d] / (2 * u_start), sign * slope[d] / (2 * u_end)
        low, high = floats[d]
        start = low if d == "weft" else high
        crossed = DIRECTIONS[1 - DIRECTIONS.index(d)]
        off_start, off_end = (
            measured.offset[crossed, plateau] for plateau in (("high", "low") if d == "weft" else ("low", "high"))
        )
        leaves = (start - 1) / 2 * t.spacing + off_start
        reaches = (start + 1) / 2 * t.spacing - off_end
        along = (0.0 * leaves, leaves, leaves + u_start, reaches - u_end, reaches, (low + high) / 2 * t.spacing)
        height = (z_start, z_start, z_start + p_start * u_start**2, z_end - p_end * u_end**2, z_end, z_end)
        columns |= {
            f"{d}_crossed_spacing_mm": t.spacing,
            f"{d}_width_mm": measured.width[d],
            f"{d}_thickness_mm": thickness[d],
            f"{d}_crimp": np.where(
                _is_used(used, CLOSING.index(f"{d}_crimp"), measured, alike), _crimp(measured, d), t.crimp(slope[d])
            ),
            f"{d}_slope": slope[d],
            f"{d}_amplitude_mm": amplitude[d],
        }
        number = "1" if d == "weft" else "2"
        columns |= {f"p{number}1": p_start, f"p{number}2": p_end}
        for (_, along_column, height_column), x, z in zip(point_columns(d), along, height):
            columns |= {along_column: x, height_column: z}
        columns |= _section_columns(measured, arcs, d, thickness[d])
    for d, b in (("weft", other.b1), ("warp", other.b2)):
        others: list = [""] * len(table)
        for at in np.flatnonzero(two).tolist():
            others[at] = float(b[at])
        columns[f"other_{d}_thickness_mm"] = others
    return columns


def _texts(texts: Sequence[str], number: np.ndarray) -> list[str]:
    return [texts[at] for at in number.tolist()]


def _parameters(table: Family, measured: _Measured) -> np.ndarray:
    """Number of the paper's parameters that a row uses (sections 5.1, 5.2)."""

    def any_given(quantity: str) -> np.ndarray:
        columns = [f"{d}_{quantity}_{side}_mm" for d in DIRECTIONS for side in ("top", "bottom")]
        return np.any([~np.isnan(table.measured[column]) for column in columns], axis=0)

    chords, offsets = any_given("contact"), any_given("offset")
    a_direction = np.select([measured.round, offsets, chords], [9, 6, 4], 0)
    return np.where(measured.balanced, np.maximum(a_direction, 3), np.where(a_direction, 2 * a_direction, 7))


def _section_columns(measured, arcs, d: str, thickness: np.ndarray) -> dict[str, np.ndarray]:
    """The conics of one direction's sections (Fig. 9, 17)."""
    columns = {}
    width, rounded = measured.width[d], measured.round
    for plateau, opposite in (("low", "high"), ("high", "low")):
        half, profile = measured.chord[d, plateau] / 2, arcs[d, plateau]
        columns[f"{d}_{plateau}_chord_mm"] = 2 * half
        columns[f"{d}_{plateau}_offset_mm"] = measured.offset[d, plateau]
        for kind, left, right in (("float", 0, 0), ("edge", 0, 1), ("turn", 1, 1)):
            with np.errstate(invalid="ignore"):
                q, v0 = free_parabola(
                    thickness, width, left * profile.edge_rise, right * profile.edge_rise, measured.lateral
                )
            ends = [sign * measured.chord[d, opposite] / 2 for sign in (-1, 1)]
            found = np.array([q, v0, *ends])
            if rounded.any():
                some = np.flatnonzero(rounded)
                sides = [
                    lateral_arc(
                        thickness[some], width[some], half[some], k * profile.rise[some], k * profile.slope[some]
                    )
                    for k in (left, right)
                ]
                found[:, some] = round_free_side(thickness[some], width[some], *sides)
            for name, values in zip(("q", "v0_mm", "left_mm", "right_mm"), found):
                columns[f"{d}_{plateau}_{kind}_{name}"] = values
    half = _between_half_chord(measured, d)
    pointed = 2 * (thickness - measured.lateral) / width**2
    columns[f"{d}_between_q"] = np.where(rounded, round_between(thickness, width, half)[0], pointed)
    columns[f"{d}_between_end_mm"] = np.where(rounded, half, width / 2)
    return columns


def _crimp(measured: _Measured, direction: str) -> np.ndarray:
    """Measured crimp of a direction, a balanced row's weft crimp for its warp."""
    weft, warp = measured.closing[:2]
    return weft if direction == "weft" else np.where(measured.balanced, weft, warp)


def _is_used(used, column: int, measured: _Measured, alike: np.ndarray) -> np.ndarray:
    """Boolean (rows,): the quantity of that number in CLOSING identified the row.

    In a balanced row the weft's crimp is the warp's too where both float ``alike``.
    """
    return used.where(lambda held: column in held) | (
        (column == 1) & used.where(lambda held: held == (0,)) & measured.balanced & alike
    )
