import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import norm

from blockshake.study.ensembles.scores import crps


@pytest.mark.parametrize("value", [-1.3, 0.0, 0.4, 2.5])
def test_crps_of_a_normal_forecast(value):
    """Gneiting and Raftery (2007), Eq. (21): sigma (z (2 Phi(z) - 1) + 2 phi(z) - 1 / sqrt(pi))."""
    z = value
    exact = z * (2.0 * ndtr(z) - 1.0) + 2.0 * norm.pdf(z) - 1.0 / np.sqrt(np.pi)
    members = norm.ppf((np.arange(200_000) + 0.5) / 200_000)
    assert crps(members, np.float64(value)) == pytest.approx(exact, abs=1e-4)


def test_crps_of_few_members_is_fair():
    """Unbiased for any number of members: the mean over many ensembles of two is that of the distribution."""
    members = np.random.default_rng(1).normal(size=(2, 400_000))
    exact = 2.0 * norm.pdf(0.0) - 1.0 / np.sqrt(np.pi)
    # standard error of the mean: about 1 / sqrt(400,000)
    assert crps(members, np.zeros(400_000)).mean() == pytest.approx(exact, abs=4.0 / np.sqrt(400_000))


def test_members_that_are_missing_do_not_count():
    members = np.array([[1.0, np.nan, np.nan], [2.0, 2.0, np.nan], [4.0, 4.0, 4.0]])
    scores = crps(members, np.array([3.0, 3.0, 3.0]))
    # by hand: (2 + 1 + 1) / 3 - (1 + 3 + 2) / (3 * 2), then (1 + 1) / 2 - 2 / 2
    np.testing.assert_allclose(scores[:2], [4.0 / 3.0 - 1.0, 0.0])
    assert np.isnan(scores[2])
    assert np.isnan(crps(members, np.array([np.nan, 0.0, 0.0]))[0])


def test_the_order_of_members_changes_nothing():
    rng = np.random.default_rng(2)
    members, value = rng.normal(size=(7, 30)), rng.normal(size=30)
    np.testing.assert_allclose(crps(members, value), crps(members[::-1], value), rtol=1e-12)
    pairs = np.abs(members[:, None] - members[None]).sum(axis=(0, 1)) / (2 * 7 * 6)
    np.testing.assert_allclose(crps(members, value), np.abs(members - value).mean(axis=0) - pairs, rtol=1e-12)
