"""Evidence in closed form against the densities that it stands for."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import multivariate_normal, norm

from blockshake.diagnosis.answer.size import size_of
from blockshake.diagnosis.evidence.explanation import best_of
from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.diagnosis.evidence.stop_search import _gains_of_pairs, explain_stops
from blockshake.effects.effect import DesignMatrix


def _covariance(size, seed):
    root = np.random.default_rng(seed).normal(size=(size, size))
    return root @ root.T + size * np.eye(size)


@pytest.fixture(scope="module")
def problem():
    """Two tests of 7 and 5 rows, two nuisances, three columns, and the whole covariance of the rows."""
    generator = np.random.default_rng(3)
    covariances = [_covariance(7, 1), _covariance(5, 2)]
    values = [generator.normal(0.0, 3.0, 7), generator.normal(0.0, 3.0, 5)]
    nuisances = [[generator.normal(size=7), generator.normal(size=5)] for _ in range(2)]
    columns = [generator.normal(size=(7, 3)), generator.normal(size=(5, 3))]
    whole = np.zeros((12, 12))
    whole[:7, :7], whole[7:, 7:] = covariances
    stacked = np.array([np.concatenate(one) for one in nuisances]).T
    return (
        from_rows(covariances, values, nuisances, prior=-0.7),
        np.concatenate(values),
        whole + stacked @ stacked.T,
        columns,
    )


def test_evidence_without_a_cause_is_the_density_of_the_rows(problem):
    likelihood, value, covariance, _ = problem
    expected = (
        multivariate_normal(cov=covariance).logpdf(value) + 0.5 * len(value) * np.log(2.0 * np.pi) - 0.7
    )
    assert likelihood.log_evidence == pytest.approx(expected, rel=1e-12)


def test_gain_is_the_ratio_of_densities_with_and_without_the_columns(problem):
    likelihood, value, covariance, columns = problem
    scales = np.array([0.5, 2.0, 1.0])
    spread = np.concatenate(columns) * scales
    expected = multivariate_normal(cov=covariance + spread @ spread.T).logpdf(value)
    expected -= multivariate_normal(cov=covariance).logpdf(value)
    found = likelihood.amplitudes(likelihood.whiten(columns), scales)
    assert found.gain == pytest.approx(expected, rel=1e-10)


def test_gain_of_a_positive_amplitude_is_an_integral_over_half_its_prior(problem):
    likelihood, value, covariance, columns = problem
    column, scale = np.concatenate(columns)[:, 0], 1.5
    density = multivariate_normal(cov=covariance)

    def integrand(amplitude):
        prior = 2.0 * norm(scale=scale).pdf(amplitude)
        return prior * np.exp(density.logpdf(value - amplitude * column) - density.logpdf(value))

    expected = np.log(quad(integrand, 0.0, 12.0 * scale)[0])
    whitened = likelihood.whiten([one[:, :1] for one in columns])
    assert likelihood.amplitudes(whitened, (scale,), positive=True).gain == pytest.approx(expected, rel=1e-7)
    assert likelihood.single(whitened, scale, positive=True)[0][0] == pytest.approx(expected, rel=1e-7)


def test_gain_of_a_column_without_an_amplitude_is_a_ratio_of_densities(problem):
    likelihood, value, covariance, columns = problem
    density = multivariate_normal(cov=covariance)
    expected = density.logpdf(value - np.concatenate(columns)[:, 0]) - density.logpdf(value)
    whitened = likelihood.whiten([one[:, :1] for one in columns])
    assert likelihood.amplitudes(whitened, None).gain == pytest.approx(expected, rel=1e-10)


def test_sum_of_parts_over_tests_gains_as_the_whole_column_does(problem):
    likelihood, _, _, columns = problem
    parts = [likelihood.parts(likelihood.whiten_one(test, one), test) for test, one in enumerate(columns)]
    summed = [sum(part[key] for part in parts) for key in range(3)]
    found = likelihood.gain_of_sum(*summed, 0.8)
    expected = likelihood.single(likelihood.whiten(columns), 0.8)
    np.testing.assert_allclose(found, expected, rtol=1e-10)


def test_columns_among_the_nuisances_leave_what_they_explained_but_for_the_errors_of_their_form(problem):
    likelihood, value, covariance, columns = problem
    scales, errors = np.array([0.5, 2.0, 1.0]), [np.eye(7), 2.0 * np.eye(5)]
    spread = np.concatenate(columns) * scales
    whole = covariance + spread @ spread.T + np.diag([1.0] * 7 + [2.0] * 5)
    expected = multivariate_normal(cov=whole).logpdf(value)
    beside = likelihood.given(columns, scales, errors).log_evidence
    assert beside == pytest.approx(expected + 0.5 * len(value) * np.log(2.0 * np.pi) - 0.7, rel=1e-12)


def test_two_stops_gain_as_their_two_columns_do_where_neither_pulls():
    generator = np.random.default_rng(5)
    first, second = np.zeros((20, 1)), np.zeros((20, 1))
    first[:8, 0], second[12:, 0] = generator.uniform(1.0, 2.0, 8), generator.uniform(1.0, 2.0, 8)
    value = 3.0 * first[:, 0] + 2.0 * second[:, 0] + generator.normal(size=20)
    likelihood = from_rows([np.eye(20)], [value], [])
    both = np.concatenate([first, second], axis=1)
    target, gram = likelihood.normal_equations(likelihood.whiten([both]))
    gain, means = _gains_of_pairs(target, gram, 1, 4.0)
    free = likelihood.amplitudes(likelihood.whiten([both]), np.array([4.0, 4.0]))
    # far from zero the halves of both priors hold the whole posterior: each adds ln 2
    assert gain[0, 0] == pytest.approx(free.gain + np.log(4.0), abs=1e-4)
    np.testing.assert_allclose(means[:, 0, 0], free.mean, rtol=1e-12)


def test_evidence_of_a_size_that_no_structure_exceeds_is_an_integral_over_its_support(problem):
    likelihood, value, covariance, columns = problem
    column, scale, most = np.concatenate(columns)[:, 0], 1.5, 0.4
    density, prior = multivariate_normal(cov=covariance), norm(scale=scale)

    def integrand(amplitude):
        return prior.pdf(amplitude) * np.exp(
            density.logpdf(value - amplitude * column) - density.logpdf(value)
        )

    inside = prior.cdf(most) - prior.cdf(-most)
    expected = np.log(quad(integrand, -most, most, epsabs=0.0)[0] / inside)
    variant = [DesignMatrix({}, rows[:, :1], (scale,), False, most) for rows in columns]
    found = best_of(likelihood, "eccentricity", "block-1", [variant])
    assert found.gain == pytest.approx(expected, rel=1e-9)
    drawn = size_of("eccentricity", "block-1", *[(found.fits, np.zeros(1))] * 2)["offset"]
    assert -most <= drawn.lower < drawn.upper <= most


def test_two_causes_beside_each_other_have_the_sizes_of_their_joint_posterior(problem):
    """A column among the nuisances leaves the other's amplitude that of both free together."""
    likelihood, _, _, columns = problem
    first, second = ([rows[:, [one]] for rows in columns] for one in (0, 1))
    pair = likelihood.amplitudes(likelihood.whiten([rows[:, :2] for rows in columns]), np.array([0.5, 2.0]))
    none = [np.zeros((len(rows),) * 2) for rows in columns]
    for own, other, scales, number in ((first, second, (0.5, 2.0), 0), (second, first, (2.0, 0.5), 1)):
        beside = likelihood.given(other, np.array([scales[1]]), none)
        alone = beside.amplitudes(beside.whiten(own), np.array([scales[0]]))
        assert alone.mean[0] == pytest.approx(pair.mean[number])
        assert alone.covariance[0, 0] == pytest.approx(pair.covariance[number, number])


@pytest.mark.parametrize(("gap", "is_stop"), [(0.002, False), (0.02, True)])
def test_a_stop_with_the_smallest_gaps_on_both_sides_is_a_spring(gap, is_stop):
    moved = 0.05 * np.sin(np.linspace(0.0, 20.0, 200))
    gaps = (0.002, 0.01, 0.02)

    def force(side, clear):
        return -side * np.maximum(side * moved - clear, 0.0)

    variants = [
        [DesignMatrix({"gap": one, "side": side}, force(side, one)[:, None], (1e7,), True)]
        for side in (1, -1)
        for one in gaps
    ]
    value = 1e6 * (force(1, gap) + force(-1, gap))
    likelihood = from_rows([1e4 * np.eye(200)], [value], [])
    assert (explain_stops(likelihood, "block-1", variants).gain > 0.0) == is_stop
