"""Intervals of shares and quantiles against their definitions."""

import numpy as np
import pytest
from scipy.stats import binom

from blockshake.statistics.intervals import (
    SURE_FROM,
    quantile_interval,
    quantile_ranks,
    sample_quantiles,
    samples_needed,
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
    # whatever came of two more trials
    assert share_interval(3, 10, 2) == (share_interval(3, 12)[0], share_interval(5, 12)[1])
    assert share_interval(0, 0, 3) == (0.0, 1.0)
    assert share_interval(50, 50) == (pytest.approx(0.025 ** (1.0 / 50.0)), 1.0)


def test_share_is_held_in_at_least_95_of_100_cases():
    for probability in (0.02, 0.1, 0.37, 0.5):
        held = sum(
            binom.pmf(count, 50, probability)
            for count in range(51)
            if share_interval(count, 50)[0] <= probability <= share_interval(count, 50)[1]
        )
        assert held >= 0.95


@pytest.mark.parametrize("size", [6, 10, 11, 20, 50, 59, 60, 72, 100])
@pytest.mark.parametrize("probability", [0.05, 0.25, 0.5, 0.75, 0.95])
def test_limits_hold_a_quantile_as_often_as_stated_or_are_not_given(size, probability):
    """2000 samples of a skewed law against binomial theory, within four standard deviations."""
    ranks, trials = quantile_ranks(size, probability), 2000
    values = np.random.default_rng(size).exponential(size=(size, trials))
    lower, upper = quantile_interval(values, [probability])[:, 0]
    if ranks is None:
        # not even the smallest and the largest value hold it
        assert 1.0 - probability**size - (1.0 - probability) ** size < 0.95
        assert np.isnan([lower, upper]).all()
        return
    theory = binom.cdf(ranks[1] - 1, size, probability) - binom.cdf(ranks[0] - 1, size, probability)
    assert theory >= 0.95
    truth = -np.log1p(-probability)
    held = ((lower <= truth) & (truth <= upper)).mean()
    assert held == pytest.approx(theory, abs=4.0 * np.sqrt(theory * (1.0 - theory) / trials))


def test_samples_needed_are_those_whose_extremes_hold_the_quantile():
    """1 - q^n - (1 - q)^n is 95 % at least (Wilks 1941)."""
    for probability in (0.5, 0.75, 0.9, 0.95):
        size = samples_needed(probability)
        held = (
            1.0
            - probability ** np.array([size - 1, size])
            - (1.0 - probability) ** np.array([size - 1, size])
        )
        assert held[0] < 0.95 <= held[1]
    assert (samples_needed(0.5), samples_needed(0.95)) == (SURE_FROM, 59)


def test_a_value_that_is_missing_is_none_of_the_sample():
    values = np.arange(60.0)[:, None] * [1.0, 1.0]
    values[10:, 1] = np.nan
    limits = quantile_interval(values, [0.5, 0.95])
    np.testing.assert_array_equal(limits[:, 0, 1], [1.0, 8.0])  # of ten
    assert np.isnan(limits[:, 1, 1]).all()
    assert np.isfinite(limits[:, :, 0]).all()
    assert np.isnan(quantile_interval(np.empty((0, 3)), [0.5])).all()


def test_quantiles_are_numpys():
    values = np.random.default_rng(3).normal(size=(31, 4))
    probabilities = np.array([0.05, 0.5, 1.0])
    np.testing.assert_allclose(
        sample_quantiles(values, probabilities), np.quantile(values, probabilities, axis=0), atol=1e-14
    )


@pytest.mark.parametrize(("size", "place"), [(6, 1), (8, 1), (9, 2), (20, 6), (50, 18)])
def test_limits_of_a_median_are_the_innermost_values_that_hold_it_95_times_of_100(size, place):
    """Places as in tables of the sign test; the probability is that of the binomial distribution."""
    assert quantile_ranks(size, 0.5) == (place, size + 1 - place)
    assert 1.0 - 2.0 * binom.cdf(place - 1, size, 0.5) >= 0.95 > 1.0 - 2.0 * binom.cdf(place, size, 0.5)
