import numpy as np
import pytest
from scipy.stats import norm

from blockshake.diagnosis.inference.posterior import parameter_estimates, size_interval
from blockshake.effects.registry import EFFECTS

SIZES = np.linspace(-3.0, 3.0, 601)
WEIGHTS = norm.pdf(SIZES, 0.5, 0.4) / norm.pdf(SIZES, 0.5, 0.4).sum()


def test_interval_of_a_gaussian():
    estimate, lower, upper = size_interval(SIZES, WEIGHTS, 0.9)
    assert (estimate, lower, upper) == pytest.approx((0.5, 0.5 - 1.645 * 0.4, 0.5 + 1.645 * 0.4), abs=0.01)


def test_all_of_the_posterior_is_its_whole_width():
    _, lower, upper = size_interval(SIZES, WEIGHTS, 1.0)
    assert lower < -0.5
    assert upper > 1.5


def test_the_size_is_in_the_parameters_unit_and_others_keep_their_prior():
    found = parameter_estimates("stopper-contact", SIZES, WEIGHTS)
    size, *others = EFFECTS["stopper-contact"].parameters
    assert found[size.name].estimate == pytest.approx(0.5 * size.visible, rel=0.03)
    assert found[size.name].unit == size.unit
    assert found[size.name].informed
    for item in others:
        assert not found[item.name].informed
        assert item.lower < found[item.name].lower < found[item.name].upper < item.upper


@pytest.mark.parametrize("centre", [-0.4, 0.0, 0.07])
def test_a_coarse_grid_shifts_no_estimate(centre):
    sizes = np.linspace(-2.0, 2.0, 21)
    weights = np.exp(-0.5 * ((sizes - centre) / 0.5) ** 2)
    estimate, lower, upper = size_interval(sizes, weights / weights.sum(), 0.9)
    assert estimate == pytest.approx(centre, abs=0.01)
    assert 0.5 * (lower + upper) == pytest.approx(centre, abs=0.01)
    assert upper - lower == pytest.approx(2.0 * 1.645 * 0.5, rel=0.05)
