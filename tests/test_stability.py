"""A few of the random fabrics of ``make stability``."""

import pytest
from stability import try_fabric


@pytest.mark.parametrize("seed", range(8))
def test_a_random_fabric_is_consistent_or_refused_with_a_reason(seed):
    outcome = try_fabric(seed)
    assert outcome.fine, outcome
    assert outcome.good_elements, outcome
