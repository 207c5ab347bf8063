"""A few of the random fabrics of ``make stability``."""

import pytest
from stability import try_fabric


@pytest.mark.parametrize(
    ("part", "seed"),
    [("standard", seed) for seed in range(6)]
    + [("general", seed) for seed in (1, 2, 3, 5, 195)]  # 0 and 4 take minutes
    + [("narrow", 0), ("unequal", 0)]
    + [("matrix", seed) for seed in (37, 38, 49)]  # flat, narrow gaps
    + [("matrix-general", seed) for seed in (14, 48, 69)]  # round, flat
    + [("patterns", 45), ("patterns", 58), ("flat-gaps", 23), ("flat-gaps", 30)],  # of few yarns
)
def test_a_random_fabric_is_consistent_or_refused_with_a_reason(part, seed):
    outcome = try_fabric(seed, part)
    assert outcome.fine, outcome
    assert outcome.good_elements, outcome
