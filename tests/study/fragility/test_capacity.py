"""Lognormal capacities from their bounds: found again where they are known, silent where nothing tells them."""

import numpy as np
import pytest

from blockshake.study.fragility.capacity import Capacity, fit_capacity, likely_capacities

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


@pytest.mark.parametrize("size", [8, 20, 50])
def test_limits_hold_what_they_are_of_as_often_as_they_say(size):
    """95 of 100, less four standard errors of 100 trials: median, dispersion and the level of 5 %."""
    inside = []
    for seed in range(100):
        likely = likely_capacities(*bounds(drawn(size, 100 + seed)))
        known = Capacity(MEDIAN, DISPERSION)
        inside.append([
            of(likely).min() <= of(known) <= of(likely).max()
            for of in (lambda one: one.median, lambda one: one.dispersion, lambda one: one.level(0.05))
        ])  # fmt: skip
    assert (np.mean(inside, axis=0) >= 0.95 - 4.0 * np.sqrt(0.95 * 0.05 / 100)).all()


def test_samples_that_leave_a_capacity_open_give_no_limits():
    """Two samples on two sides: any dispersion does."""
    assert np.isnan(likely_capacities([1.0, 0.0], [np.inf, 0.5])).all()


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
