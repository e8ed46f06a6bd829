"""Distances, widths and scores of made-up curves whose answers are known."""

import numpy as np
import pytest
from fair_score import crps

from blockshake.statistics.resampling import chance_distance, limits_of, rank_chance, resampled_weights
from blockshake.statistics.scores import (
    ensemble_distance,
    ensemble_score,
    mean_differences,
    mean_width,
    member_scores,
)

TIMES = 5
SEED = 3


def constant(values):
    """Curves of one marker that stay at a value each."""
    return np.broadcast_to(np.asarray(values, dtype=float)[:, None, None], (len(values), TIMES, 1)).copy()


def distance_of(own, other):
    both = np.concatenate([constant(own), constant(other)])
    differences = mean_differences(both, both)[..., 0]
    return ensemble_distance(differences, np.arange(len(own)), len(own) + np.arange(len(other)))


def test_equal_ensembles_are_zero_apart():
    values = np.random.default_rng(SEED).normal(size=7)
    assert distance_of(values, values) == pytest.approx(0.0, abs=1e-16)
    assert distance_of([0.2] * 3, [0.2] * 5) == 0.0


def test_narrow_ensembles_are_apart_by_their_shift():
    assert distance_of([0.1] * 3, [0.35] * 4) == pytest.approx(0.25, rel=1e-14)
    # a spread that is far smaller than the shift takes its own mean difference off: 1/2 (4/9 + 4/9) of it
    own = np.array([-1e-3, 0.0, 1e-3])
    assert distance_of(own, own + 1.0) == pytest.approx(1.0 - 8e-3 / 9.0, rel=1e-12)


def test_distance_is_the_integral_over_the_squared_difference_of_the_distributions():
    """Baringhaus and Franz (2004), J. Multivariate Anal. 88: steps of two distribution functions on a fine grid."""
    generator = np.random.default_rng(SEED)
    own, other = generator.normal(size=6), 0.5 + 2.0 * generator.normal(size=9)
    places = np.sort(np.concatenate([own, other]))
    shares = [(one[None, :] <= places[:-1, None]).mean(axis=1) for one in (own, other)]
    expected = ((shares[0] - shares[1]) ** 2 * np.diff(places)).sum()
    assert distance_of(own, other) == pytest.approx(expected, rel=1e-12)


def test_differences_are_means_over_the_times_that_both_curves_have():
    curves = np.array([[0.0, 1.0, np.nan], [2.0, 5.0, 7.0], [np.nan, np.nan, 1.0]])[..., None]
    found = mean_differences(curves, curves)[..., 0]
    np.testing.assert_array_equal(found[1], [3.0, 0.0, 6.0])
    assert np.isnan(found[0, 2])


def test_samples_of_one_distribution_are_mostly_within_the_level_of_chance():
    """5 of 100 divisions are beyond the level; of 40 pairs more than 7 have a chance of 1 in 1000."""
    generator, beyond = np.random.default_rng(SEED), 0
    for _ in range(40):
        both = constant(generator.normal(size=16))
        differences = mean_differences(both, both)[..., 0]
        groups = np.arange(8), np.arange(8, 16)
        beyond += ensemble_distance(differences, *groups) > chance_distance(differences, *groups, generator)
    assert beyond <= 7


def test_shifted_samples_are_beyond_the_level_of_chance():
    generator = np.random.default_rng(SEED)
    values = generator.normal(size=16)
    values[8:] += 3.0
    differences = mean_differences(constant(values), constant(values))[..., 0]
    groups = np.arange(8), np.arange(8, 16)
    assert ensemble_distance(differences, *groups) > 2.0 * chance_distance(differences, *groups, generator)


def test_few_members_have_no_level_of_chance():
    """For 20 divisions of six into halves two are the given one; of 84 of nine into three and six, one is."""
    generator, values = np.random.default_rng(SEED), constant(np.arange(9.0))
    differences = mean_differences(values, values)[..., 0]
    assert np.isnan(chance_distance(differences, np.arange(3), np.arange(3, 6), generator))
    assert np.isfinite(chance_distance(differences, np.arange(3), np.arange(3, 9), generator))


def test_width_is_the_mean_difference_of_two_and_does_not_grow_with_their_number():
    values = np.array([0.0, 1.0, 5.0])
    width = mean_width(mean_differences(constant(values), constant(values))[..., 0], np.ones((1, 3)))
    assert width[0] == pytest.approx((1.0 + 5.0 + 4.0) / 3.0, rel=1e-14)
    # of normal values 2 / sqrt(pi) standard deviations, of few or of many: errors of the means of 400 ensembles
    generator = np.random.default_rng(SEED)
    for size in (4, 20):
        found = [
            mean_width(np.abs(drawn[:, None] - drawn[None]), np.ones((1, size)))[0]
            for drawn in generator.normal(size=(400, size))
        ]
        error = np.std(found, ddof=1) / np.sqrt(len(found))
        assert np.mean(found) == pytest.approx(2.0 / np.sqrt(np.pi), abs=4.0 * error)


def test_resampled_members_are_not_held_against_themselves():
    """Two members a metre apart: a draw of both has the width 1, a draw of one of them has none."""
    differences = np.array([[0.0, 1.0], [1.0, 0.0]])
    width = mean_width(differences, np.array([[1.0, 1.0], [2.0, 0.0]]))
    assert width[0] == 1.0
    assert np.isnan(width[1])
    weights = resampled_weights(5, np.random.default_rng(SEED))
    np.testing.assert_array_equal(weights[0], 1.0)
    np.testing.assert_array_equal(weights.sum(axis=1), 5.0)


def test_score_is_the_mean_continuous_ranked_probability_score():
    generator = np.random.default_rng(SEED)
    members, read = generator.normal(size=(6, TIMES, 1)), generator.normal(size=(TIMES, 1))
    away = mean_differences(members, read[None])[:, 0, 0]
    found = ensemble_score(away, mean_differences(members, members)[..., 0], np.ones((1, 6)))
    assert found[0] == pytest.approx(crps(members, read).mean(), rel=1e-12)


def test_limits_hold_nineteen_of_twenty_draws():
    assert limits_of(np.arange(401.0)) == pytest.approx([10.0, 390.0], rel=1e-12)


def test_chance_is_the_rank_among_the_others():
    others = np.arange(4.0)[:, None] * np.ones(3)
    np.testing.assert_array_equal(rank_chance(np.array([9.0, 2.0, np.nan]), others), [0.2, 0.6, np.nan])


def test_members_are_scored_by_the_others():
    """Against the score of each by the ensemble without it; their mean is half of the width."""
    curves = np.random.default_rng(SEED).normal(size=(6, 4, 2))
    differences = mean_differences(curves, curves)
    expected = [crps(np.delete(curves, place, axis=0), curves[place]).mean(axis=0) for place in range(6)]
    np.testing.assert_allclose(member_scores(differences), expected, rtol=1e-12)
    np.testing.assert_allclose(
        member_scores(differences).mean(axis=0), 0.5 * mean_width(differences, np.ones((1, 6)))[0], rtol=1e-12
    )
