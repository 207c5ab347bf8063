"""A few of the random fabrics of ``make stability``."""

import pytest
from stability import try_fabric


@pytest.mark.parametrize(
    ("kind", "seed"), [("standard", seed) for seed in range(6)] + [("general", seed) for seed in (*range(6), 195)]
)
def test_a_random_fabric_is_consistent_or_refused_with_a_reason(kind, seed):
    outcome = try_fabric(seed, kind)
    assert outcome.fine, outcome
    assert outcome.good_elements, outcome
