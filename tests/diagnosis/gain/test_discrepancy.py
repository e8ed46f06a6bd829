"""The discrepancy against the exact conditional law of a Gaussian process, and in its limits."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from blockshake.diagnosis.gain.discrepancy import (
    Condition,
    Discrepancy,
    _likelihoods,
    _places,
    _process,
    fit_discrepancy,
    members_with_discrepancy,
)

OPEN = [Condition("alkion", 1.0), Condition("alkion", 2.5), Condition("basso-tirreno", 2.0)]
NAMES = [f"feature{number}" for number in range(60)]


def covariance(first, second, variance, length, correlation):
    """The kernel, written out."""
    return np.array(
        [
            [
                variance
                * np.exp(-0.5 * (np.log(a.peak_acceleration / b.peak_acceleration) / length) ** 2)
                * (1.0 if a.motion == b.motion else correlation)
                for b in second
            ]
            for a in first
        ]
    )


@pytest.mark.parametrize(
    "sealed", [Condition("alkion", 3.0), Condition("basso-tirreno", 2.5), Condition("third", 1.0)]
)
def test_prediction_is_the_conditional_normal(sealed):
    missed = np.random.default_rng(0).normal(size=(3, 5))
    noise = np.array([0.2, 0.4, 0.1])
    variance = np.array([1.5, 0.3, 1.5, 1e4, 0.3])
    mean, deviation = Discrepancy(NAMES[:5], OPEN, missed, noise, variance, 0.7, 0.6).predict(sealed)
    for place, own in enumerate(variance):
        known = covariance(OPEN, OPEN, own, 0.7, 0.6) + np.diag(noise)
        across = covariance([sealed], OPEN, own, 0.7, 0.6)
        assert mean[place] == pytest.approx(
            (across @ np.linalg.solve(known, missed[:, place])).item(), rel=1e-9
        )
        left = own - (across @ np.linalg.solve(known, across.T)).item()
        assert deviation[place] ** 2 == pytest.approx(left, rel=1e-9)


def fitted(variance, correlation, seed=1, count=40):
    """Fit to residuals drawn from the process, with members of variance 0.25 about them."""
    generator = np.random.default_rng(seed)
    law = covariance(OPEN, OPEN, variance, 1.0, correlation) if variance else np.zeros((3, 3))
    missed = np.linalg.cholesky(law + 0.25 * np.eye(3)) @ generator.normal(size=(3, len(NAMES)))
    strata = np.linspace(-1.0, 1.0, count)
    strata *= 0.5 / strata.std(ddof=1)
    members = [np.repeat(strata[:, None], len(NAMES), axis=1) for _ in OPEN]
    return fit_discrepancy(OPEN, [NAMES] * 3, list(missed), members)


def test_the_likelihood_finds_the_law():
    apart, together = fitted(variance=100.0, correlation=0.0), fitted(variance=100.0, correlation=1.0)
    assert apart.correlation <= 0.25
    assert together.correlation >= 0.75
    # the variance of three values has a median of 0.8 of its mean, and the grid steps of 3.2
    assert 20.0 < np.median(apart.variance) < 200.0
    np.testing.assert_allclose(apart.noise, 0.25)


def test_likelihood_is_that_of_the_normal_law():
    missed = np.random.default_rng(5).normal(size=(3, 4))
    noise = np.array([0.2, 0.4, 0.1])
    process = _process(2.0, 0.7, noise)
    found = _likelihoods(process, _places(OPEN, 0.7, 0.6), missed)
    law = multivariate_normal(np.zeros(3), covariance(OPEN, OPEN, 2.0, 0.7, 0.6) + np.diag(noise))
    np.testing.assert_allclose(found, law.logpdf(missed.T), rtol=1e-9)


def test_a_model_that_misses_nothing_is_left_nearly_alone():
    found = fitted(variance=0.0, correlation=0.5)
    mean, deviation = found.predict(Condition("alkion", 2.4))
    # residuals of variance 0.25 are all that the members allow for: half of the features get no variance at all
    assert np.median(found.variance) <= 0.1
    assert np.median(deviation) < 0.35
    assert np.abs(mean).mean() < 0.25


def test_one_feature_that_is_far_off_does_not_widen_the_others():
    generator = np.random.default_rng(6)
    missed = generator.normal(0.0, 0.5, (3, 10))
    members = [np.random.default_rng(7).normal(0.0, 0.5, (40, 10)) for _ in OPEN]
    plain = fit_discrepancy(OPEN, [NAMES[:10]] * 3, list(missed), members)
    missed[:, 4] = 16000.0
    far = fit_discrepancy(OPEN, [NAMES[:10]] * 3, list(missed), members)
    sealed = Condition("basso-tirreno", 2.5)
    assert far.predict(sealed)[0][4] > 8000.0
    others = np.arange(10) != 4
    assert far.predict(sealed)[1][others].max() < 2.0 * max(plain.predict(sealed)[1].max(), 0.5)


def test_what_was_missed_is_missed_again_nearby_and_forgotten_far_away():
    found = Discrepancy(
        NAMES[:1], OPEN, np.array([[3.0], [3.0], [3.0]]), np.full(3, 1e-6), np.array([4.0]), 0.5, 0.0
    )
    near, sure = found.predict(Condition("alkion", 2.5))
    far, unsure = found.predict(Condition("third", 2.5))
    assert near[0] == pytest.approx(3.0, abs=1e-3)
    assert sure[0] < 0.01
    assert far[0] == pytest.approx(0.0, abs=1e-4)
    assert unsure[0] == pytest.approx(2.0, rel=1e-6)


def test_members_get_its_mean_and_its_spread():
    found = Discrepancy(
        NAMES[:2], OPEN, np.array([[3.0, -1.0]] * 3), np.full(3, 0.1), np.array([4.0, 0.5]), 0.5, 0.0
    )
    sealed = Condition("basso-tirreno", 2.5)
    names = ["another", *NAMES[:2]]
    members = np.random.default_rng(2).normal(size=(200, 3))
    result = members_with_discrepancy(found, sealed, names, members)
    mean, deviation = found.predict(sealed)
    np.testing.assert_array_equal(result[:, 0], members[:, 0])
    np.testing.assert_allclose((result - members)[:, 1:].mean(axis=0), mean, atol=1e-12)
    np.testing.assert_allclose((result - members)[:, 1:].std(axis=0, ddof=1), deviation, rtol=1e-12)
    assert abs(np.corrcoef((result - members)[:, 1], (result - members)[:, 2])[0, 1]) < 4.0 / np.sqrt(200)


def test_features_that_an_open_test_lacks_are_none_of_it():
    members = [np.random.default_rng(3).normal(size=(20, 2)) for _ in OPEN]
    names = [["a", "b"], ["b", "a"], ["b", "c"]]
    found = fit_discrepancy(
        OPEN, names, [np.array([1.0, 2.0]), np.array([2.0, 1.0]), np.array([2.0, 9.0])], members
    )
    assert found.features == ["b"]
    np.testing.assert_allclose(
        found.missed[:, 0],
        [2.0 - runs[:, own.index("b")].mean() for runs, own in zip(members, names, strict=True)],
    )
