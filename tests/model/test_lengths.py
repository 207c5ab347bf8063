"""The length equation against quadrature, its own residual and the published values."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from fabric_cad.model.lengths import excess_length, slope_from_crimp

crimps = st.floats(1e-5, 0.2)
shares = st.floats(0.3, 0.99)


@given(slope=st.floats(1e-3, 3.0), parabola=st.floats(0.1, 5.0), gap=st.floats(0.0, 2.0))
def test_excess_is_the_arc_length_beyond_the_projection(slope, parabola, gap):
    def integrand(x):  # half parabola whose slope grows from 0 to `slope` over `parabola` / 2
        return np.hypot(1.0, slope * x / (parabola / 2)) - 1.0

    arcs = 2 * quad(integrand, 0, parabola / 2, epsabs=1e-15, epsrel=1e-12)[0]
    expected = arcs + gap * (np.hypot(1.0, slope) - 1.0)
    assert excess_length(slope, parabola, gap) == pytest.approx(expected, rel=1e-8)


def test_excess_is_smooth_where_its_series_ends():
    below, above = (
        excess_length(np.nextafter(0.3, 0), 2.0, 0.0),
        excess_length(np.nextafter(0.3, 1), 2.0, 0.0),
    )
    assert above == pytest.approx(below, rel=2e-14)


@given(crimp=crimps, share=shares, repeats=st.integers(2, 16))
def test_slope_solves_the_length_equation(crimp, share, repeats):
    projected = repeats / 2
    slope = slope_from_crimp(crimp, projected, share, 1 - share)
    assert abs(excess_length(slope, share, 1 - share) / (crimp * projected) - 1) < 1e-12


def test_residual_over_the_whole_range_of_crimps_at_once():
    crimp, share = np.meshgrid(np.logspace(-5, np.log10(0.2), 400), np.linspace(0.3, 0.99, 50))
    slope = slope_from_crimp(crimp, 1.0, share, 1 - share)
    assert np.max(np.abs(excess_length(slope, share, 1 - share) / crimp - 1)) < 1e-12


@given(crimp=crimps, factor=st.floats(1.001, 2.0), share=shares)
def test_slope_grows_with_crimp(crimp, factor, share):
    slopes = slope_from_crimp([crimp, crimp * factor], 1.0, share, 1 - share)
    assert slopes[1] > slopes[0]


@pytest.mark.parametrize("crimp", [0.0, -0.01, np.nan, np.inf])
def test_no_crimp_gives_no_slope(crimp):
    assert np.isnan(slope_from_crimp(crimp, 1.0, 0.8, 0.2))
