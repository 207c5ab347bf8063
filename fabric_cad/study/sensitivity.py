"""Which factor a figure depends on, by the means that a study's design allows.

========================
============================================================================== design
columns
========================
============================================================================== sobol
first-order and total Sobol indices with 95 % intervals (scipy.stats) one-at-a-time             the
figure at the factor's ends, its change, elasticity (change over change, both relative to the base
row) grid, latin-hypercube     Spearman's rank correlation and its p-value (scipy.stats)
========================
==============================================================================
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from .design import Samples
from .figures import headline

RESAMPLES = 200
"""Bootstrap resamples behind the intervals of Sobol indices."""

Row = dict[str, object]


def sensitivities(
    design: str, samples: Samples, figures: Mapping[str, Sequence], asked: Sequence[str] = ()
) -> list[Row]:
    """One row a figure and factor; figures are columns of shape (units,), NaN where a unit has none.

    Those ``asked`` for, else those of :func:`~fabric_cad.study.figures.headline`; one that does not
    vary has no row.
    """
    rows: list[Row] = []
    for name in asked or headline():
        values = _numbers(figures.get(name, [None]))
        if _vary(values):
            rows += [{"figure": name, **row} for row in METHODS[design](samples, values)]
    return rows


def left_out(
    asked: Sequence[str], figures: Mapping[str, Sequence], rows: Sequence[Row]
) -> list[str]:
    """Why figures that were asked for have no row in ``rows``, a sentence each."""
    notes = []
    for name in dict.fromkeys(asked):
        if any(row["figure"] == name for row in rows):
            continue
        values = _numbers(figures.get(name, [None]))
        if np.isnan(values).all():
            notes.append(f"{name} has no sensitivities: no unit has it")
        elif not _vary(values):
            value = values[~np.isnan(values)][0]
            notes.append(
                f"{name} has no sensitivities: it is {value:.6g} in every unit, whatever the factors"
            )
        else:
            notes.append(f"{name} has no sensitivities: too few units have it")

    return notes


def _numbers(values: Sequence) -> np.ndarray:
    return np.array(values, dtype=float)


def _vary(values: np.ndarray) -> bool:
    """Whether there are two values that differ by more than rounding."""
    there = values[~np.isnan(values)]
    return len(there) > 0 and bool(np.ptp(there) > 1e-12 * np.abs(there).max())


def sobol_sensitivity(samples: Samples, values: np.ndarray) -> list[Row]:
    """First-order and total indices from Saltelli's design.

    A base sample with a refused or failed unit is left out, and of the others the first power of
    two is taken.
    """
    from scipy import stats

    n = len(values) // (len(samples.values) + 2)
    blocks = values.reshape(-1, n)
    whole = np.flatnonzero(~np.isnan(blocks).any(axis=0))
    if len(whole) < 2:
        return []
    used = 2 ** int(np.log2(len(whole)))
    blocks = blocks[:, whole[:used]]
    if not _vary(blocks.ravel()):
        return []

    factors = len(samples.values)

    def indices(at: np.ndarray) -> np.ndarray:
        first, second, *mixed = blocks[:, at]
        mixed *= 2 if factors == 1 else 1  # scipy 1.17 fails with one factor alone
        found = stats.sobol_indices(
            func={"f_A": first[None], "f_B": second[None], "f_AB": np.array(mixed)[:, None]}, n=used
        )
        orders = np.array([found.first_order, found.total_order])
        return orders.reshape(2, -1)[:, :factors]

    everything = indices(np.arange(used))
    spread = stats.bootstrap(
        (np.arange(used),),
        indices,
        n_resamples=RESAMPLES,
        vectorized=False,
        method="percentile",
        rng=np.random.default_rng(0),
    ).confidence_interval

    ends = {"": everything, "_low": np.asarray(spread.low), "_high": np.asarray(spread.high)}
    rows: list[Row] = []
    for k, factor in enumerate(samples.values):
        row: Row = {"factor": factor}
        for number, order in enumerate(("first_order", "total")):
            row |= {f"{order}{end}": float(values[number, k]) for end, values in ends.items()}
        rows.append(row | {"samples": used})
    return rows


def one_at_a_time_sensitivity(samples: Samples, values: np.ndarray) -> list[Row]:
    """Change of a figure between the least and greatest value of each factor that gave one."""
    changed = np.array(samples.labels["changed"])
    rows: list[Row] = []

    for factor, column in samples.values.items():
        at = np.flatnonzero(((changed == factor) | (changed == "")) & ~np.isnan(values))
        if column.dtype.kind not in "if":
            rows += [
                {"factor": factor, "value": str(column[k]), "figure_value": float(values[k])}
                for k in at
            ]
            continue

        at = at[~np.isnan(column[at].astype(float))]
        if len(at) < 2:
            continue
        low, high = at[column[at].argmin()], at[column[at].argmax()]
        run, rise = float(column[high] - column[low]), float(values[high] - values[low])
        base_factor, base_figure = float(column[0]), float(values[0])
        known = base_figure and not np.isnan(base_figure + base_factor)
        rows.append(
            {
                "factor": factor,
                "low": float(column[low]),
                "high": float(column[high]),
                "figure_at_low": float(values[low]),
                "figure_at_high": float(values[high]),
                "change": rise,
                "elasticity": rise / run * base_factor / base_figure if known else np.nan,
            }
        )

    return rows


def rank_sensitivity(samples: Samples, values: np.ndarray) -> list[Row]:
    """Spearman's correlation of a figure with every factor of numbers."""
    from scipy import stats

    rows: list[Row] = []
    for factor, column in samples.values.items():
        if column.dtype.kind not in "if":
            continue
        there = ~np.isnan(values) & ~np.isnan(column.astype(float))
        if there.sum() > 2 and np.ptp(column[there]) > 0 and _vary(values[there]):
            found = stats.spearmanr(column[there], values[there])
            rows.append(
                {
                    "factor": factor,
                    "spearman": float(found.statistic),
                    "p_value": float(found.pvalue),
                }
            )

    return rows


METHODS: dict[str, Callable[[Samples, np.ndarray], list[Row]]] = {
    "sobol": sobol_sensitivity,
    "one-at-a-time": one_at_a_time_sensitivity,
    "grid": rank_sensitivity,
    "latin-hypercube": rank_sensitivity,
}


def read_sensitivities(folder: str | Path) -> list[Row]:
    """The rows of the ``sensitivity.csv`` in a study's folder; numbers as such, None where a cell is empty.

    No rows where there is no such file: no figure varied.
    """
    if not (Path(folder) / "sensitivity.csv").exists():
        return []
    with open(Path(folder) / "sensitivity.csv", newline="", encoding="utf-8") as file:
        texts = ("figure", "factor", "value")
        return [
            {
                name: cell if name in texts else float(cell) if cell else None
                for name, cell in row.items()
            }
            for row in csv.DictReader(file)
        ]
