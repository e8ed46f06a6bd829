"""The score of an ensemble against theory."""

import numpy as np
import pytest
from fair_score import crps
from scipy.special import ndtr
from scipy.stats import norm

from blockshake.statistics.scores import ensemble_score


def score(members, value, weights=None):
    """`ensemble_score` of single numbers."""
    differences = np.abs(members[:, None] - members)
    weights = np.ones((1, len(members))) if weights is None else weights
    return ensemble_score(np.abs(members - value), differences, weights)[0]


@pytest.mark.parametrize("value", [-1.3, 0.0, 0.4, 2.5])
def test_score_of_a_normal_forecast(value):
    """Gneiting and Raftery (2007), Eq. (21): sigma (z (2 Phi(z) - 1) + 2 phi(z) - 1 / sqrt(pi))."""
    z = value
    exact = z * (2.0 * ndtr(z) - 1.0) + 2.0 * norm.pdf(z) - 1.0 / np.sqrt(np.pi)
    members = norm.ppf((np.arange(2_000) + 0.5) / 2_000)
    assert score(members, value) == pytest.approx(exact, abs=1e-3)


def test_score_of_few_members_is_fair():
    """Unbiased for any number of members: the mean over many ensembles of two is that of the distribution."""
    members = np.random.default_rng(1).normal(size=(2, 400_000))
    exact = 2.0 * norm.pdf(0.0) - 1.0 / np.sqrt(np.pi)
    # standard error of the mean: about 1 / sqrt(400,000)
    assert score(members, np.zeros(400_000)).mean() == pytest.approx(exact, abs=4.0 / np.sqrt(400_000))


def test_order_and_scale_of_the_weights_change_nothing():
    rng = np.random.default_rng(2)
    members, value = rng.normal(size=(7, 30)), rng.normal(size=30)
    np.testing.assert_allclose(score(members, value), crps(members, value), rtol=1e-12)
    np.testing.assert_allclose(score(members[::-1], value), crps(members, value), rtol=1e-12)
    np.testing.assert_allclose(
        score(members, value, np.full((1, 7), 1 / 7)), crps(members, value), rtol=1e-12
    )


def test_a_member_without_weight_does_not_count():
    members, value = np.array([1.0, 2.0, 4.0, 9.0]), 3.0
    # by hand: (2 + 1 + 1) / 3 - (1 + 3 + 2) / (3 * 2)
    assert score(members, value, np.array([[1.0, 1.0, 1.0, 0.0]])) == pytest.approx(
        4.0 / 3.0 - 1.0, rel=1e-14
    )
    assert np.isnan(score(members, value, np.array([[0.0, 1.0, 0.0, 0.0]])))
