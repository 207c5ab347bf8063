"""A few of the random fabrics of ``make stability``."""

import pytest
from stability import try_fabric


@pytest.mark.parametrize(
    ("part", "seed"),
    [("standard", seed) for seed in range(6)]
    + [("general", seed) for seed in (*range(6), 195)]
    + [(part, seed) for part in ("patterns", "narrow", "unequal", "flat-gaps") for seed in range(2)],
)
def test_a_random_fabric_is_consistent_or_refused_with_a_reason(part, seed):
    outcome = try_fabric(seed, part)
    assert outcome.fine, outcome
    assert outcome.good_elements, outcome
