import numpy as np
import pytest
from scipy.stats import kstest

from blockshake.diagnosis.inference.constancy import constancy

SIZES = np.linspace(-6.0, 6.0, 1201)


def _densities(estimates, errors):
    return np.array([-0.5 * ((SIZES - x) / e) ** 2 for x, e in zip(estimates, errors, strict=True)])


def test_it_is_cochrans_q_of_gaussian_likelihoods():
    estimates, errors = np.array([0.3, 1.1, -0.4]), np.array([0.5, 0.4, 0.8])
    weights = errors**-2
    q = (weights * (estimates - (weights * estimates).sum() / weights.sum()) ** 2).sum()
    # chi-square with two degrees of freedom
    assert constancy(_densities(estimates, errors)) == pytest.approx(np.exp(-0.5 * q), rel=1e-3)


def test_one_size_gives_uniform_chances_and_two_sizes_small_ones():
    generator = np.random.default_rng(0)
    errors = np.array([0.3, 0.5, 0.2])
    same = [constancy(_densities(generator.normal(1.0, errors), errors)) for _ in range(300)]
    assert kstest(same, "uniform").pvalue > 0.01
    assert constancy(_densities([1.0, 1.0, -1.0], errors)) < 1e-6


def test_a_test_that_tells_nothing_and_a_single_one_say_nothing():
    known = _densities([0.5, 0.6], [0.2, 0.2])
    flat = np.vstack([known, np.zeros(len(SIZES))])
    assert constancy(known[:1]) == 1.0
    # one degree of freedom more for nothing: the chance can only grow
    assert constancy(flat) >= constancy(known)
