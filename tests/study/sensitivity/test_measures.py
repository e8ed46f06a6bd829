"""Sensitivity measures where the answer is known: linear, Ishigami's, interaction, independence."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ndtri
from scipy.stats import binom

from blockshake.statistics.resampling import bootstrap_interval, chance_level
from blockshake.study.sensitivity.measures import (
    class_count,
    first_order_share,
    partial_rank_correlation,
)


def hypercube(generator, n_samples, n_inputs):
    """Latin hypercube of probabilities."""
    columns = [generator.permutation(n_samples) for _ in range(n_inputs)]
    return (np.column_stack(columns) + 0.5) / n_samples


def as_output(values):
    return values.reshape(len(values), -1, 1)


def test_partial_rank_correlation_of_a_linear_function_of_normal_variables():
    """Ranks of normal variables correlate by 6 / pi asin(r / 2) (Pearson 1907); the partial one follows exactly."""
    slopes, noise, n_samples = np.array([3.0, -1.0, 0.5, 0.0]), 1.0, 20_000
    generator = np.random.default_rng(1)
    inputs = generator.normal(size=(n_samples, 4))
    output = inputs @ slopes + noise * generator.normal(size=n_samples)
    found, explained = partial_rank_correlation(inputs, as_output(output))
    of_values = slopes / np.sqrt((slopes**2).sum() + noise**2)
    of_ranks = 6.0 / np.pi * np.arcsin(of_values / 2.0)
    whole = np.eye(5)
    whole[4, :4] = whole[:4, 4] = of_ranks
    inverse = np.linalg.inv(whole)
    expected = -inverse[4, :4] / np.sqrt(inverse[4, 4] * np.diag(inverse)[:4])
    # four standard errors of a correlation, (1 - r^2) / sqrt(n), at most 1 / sqrt(n)
    np.testing.assert_allclose(found[0], expected, atol=4.0 / np.sqrt(n_samples))
    assert explained[0] == pytest.approx((of_ranks**2).sum(), abs=4.0 / np.sqrt(n_samples))


def test_partial_correlation_is_that_of_the_residuals():
    """The definition: correlation of what is left of ranks when those of the other inputs are regressed out."""
    generator = np.random.default_rng(2)
    inputs = generator.normal(size=(40, 3)) @ np.array([[1.0, 0.6, 0.0], [0.0, 1.0, 0.3], [0.0, 0.0, 1.0]])
    output = np.exp(inputs[:, 0]) + generator.normal(size=40)
    found = partial_rank_correlation(inputs, as_output(output))[0][0]
    ranks = np.argsort(np.argsort(np.column_stack([inputs, output]), axis=0), axis=0).astype(float)
    for own in range(3):
        others = np.column_stack([np.ones(40), np.delete(ranks[:, :3], own, axis=1)])
        left = [
            column - others @ np.linalg.lstsq(others, column, rcond=None)[0]
            for column in (ranks[:, own], ranks[:, 3])
        ]
        assert found[own] == pytest.approx(np.corrcoef(*left)[0, 1], abs=1e-12)


def ishigami(probabilities):
    first, second, third = (2.0 * probabilities.T - 1.0) * np.pi
    return np.sin(first) + 7.0 * np.sin(second) ** 2 + 0.1 * third**4 * np.sin(first)


def test_first_order_share_of_ishigamis_function():
    """Ishigami and Homma (1990), a = 7, b = 0.1: 0.3139, 0.4424, 0."""
    n_samples = 1000
    variance = 0.5 + 7.0**2 / 8.0 + 0.1 * np.pi**4 / 5.0 + 0.1**2 * np.pi**8 / 18.0
    exact = np.array([0.5 * (1.0 + 0.1 * np.pi**4 / 5.0) ** 2, 7.0**2 / 8.0, 0.0]) / variance
    np.testing.assert_allclose(exact, [0.3139, 0.4424, 0.0], atol=1e-4)
    # what classes can see of it: the variance of the class means of each main effect
    edges = np.linspace(-np.pi, np.pi, class_count(n_samples) + 1)
    effects = (lambda x: (1.0 + 0.1 * np.pi**4 / 5.0) * np.sin(x), lambda x: 7.0 * (np.sin(x) ** 2 - 0.5))
    seen = np.zeros(3)
    for place, effect in enumerate(effects):
        means = [quad(effect, low, high)[0] / (high - low) for low, high in pairwise(edges)]
        seen[place] = np.mean(np.square(means)) / variance
    np.testing.assert_allclose(seen, exact, rtol=0.06)  # sin^2 has two periods over 16 classes
    found = np.array(
        [
            first_order_share(inputs, as_output(ishigami(inputs)))[0]
            for inputs in (hypercube(np.random.default_rng(seed), n_samples, 3) for seed in range(20))
        ]
    )
    # mean of 20 designs within four of its standard errors, of at most 0.03 / sqrt(20)
    np.testing.assert_allclose(found.mean(axis=0), seen, atol=4.0 * 0.03 / np.sqrt(20.0))
    assert found.std(axis=0).max() < 0.03


def linear(seed, n_samples, slopes):
    """Normal inputs in a Latin hypercube and their weighted sum."""
    inputs = ndtri(hypercube(np.random.default_rng(seed), n_samples, len(slopes)))
    return inputs, as_output(inputs @ slopes)


SLOPES = np.array([3.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def test_first_order_share_of_a_linear_function_at_fifty_samples():
    """Shares slope^2 / sum slope^2, seen to 0.90 by five classes of a normal variable; the correction is unbiased."""
    edges = ndtri(np.arange(6) / 5.0)
    density = np.exp(-0.5 * edges**2) / np.sqrt(2.0 * np.pi)
    seen = 5.0 * (np.diff(density) ** 2).sum()  # mean of (5 (density difference))^2
    assert seen == pytest.approx(0.897, abs=1e-3)
    expected = seen * SLOPES**2 / (SLOPES**2).sum()
    found = np.array([first_order_share(*linear(seed, 50, SLOPES))[0] for seed in range(400)])
    # four standard errors of the mean of 400 designs, each with a deviation of 0.1 at most
    np.testing.assert_allclose(found.mean(axis=0), expected, atol=4.0 * 0.1 / np.sqrt(400.0))


def test_share_of_a_history_is_the_variance_weighted_mean_of_its_times():
    generator = np.random.default_rng(3)
    inputs = ndtri(hypercube(generator, 50, 4))
    history = inputs @ generator.normal(size=(4, 12)) + generator.normal(size=(50, 12))
    together = first_order_share(inputs, history[:, None, :])[0]
    each = first_order_share(inputs, as_output(history))
    weights = history.var(axis=0) / history.var(axis=0).sum()
    np.testing.assert_allclose(together, weights @ each, atol=1e-12)


def test_what_matters_by_interaction_only_is_no_first_order_effect():
    """x1 x2 of two symmetric variables: the mean over either at a fixed value of the other is zero."""
    inputs = ndtri(hypercube(np.random.default_rng(4), 2000, 2))
    share = first_order_share(inputs, as_output(inputs[:, 0] * inputs[:, 1]))[0]
    # about sqrt(2 (M - 1)) / n = 0.003 for normal outputs, more for the product's heavy tails
    np.testing.assert_allclose(share, 0.0, atol=0.02)


@pytest.mark.parametrize("measure", ["first order", "rank correlation"])
def test_without_effect_one_picture_in_twenty_passes_the_chance_level(measure):
    measured = first_order_share if measure == "first order" else lambda *p: partial_rank_correlation(*p)[0]
    trials, passed = 80, 0
    for seed in range(trials):
        generator = np.random.default_rng(1000 + seed)
        inputs = hypercube(generator, 50, 9)
        outputs = as_output(generator.normal(size=(50, 2)))
        level = chance_level(measured, inputs, outputs, generator, 100)
        passed += np.abs(measured(inputs, outputs)).max() > level
    # 5 % of the trials, and the level itself rests on 100 permutations: between the 0.1 and 99.9 % points at 4 and 7 %
    assert binom.ppf(0.001, trials, 0.04) <= passed <= binom.ppf(0.999, trials, 0.07)


@pytest.mark.parametrize("measure", ["first order", "rank correlation"])
def test_intervals_hold_the_truth_as_often_as_they_say(measure):
    """Linear function with noise, 50 samples; the truth is the same measure's mean over 400 designs."""
    measured = first_order_share if measure == "first order" else lambda *p: partial_rank_correlation(*p)[0]

    def sample(seed):
        inputs, output = linear(seed, 50, SLOPES)
        return inputs, output + 2.0 * np.random.default_rng(seed + 10**6).normal(size=output.shape)

    truth = np.mean([measured(*sample(seed)) for seed in range(400)], axis=0)
    inside = []
    for seed in range(5000, 5040):
        low, high = bootstrap_interval(measured, sample(seed), np.random.default_rng(seed), 200)
        inside.append((low <= truth) & (truth <= high))
    share = np.mean(inside)  # of 40 designs and nine inputs; a design's inputs are nearly independent
    # 95 % requested; the bootstrap may err by a few per cent at 50 samples, hardly ever below
    assert 0.92 <= share <= 0.99


def test_few_samples_have_no_partial_correlation():
    inputs = hypercube(np.random.default_rng(5), 14, 9)
    found, explained = partial_rank_correlation(inputs, as_output(inputs[:, 0]))
    assert np.isnan(found).all()
    assert np.isnan(explained).all()


def test_output_that_is_one_input_leaves_nothing_to_the_others():
    # by the rounding of a processor alone the others would correlate fully with the rest, which is zero
    inputs = hypercube(np.random.default_rng(7), 50, 4)
    found, explained = partial_rank_correlation(inputs, as_output(np.exp(inputs[:, 2])))
    np.testing.assert_array_equal(found, [[0.0, 0.0, 1.0, 0.0]])
    assert explained == 1.0


def test_output_that_does_not_vary_has_no_sensitivity():
    inputs = hypercube(np.random.default_rng(6), 50, 3)
    outputs = as_output(np.column_stack([np.full(50, 0.3), inputs[:, 0]]))
    for found in (first_order_share(inputs, outputs), partial_rank_correlation(inputs, outputs)[0]):
        assert np.isnan(found[0]).all()
        assert np.isfinite(found[1]).all()
