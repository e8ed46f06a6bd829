import numpy as np
import pytest

from blockshake.diagnosis.inference.response import fit_response

SIZES = np.linspace(-2.0, 2.0, 21)
OWN = np.array([-1.7, -0.9, 0.3, 0.8, 1.2, 1.9])


def test_a_response_in_proportion_is_found_and_nothing_is_added_at_the_null_size():
    added = OWN[:, None] * np.array([[3.0, -0.5]])
    response = fit_response(OWN, added, SIZES)
    np.testing.assert_allclose(response.mean, SIZES[:, None] * [[3.0, -0.5]], atol=0.1)
    assert np.abs(response.mean[10]).max() < 1e-9
    assert response.deviation[10].max() < 1e-9
    # a law without scatter is sure of itself
    assert response.deviation[-1].max() < 0.2


def test_features_that_only_scatter_are_predicted_to_scatter():
    generator = np.random.default_rng(0)
    rms = []
    for _ in range(40):
        added = generator.normal(0.0, 2.0, (len(OWN), 3))
        response = fit_response(OWN, added, SIZES)
        rms.append(response.deviation.mean())
    # of Student's t with six degrees of freedom: variance 6 / 4 of the noise's, and what the fit does not know
    assert 2.0 < np.mean(rms) < 2.0 * np.sqrt(1.5) * 1.3


def test_predictions_hold_what_they_promise():
    """Standardised errors at a size that was left out, over many laws with scatter: variance that of Student's t."""
    generator = np.random.default_rng(1)
    errors = []
    for _ in range(300):
        slope, bend, scatter = generator.normal(), 0.3 * generator.normal(), 0.3
        sizes = generator.uniform(-2.0, 2.0, 7)
        law = sizes * (slope + bend * np.abs(sizes) + scatter * generator.normal(size=7))
        response = fit_response(sizes[1:], law[1:, None], sizes[:1])
        errors.append((law[0] - response.mean[0, 0]) / response.deviation[0, 0])
    # t with six degrees of freedom scaled to unit variance; four standard errors
    assert np.mean(np.square(errors)) == pytest.approx(1.0, abs=0.4)


def _correlation(added):
    covariance = fit_response(OWN, added, SIZES).covariance()[-1]
    return covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])


def test_features_of_one_run_scatter_together():
    """A run that adds half as much again adds it to all features: the covariance holds that."""
    generator = np.random.default_rng(2)
    together, alone = [], []
    for _ in range(40):
        factor = 1.0 + 0.4 * generator.normal(size=(len(OWN), 1))
        together.append(_correlation(factor * OWN[:, None] * np.ones((1, 2))))
        alone.append(_correlation(OWN[:, None] * (1.0 + generator.normal(0.0, 0.4, (len(OWN), 2)))))
    # correlations of 1 and of 0, shrunk by a fifth; those of six runs scatter by 0.4, of which as much is left
    assert np.mean(together) == pytest.approx(0.8, abs=0.05)
    assert np.mean(alone) == pytest.approx(0.0, abs=4.0 * 0.32 / np.sqrt(40.0))


def test_an_exchanged_response_is_of_the_same_size():
    generator = np.random.default_rng(3)
    response = fit_response(OWN, generator.normal(size=(len(OWN), 4)), SIZES)
    order = np.array([2, 0, 3, 1])
    other = response.exchanged(order)
    np.testing.assert_array_equal(other.mean, response.mean[:, order])
    np.testing.assert_allclose(other.covariance(), response.covariance()[:, order][:, :, order])
