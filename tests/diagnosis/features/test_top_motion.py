import numpy as np
import pytest

from blockshake.diagnosis.features.feature_table import BANDS
from blockshake.diagnosis.features.top_motion import band_levels, delay

TIME = np.arange(2001) / 200.0


def test_a_sine_is_in_its_band_with_half_its_square():
    size, noise = 0.01, 1e-4
    levels = band_levels(TIME, size * np.sin(2.0 * np.pi * 3.0 * TIME), noise, BANDS)
    # 2 Hz wide, 200 readings a second; the window's sides leak less than 1e-3 at ten lines' distance
    of_noise = 2.0 * noise**2 * 2.0 / 200.0
    assert levels[2] == pytest.approx(np.log1p(0.5 * size**2 / of_noise), abs=2e-3)
    assert levels[[0, 4]].max() < 0.1


def test_noise_alone_has_one_share():
    values = np.random.default_rng(1).normal(0.0, 1e-4, (200, len(TIME)))
    levels = np.mean([np.expm1(band_levels(TIME, one, 1e-4, BANDS)) for one in values], axis=0)
    # 7 to 80 lines a band, Hann's window makes 1.5 of them one: standard error at most sqrt(1.5 / 7 / 200)
    np.testing.assert_allclose(levels, 1.0, atol=4.0 * 0.033)


@pytest.mark.parametrize("lag", [0.0, 0.03, -0.0521])
def test_a_known_delay(lag):
    first = np.exp(-((TIME - 5.0) ** 2)) * np.sin(2.0 * np.pi * 1.3 * TIME)
    second = np.exp(-((TIME - lag - 5.0) ** 2)) * np.sin(2.0 * np.pi * 1.3 * (TIME - lag))
    found, correlation = delay(TIME, first, -2.0 * -second)
    # the parabola's error is of fourth order in 2 pi 1.3 0.005 = 0.04
    assert found == pytest.approx(lag, abs=1e-5)
    assert correlation == pytest.approx(1.0, abs=1e-4)
