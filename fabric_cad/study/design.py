"""From factors to samples: which values every unit of a study has."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .factors import Factor, levels, quantiles


@dataclass(frozen=True, eq=False)
class Samples:
    """A sampled design: ``values`` maps a factor's column to its values, shape (units,).

    ``labels`` are further columns of the study's table that say what a unit is for.
    """

    values: Mapping[str, np.ndarray]
    labels: Mapping[str, Sequence] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(next(iter(self.values.values())))


def grid(
    factors: Mapping[str, Factor], base: Mapping[str, object], samples: int, seed: int
) -> Samples:
    """Every combination of the factors' levels; the last factor runs fastest."""
    axes = [levels(factor) for factor in factors.values()]
    places = np.indices([len(axis) for axis in axes]).reshape(len(axes), -1)
    return Samples({name: axis[at] for name, axis, at in zip(factors, axes, places)})


def one_at_a_time(
    factors: Mapping[str, Factor], base: Mapping[str, object], samples: int, seed: int
) -> Samples:
    """The base row, then each factor's levels with all others as in the base row.

    The column ``changed`` names the factor. A base value among the levels is not repeated.
    """
    changed = [("", None)]
    for name, factor in factors.items():
        changed += [(name, value) for value in levels(factor).tolist() if value != base[name]]
    values = {
        name: np.array([value if who == name else base[name] for who, value in changed])
        for name in factors
    }
    return Samples(values, {"changed": [who for who, _ in changed]})


def latin_hypercube(
    factors: Mapping[str, Factor], base: Mapping[str, object], samples: int, seed: int
) -> Samples:
    """One sample in each of ``samples`` equally likely strata of every factor (scipy.stats.qmc)."""
    from scipy.stats import qmc

    shares = qmc.LatinHypercube(len(factors), rng=np.random.default_rng(seed)).random(samples).T
    return Samples(
        {name: quantiles(factor, u) for (name, factor), u in zip(factors.items(), shares)}
    )


def sobol(
    factors: Mapping[str, Factor], base: Mapping[str, object], samples: int, seed: int
) -> Samples:
    """Saltelli's design for Sobol indices: matrices A, B and, for each factor, A with its column from B.

    ``samples`` x (factors + 2) units from one Sobol sequence (scipy.stats.qmc), a power of two
    of them for its balance. The columns ``matrix`` and ``sample`` say what a unit is.
    """
    from scipy.stats import qmc

    d = len(factors)
    shares = (
        qmc.Sobol(2 * d, rng=np.random.default_rng(seed), bits=64)
        .random(samples)
        .T.reshape(2, d, samples)
    )
    # A and B
    first, second = (
        [quantiles(factor, u) for factor, u in zip(factors.values(), matrix)] for matrix in shares
    )
    values = {
        name: np.concatenate(
            [first[k], second[k], *(second[k] if k == other else first[k] for other in range(d))]
        )
        for k, name in enumerate(factors)
    }
    matrices = ["A", "B", *(f"AB {name}" for name in factors)]
    labels: dict[str, Sequence[Any]] = {
        "matrix": [matrix for matrix in matrices for _ in range(samples)],
        "sample": list(range(samples)) * len(matrices),
    }

    return Samples(values, labels)


DESIGNS: dict[str, Callable[..., Samples]] = {
    "grid": grid,
    "one-at-a-time": one_at_a_time,
    "latin-hypercube": latin_hypercube,
    "sobol": sobol,
}
"""Design by its name in a study's file."""

RANDOM = ("latin-hypercube", "sobol")
"""Designs that take ``samples`` and a ``seed``."""
