"""Lognormal capacities from their bounds: found again where they are known, silent where nothing tells them."""

import numpy as np
import pytest

from blockshake.study.fragility.capacity import Capacity, bootstrap_capacities, fit_capacity

MEDIAN, DISPERSION = 1.6, 0.25
LEVELS = np.arange(0.5, 4.01, 0.25)


def bounds(capacities):
    """The levels around each capacity, 0 and infinity beyond the first and the last."""
    place = np.searchsorted(LEVELS, capacities)
    return np.concatenate([[0.0], LEVELS])[place], np.concatenate([LEVELS, [np.inf]])[place]


def drawn(size, seed):
    return MEDIAN * np.exp(DISPERSION * np.random.default_rng(seed).standard_normal(size))


def test_a_large_sample_has_the_distribution_it_was_drawn_from():
    found = fit_capacity(*bounds(drawn(20000, 1)))
    # standard errors: dispersion / sqrt(n) of the logarithm of the median, and that over sqrt(2) of the dispersion
    assert found.median == pytest.approx(MEDIAN, rel=4.0 * DISPERSION / np.sqrt(20000))
    assert found.dispersion == pytest.approx(DISPERSION, rel=0.03)


def test_probability_and_level_are_each_others_inverse():
    known = Capacity(MEDIAN, DISPERSION)
    assert known.probability(MEDIAN) == 0.5
    assert known.probability(MEDIAN * np.exp(DISPERSION)) == pytest.approx(0.8413447, abs=1e-7)
    assert known.probability(known.level(0.05)) == pytest.approx(0.05)


def test_bootstrap_limits_hold_the_median_about_as_often_as_they_say():
    inside = []
    for seed in range(20):
        lower, upper = bounds(drawn(30, 100 + seed))
        medians = [one.median for one in bootstrap_capacities(lower, upper, np.random.default_rng(seed))]
        low, high = np.quantile(medians, [0.025, 0.975])
        inside.append(low <= MEDIAN <= high)
    # 95 % less the few that a bootstrap of 30 misses; 20 trials spread by 5 %
    assert np.mean(inside) >= 0.8


def test_capacities_that_one_value_would_do_for_have_no_dispersion():
    found = fit_capacity([1.5, 1.25, 1.5], [1.75, 1.75, np.inf])
    assert found.median == pytest.approx(np.sqrt(1.5 * 1.75))
    assert found.dispersion == 0.0
    np.testing.assert_array_equal(found.probability(np.array([1.5, 1.75])), [0.0, 1.0])


@pytest.mark.parametrize(
    ("lower", "upper"), [([4.0, 4.0], [np.inf, np.inf]), ([0.0, 0.0], [0.5, 0.5]), ([], [])]
)
def test_bounds_on_one_side_tell_no_capacity(lower, upper):
    assert np.isnan(fit_capacity(lower, upper)).all()
