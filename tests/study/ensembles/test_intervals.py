"""Intervals of shares and quantiles against their definitions."""

import numpy as np
import pytest
from scipy.special import ndtri
from scipy.stats import binom

from blockshake.study.ensembles.intervals import (
    median_interval,
    quantile_interval,
    sample_quantiles,
    share_interval,
)


@pytest.mark.parametrize(("count", "trials"), [(1, 50), (7, 50), (25, 50), (49, 50), (3, 10)])
def test_at_the_limits_so_many_events_have_a_chance_of_a_fortieth(count, trials):
    """The definition of Clopper and Pearson's limits."""
    lower, upper = share_interval(count, trials)
    assert binom.sf(count - 1, trials, lower) == pytest.approx(0.025, rel=1e-9)
    assert binom.cdf(count, trials, upper) == pytest.approx(0.025, rel=1e-9)


def test_no_event_of_fifty_still_has_an_upper_limit():
    """1 - 0.025^(1/50) = 7.1 %."""
    assert share_interval(0, 50) == (0.0, pytest.approx(1.0 - 0.025 ** (1.0 / 50.0)))
    assert share_interval(50, 50) == (pytest.approx(0.025 ** (1.0 / 50.0)), 1.0)


def test_share_is_held_in_at_least_95_of_100_cases():
    for probability in (0.02, 0.1, 0.37, 0.5):
        held = sum(
            binom.pmf(count, 50, probability)
            for count in range(51)
            if share_interval(count, 50)[0] <= probability <= share_interval(count, 50)[1]
        )
        assert held >= 0.95


@pytest.mark.parametrize(("probability", "low", "high"), [(0.5, 0.88, 0.98), (0.95, 0.80, 0.94)])
def test_quantiles_of_fifty_samples_are_held_as_often_as_stated(probability, low, high):
    """93 and 88 of 100 as the docstring says, within three standard deviations of 300 trials, 0.045 and 0.056."""
    held = 0
    for seed in range(300):
        generator = np.random.default_rng(seed)
        found = quantile_interval(generator.normal(size=50), np.array([probability]), generator)[:, 0]
        held += found[0] <= ndtri(probability) <= found[1]
    assert low <= held / 300 <= high


def test_quantiles_are_numpys():
    values = np.random.default_rng(3).normal(size=(31, 4))
    probabilities = np.array([0.05, 0.5, 1.0])
    np.testing.assert_allclose(
        sample_quantiles(values, probabilities), np.quantile(values, probabilities, axis=0), atol=1e-14
    )


@pytest.mark.parametrize(("size", "place"), [(6, 1), (8, 1), (9, 2), (20, 6), (50, 18)])
def test_limits_of_a_median_are_the_innermost_values_that_hold_it_95_times_of_100(size, place):
    """Places as in tables of the sign test; the probability is that of the binomial distribution."""
    found = median_interval(np.random.default_rng(size).permutation(np.arange(1.0, size + 1.0)))
    assert found == ((size + 1) / 2.0, place, size + 1.0 - place)
    assert 1.0 - 2.0 * binom.cdf(place - 1, size, 0.5) >= 0.95 > 1.0 - 2.0 * binom.cdf(place, size, 0.5)


def test_limits_of_few_values_are_the_smallest_and_the_largest():
    assert median_interval(np.array([3.0, np.nan, 1.0])) == (2.0, 1.0, 3.0)
    assert np.isnan(median_interval(np.array([np.nan]))).all()
