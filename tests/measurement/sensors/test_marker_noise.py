"""Noise of marker readings: its deviation, its independence, its reference."""

import numpy as np

from blockshake.measurement.sensors.markers import noisy_reading

NOISE = 1e-4  # m


def _displacement(n_times=4000):
    displacement = np.zeros((n_times, 2, 3))
    displacement[:, 1, 0] = 0.05 * np.sin(np.arange(n_times) / 200.0)
    return displacement


def _read(displacement, noise=NOISE):
    return noisy_reading(displacement, noise, np.random.default_rng(3))


def test_noise_has_the_deviation_asked_for_in_every_reading():
    error = _read(_displacement()) - _displacement()
    np.testing.assert_array_equal(error[0], 0.0)
    # 4 standard errors of a deviation from 4000 readings: NOISE / sqrt(8000)
    np.testing.assert_allclose(error[1:].std(axis=0), NOISE, atol=4 * NOISE / np.sqrt(8000))
    # white: neighbours do not correlate, within 4 standard errors
    centred = error[1:] - error[1:].mean(axis=0)
    neighbours = (centred[1:] * centred[:-1]).mean(axis=0) / centred.var(axis=0)
    assert np.abs(neighbours).max() < 4 / np.sqrt(4000)


def test_a_run_cut_short_stays_cut_short():
    cut = _displacement()
    cut[3000:] = np.nan
    read = _read(cut)
    assert np.isnan(read[3000:]).all()
    assert np.isfinite(read[:3000]).all()


def test_no_noise_gives_the_displacement():
    np.testing.assert_array_equal(_read(_displacement(), 0.0), _displacement())
