"""Answers on parameters against truths that are known: a response in closed form, shuffled samples, equal scores."""

import numpy as np
import pytest
from fair_score import crps
from numpy.testing import assert_allclose
from scipy.stats import binomtest

from blockshake.study.calibration.answers import (
    LEVEL,
    answer_hypotheses,
    chance_of_test,
    distances,
    weighted_scores,
    weights_near,
)

N_SAMPLES, N_TIMES = 30, 40


def _samples(generator, size=N_SAMPLES):
    """Shares of two parameters, each spread evenly over its range, dealt at random."""
    strata = (np.arange(size) + 0.5) / size
    return generator.permutation(strata), generator.permutation(strata)


def _response(first, nuisance, generator, chaotic=1.0):
    """Readings that follow the first parameter and a nuisance, and late ones that follow neither."""
    time = np.linspace(0.0, 1.0, N_TIMES)
    early = (np.asarray(first)[..., None] + 0.2 * np.asarray(nuisance)[..., None]) * time
    late = chaotic * generator.normal(size=early.shape)
    return np.where(time < 0.5, early + 0.01 * late, late)


def _campaign(generator, truth, strength=1.0, n_tests=3):
    """Shares of a parameter that acts and of one that does not, and tests whose truth lies at a share."""
    acts, idle = _samples(generator)
    tests = []
    for _ in range(n_tests):
        readings = _response(strength * acts, generator.normal(size=N_SAMPLES), generator)
        measured = _response(strength * truth, generator.normal(), generator)
        tests.append(distances(readings, measured))
    return acts, idle, tests


def test_equal_weights_give_the_fair_score():
    """Ferro (2014): the weighted score of equal weights is his, over the mean difference of two samples."""
    generator = np.random.default_rng(1)
    readings, measured = generator.normal(size=(12, 5)), generator.normal(size=5)
    found = distances(readings, measured)
    every = np.concatenate([readings, measured[None]])
    scale = np.abs(every[:, None] - every).sum(axis=(0, 1)) / (13 * 12)
    expected = (crps(readings, measured) / scale).mean()
    assert_allclose(weighted_scores(np.full((1, 12), 1 / 12), found), expected, rtol=1e-12)


def test_a_test_that_is_one_of_the_samples_scores_a_half_in_the_mean():
    generator = np.random.default_rng(2)
    scores = []
    for _ in range(300):
        drawn = generator.normal(size=(21, 10))
        scores.append(weighted_scores(np.full((1, 20), 0.05), distances(drawn[1:], drawn[0]))[0])
    assert abs(np.mean(scores) - 0.5) < 4.0 * np.std(scores) / np.sqrt(len(scores))


def test_samples_without_an_answer_and_gaps_have_no_part():
    generator = np.random.default_rng(3)
    readings, measured = generator.normal(size=(10, 6)), generator.normal(size=6)
    cut = np.concatenate([readings, np.full((1, 6), np.nan)])
    gap = np.append(measured, np.nan)
    whole = distances(readings, measured)
    found = distances(np.concatenate([cut, np.ones((11, 1))], axis=1), gap)
    shares = np.linspace(0.0, 1.0, 11)
    values = np.array([0.3, 0.6])
    assert_allclose(
        weighted_scores(weights_near(shares, values), found),
        weighted_scores(weights_near(shares[:-1], values), whole),
        rtol=1e-12,
    )


@pytest.mark.parametrize("n_trials", [40, pytest.param(100, marks=pytest.mark.slow)])
def test_the_truth_is_rarely_refused_and_the_parameter_that_acts_is_told_and_not_the_idle_one(n_trials):
    generator = np.random.default_rng(4)
    held, told, wrong, widths = 0, 0, 0, []
    for trial in range(n_trials):
        truth = generator.uniform()
        acts, idle, tests = _campaign(generator, truth)
        answers = answer_hypotheses({"acts": (acts, tests), "idle": (idle, tests)}, trial)
        found = answers["acts"]
        held += found.lower <= truth <= found.upper
        told += found.constrained
        widths.append(found.upper - found.lower)
        wrong += answers["idle"].constrained
        if not answers["idle"].constrained:
            assert (answers["idle"].lower, answers["idle"].upper) == (0.0, 1.0)
    assert binomtest(held, n_trials, LEVEL, alternative="less").pvalue > 0.01
    assert binomtest(wrong, n_trials, 1.0 - LEVEL, alternative="greater").pvalue > 0.01
    assert told > 0.9 * n_trials
    assert np.median(widths) < 0.6


@pytest.mark.slow
def test_tests_that_do_not_depend_on_parameters_tell_of_none_of_them():
    """All questions together: a family of 95 % is wrong in one campaign of twenty."""
    generator = np.random.default_rng(5)
    wrong, n_trials = 0, 120
    for trial in range(n_trials):
        first, second, tests = _campaign(generator, 0.5, strength=0.0)
        questions = {"first": (first, tests), "second": (second, tests)}
        questions |= {("second", place): (second, [test]) for place, test in enumerate(tests)}
        wrong += any(one.constrained for one in answer_hypotheses(questions, trial).values())
    assert binomtest(wrong, n_trials, 1.0 - LEVEL, alternative="greater").pvalue > 0.01


def test_the_same_seed_gives_the_same_answer():
    acts, _, tests = _campaign(np.random.default_rng(7), 0.4)
    one, other = (answer_hypotheses({"acts": (acts, tests)}, 1)["acts"] for _ in range(2))
    assert_allclose(one.score, other.score, rtol=0.0, atol=0.0)
    assert (one.limit, one.chance) == (other.limit, other.chance)


@pytest.mark.parametrize(("off", "least", "most"), [(0.0, 0.1, 1.0), (20.0, 1 / 31, 1 / 31)])
def test_the_chance_of_a_test_falls_to_that_of_the_farthest(off, least, most):
    generator = np.random.default_rng(8)
    readings = generator.normal(size=(N_SAMPLES, N_TIMES))
    found = chance_of_test(distances(readings, generator.normal(size=N_TIMES) + off))
    assert least <= found <= most
