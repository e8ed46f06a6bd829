"""Indices by a surrogate against closed forms: Ishigami, the g-function, a linear model with dependent inputs."""

import time

import numpy as np
import pytest

from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.sensitivity.indices import indices, shapley_effects


def evenly(count, size, low=0.0, high=1.0, seed=1):
    """Latin hypercube of even variables, float64 (size, count); any drawable names will do."""
    names = [
        f"bodies.b.{kind}.{axis}"
        for kind in ("position", "offset", "velocity", "mass_offset")
        for axis in "xyz"
    ]
    entry = {"distribution": "uniform", "loc": low, "scale": high - low}
    return draw_samples(size, seed, dict.fromkeys(names[:count], entry)).values.to_numpy()


def test_ishigami_within_its_errors():
    """Ishigami and Homma (1990), a = 7, b = 0.1: S = (0.314, 0.442, 0), S_T = (0.558, 0.442, 0.244)."""
    x = evenly(3, 300, -np.pi, np.pi)
    y = np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    found = indices(x, y, 1)
    assert min(found["left_out"], found["held_out"]) > 0.9
    np.testing.assert_allclose(found["first"], [0.3139, 0.4424, 0.0], atol=0.05)
    np.testing.assert_allclose(found["total"], [0.5576, 0.4424, 0.2437], atol=0.05)
    # of independent inputs half of an interaction of two goes to each
    np.testing.assert_allclose(found["shapley"], [0.4357, 0.4424, 0.1218], atol=0.05)
    assert found["shapley"].sum() == pytest.approx(1.0, abs=1e-9)


def test_g_function_within_its_errors():
    """Saltelli and Sobol (1995), a = (0, 1, 4.5, 9): V_j = 1 / (3 (1 + a_j)^2)."""
    a = np.array([0.0, 1.0, 4.5, 9.0])
    x = evenly(4, 300)
    y = np.prod((np.abs(4.0 * x - 2.0) + a) / (1.0 + a), axis=1)
    part = 1.0 / (3.0 * (1.0 + a) ** 2)
    whole = np.prod(1.0 + part) - 1.0
    total = part * np.prod(1.0 + part) / (1.0 + part) / whole
    found = indices(x, y, 1)
    assert min(found["left_out"], found["held_out"]) > 0.9
    np.testing.assert_allclose(found["first"], part / whole, atol=0.06)
    np.testing.assert_allclose(found["total"], total, atol=0.06)


def test_shapley_effects_of_a_dependent_linear_model_in_closed_form():
    """Owen and Prieur (2017), Eq. (10), of two inputs: (b1^2 (1 - r^2 / 2) + b1 b2 r + b2^2 r^2 / 2) / Var(Y)."""
    slopes, r = np.array([1.0, 2.0]), 0.7
    correlation = np.array([[1.0, r], [r, 1.0]])
    variance = slopes @ correlation @ slopes
    both = slopes[0] * slopes[1] * r
    expected = (slopes**2 * (1.0 - r**2 / 2.0) + both + slopes[::-1] ** 2 * r**2 / 2.0) / variance
    (found,), error = shapley_effects(lambda x: (x @ slopes)[None], correlation, np.random.default_rng(1))
    np.testing.assert_allclose(found, expected, atol=0.03)
    assert (np.abs(found - expected) < 3.0 * error).all()
    assert (error < 0.02).all()
    x = np.random.default_rng(2).standard_normal((200, 2)) @ np.linalg.cholesky(correlation).T
    by_runs = indices(x, x @ slopes, 1)
    np.testing.assert_allclose(by_runs["shapley"], expected, atol=0.06)
    assert np.isnan(by_runs["total"]).all()  # of dependent inputs they are no shares


def test_the_only_variable_that_matters_has_the_whole_variance_within_its_limits():
    """Truth 1 and 0: the limits count the error of the sampling, and no share is below 0 or above 1."""
    x = evenly(2, 60)
    for seed in range(8):
        found = indices(x, 3.0 * x[:, 0], seed)
        for name in ("shapley", "first", "total"):
            assert ((found[name] >= 0.0) & (found[name] <= 1.0)).all()
        low, high = found["shapley_interval"]
        assert high[0] == 1.0
        assert low[1] == 0.0


def test_a_bad_surrogate_tells_nothing():
    x = evenly(3, 60)
    y = np.random.default_rng(4).permutation(60) * 1.0
    found = indices(x, y, 1)
    assert min(found["left_out"], found["held_out"]) < 0.7
    assert np.isnan(found["shapley"]).all()
    assert np.isnan(indices(x, np.zeros(60), 1)["left_out"])


def test_twelve_inputs_of_two_hundred_runs_take_seconds():
    x = evenly(12, 200)
    y = x @ np.arange(12.0) + 3.0 * x[:, 0] * x[:, 11]
    begin = time.process_time()
    found = indices(x, y, 1)
    assert time.process_time() - begin < 20.0
    assert found["left_out"] > 0.95
    assert np.argmax(found["total"]) == 11
