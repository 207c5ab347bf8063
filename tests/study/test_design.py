"""Designs and sensitivities: properties of the samples, indices against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from fabric_cad.study.design import DESIGNS, Samples
from fabric_cad.study.factors import Normal, Uniform, Values, levels, quantiles
from fabric_cad.study.sensitivity import sensitivities

BASE = {"a": 1.0, "b": 5.0, "c": "weft"}


def drawn(design, samples=16, seed=0, **factors):
    return DESIGNS[design](factors, BASE, samples, seed)


def test_a_grid_holds_every_combination_once():
    found = drawn("grid", a=Uniform(0, 1, 3), b=Values((5.0, 7.0)), c=Values(("weft", "warp")))
    rows = set(zip(*(column.tolist() for column in found.values.values())))
    assert len(found) == len(rows) == 3 * 2 * 2
    assert {row[0] for row in rows} == {0.0, 0.5, 1.0}


def test_one_at_a_time_changes_one_factor_at_a_time():
    found = drawn("one-at-a-time", a=Normal(1.0, 0.1), b=Values((4.0, 5.0, 6.0)))
    rows = list(zip(found.labels["changed"], found.values["a"], found.values["b"]))
    assert rows == [
        ("", 1.0, 5.0),
        ("a", 0.9, 5.0),
        ("a", 1.1, 5.0),
        ("b", 1.0, 4.0),
        ("b", 1.0, 6.0),
    ]


@settings(deadline=None)
@given(samples=some.integers(1, 200), seed=some.integers(0, 2**31))
def test_a_latin_hypercube_has_one_sample_in_every_stratum(samples, seed):
    found = drawn("latin-hypercube", samples, seed, a=Uniform(2.0, 4.0), b=Uniform(-1.0, 1.0))
    for low, width, column in ((2.0, 2.0, found.values["a"]), (-1.0, 2.0, found.values["b"])):
        strata = np.floor((column - low) / width * samples).astype(int)
        assert sorted(strata.tolist()) == list(range(samples))


@settings(deadline=None)
@given(power=some.integers(0, 8), seed=some.integers(0, 2**31))
def test_saltellis_matrices_mix_a_column_of_b_into_a(power, seed):
    n = 2**power
    found = drawn("sobol", n, seed, a=Uniform(0.0, 1.0), b=Uniform(0.0, 1.0), c=Normal(0.0, 1.0))
    assert len(found) == n * 5 and found.labels["matrix"][::n] == ["A", "B", "AB a", "AB b", "AB c"]
    assert found.labels["sample"] == list(range(n)) * 5
    for k, name in enumerate(found.values):
        first, second, *mixed = found.values[name].reshape(-1, n)
        for other, block in enumerate(mixed):
            np.testing.assert_array_equal(block, second if other == k else first)


def test_the_same_seed_gives_the_same_samples():
    for design in ("latin-hypercube", "sobol"):
        one, two, three = (
            drawn(design, 8, seed, a=Uniform(0.0, 1.0)).values["a"] for seed in (1, 1, 2)
        )
        np.testing.assert_array_equal(one, two)
        assert not np.array_equal(one, three)


def test_quantiles_follow_the_distribution():
    shares = (np.arange(100_000) + 0.5) / 100_000
    normal = quantiles(Normal(3.0, 0.2), shares)
    assert normal.mean() == pytest.approx(3.0) and normal.std() == pytest.approx(0.2, rel=1e-3)
    assert np.isfinite(quantiles(Normal(3.0, 0.2), np.array([0.0, 1.0]))).all()
    uniform = quantiles(Uniform(1.0, 3.0), shares)
    assert uniform.std() == pytest.approx(2 / 12**0.5, rel=1e-6)
    texts = quantiles(Values(("x", "y", "z")), shares)
    assert all(abs((texts == each).mean() - 1 / 3) < 1e-4 for each in "xyz")
    assert levels(Uniform(1.0, 3.0)).tolist() == [1.0, 3.0]


def ishigami(samples: Samples, a=7.0, b=0.1):
    """Ishigami and Homma (1990), the usual test of Sobol indices, with its closed-form indices."""
    x, y, z = samples.values.values()
    variance = a**2 / 8 + b * np.pi**4 / 5 + b**2 * np.pi**8 / 18 + 0.5
    first = [0.5 * (1 + b * np.pi**4 / 5) ** 2 / variance, a**2 / 8 / variance, 0.0]
    both = 8 * b**2 * np.pi**8 / 225 / variance
    total = [first[0] + both, first[1], both]
    return np.sin(x) + a * np.sin(y) ** 2 + b * z**4 * np.sin(x), first, total


def test_sobol_indices_of_ishigamis_function():
    around = Uniform(-np.pi, np.pi)
    samples = DESIGNS["sobol"]({"x": around, "y": around, "z": around}, {}, 4096, 3)
    values, first, total = ishigami(samples)
    rows = sensitivities("sobol", samples, {"f": values}, ["f"])
    assert [row["factor"] for row in rows] == ["x", "y", "z"]
    assert [row["first_order"] for row in rows] == pytest.approx(first, abs=0.02)
    assert [row["total"] for row in rows] == pytest.approx(total, abs=0.02)
    for row, exact in zip(rows, total):
        assert row["total_low"] - 0.01 <= exact <= row["total_high"] + 0.01


def test_samples_with_a_refused_unit_are_left_out_of_sobol_indices():
    factors = {"x": Uniform(0.0, 1.0), "y": Uniform(0.0, 1.0)}
    samples = DESIGNS["sobol"](factors, {}, 4096, 0)
    values = 3 * samples.values["x"] + samples.values["y"]
    values[[5, 4096 + 9, 3 * 4096 + 70]] = np.nan
    rows = sensitivities("sobol", samples, {"f": values}, ["f"])
    assert rows[0]["samples"] == 2048
    assert [row["total"] for row in rows] == pytest.approx([0.9, 0.1], abs=0.01)


def test_elasticity_of_a_power_is_its_exponent():
    samples = drawn("one-at-a-time", a=Values((0.999, 1.001)), b=Values((4.999, 5.001)))
    values = samples.values["a"] ** 3 / samples.values["b"]
    rows = sensitivities("one-at-a-time", samples, {"f": values}, ["f"])
    assert [row["elasticity"] for row in rows] == pytest.approx([3.0, -1.0], abs=1e-5)
    assert rows[0]["figure_at_high"] - rows[0]["figure_at_low"] == pytest.approx(rows[0]["change"])


def test_rank_correlation_of_a_monotonous_figure_is_one():
    samples = drawn("latin-hypercube", 64, a=Uniform(0.0, 1.0), b=Uniform(0.0, 1.0))
    rows = sensitivities("latin-hypercube", samples, {"f": np.exp(5 * samples.values["a"])}, ["f"])
    assert rows[0]["spearman"] == pytest.approx(1.0) and rows[0]["p_value"] < 1e-12
    assert abs(rows[1]["spearman"]) < 0.5
