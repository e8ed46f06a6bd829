"""Noise of the sensors in the rows: how it goes on from instant to instant, and how large it is."""

import numpy as np
import pytest

from blockshake.forces.kernel_noise import Colour
from blockshake.forces.local_fit import fit_locally

_WIDTH, _STEP, _LAGS = 0.015, 0.0005, np.array([0.0, 0.01, 0.02, 0.05])


@pytest.mark.parametrize("memory", [0.0, 0.005, 0.03, 0.1, 0.3])
@pytest.mark.parametrize("degree", [0, 2])
def test_smoothed_noise_goes_on_as_its_colour_says(degree, memory):
    """Against the sums over the weights that the fit gives every reading."""
    reach = np.arange(-250, 251)
    noise = np.exp(-_STEP * np.abs(reach[:, None] - reach) / memory) if memory else np.eye(len(reach))
    # the second derivatives of readings that are 1 at one time are the weights
    weights = [
        fit_locally(_STEP * reach, np.eye(len(reach)), np.array([lag]), _WIDTH, degree)[0][degree, 0]
        for lag in _LAGS
    ]
    found = np.array([weights[0] @ noise @ row for row in weights])
    colour = Colour(degree == 2, memory)
    np.testing.assert_allclose(colour.correlation(_LAGS, _WIDTH), found / found[0], atol=0.01)
    if memory:
        assert colour.variance(_WIDTH) == pytest.approx(found[0], rel=0.03)


def test_noise_of_the_shortest_memory_is_white_noise():
    for twice in (False, True):
        white, short = (Colour(twice, memory).correlation(_LAGS, _WIDTH) for memory in (0.0, 1e-3))
        np.testing.assert_allclose(short, white, atol=0.02)


def test_no_power_overflows_however_far_instants_are_apart():
    for twice in (False, True):
        assert Colour(twice, 0.005).correlation(np.array([20.0]), _WIDTH) == pytest.approx(0.0, abs=1e-12)
