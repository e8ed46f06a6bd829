import numpy as np
import pytest
from scipy.stats import norm

from blockshake.diagnosis.posterior import parameter_estimates, size_interval
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
    assert found[size.name]["estimate"] == pytest.approx(0.5 * size.visible, rel=0.03)
    assert found[size.name]["unit"] == size.unit
    assert found[size.name]["informed"]
    for item in others:
        assert not found[item.name]["informed"]
        assert item.lower < found[item.name]["lower"] < found[item.name]["upper"] < item.upper
