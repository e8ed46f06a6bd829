"""Sensor noise of a case: coloured, with gaps and outliers, and not quite as the campaign states it."""

import numpy as np
from scipy.signal import lfilter

MARKER_NOISE, ACCELEROMETER_NOISE = 1e-4, 0.02  # m and m/s2, as the campaign states them
_GAPS, _GAP = 0.01, 10  # share of a marker's readings that are lost, and how many at a time in the mean
_OUTLIERS, _OUTLIER = 0.01, 10.0  # share of the readings, and their size in standard deviations
_OFFSET = 0.02  # m/s2, of an accelerometer channel
_STREAM = 5


def true_noise(seed):
    """Standard deviations over those stated, and memory of the noise from reading to reading."""
    generator = np.random.default_rng([seed, _STREAM])
    return {
        "marker": float(generator.uniform(0.9, 1.2)),
        "accelerometer": float(generator.uniform(0.9, 1.2)),
        "memory": float(generator.uniform(0.3, 0.6)),
    }


def add_noise(test, noise, seed, number):
    """Readings with noise, from exact ones.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    noise : dict
        From `true_noise`.
    seed, number : int
        The case and of the test.
    """
    generator = np.random.default_rng([seed, _STREAM, number])
    exact = test["marker_displacement"].to_numpy()
    sigma = MARKER_NOISE * noise["marker"]
    read = exact + sigma * _coloured(generator, exact.shape, noise["memory"])
    far = generator.random(exact.shape[:2]) < _OUTLIERS
    far[0] = False
    read += far[..., None] * generator.normal(0.0, _OUTLIER * sigma, exact.shape)
    first = test["marker_initial_position"].to_numpy() + read[0]
    read -= read[:1]
    read[_gaps(generator, exact.shape[:2])] = np.nan
    test["marker_displacement"].values[:] = read
    test["marker_initial_position"].values[:] = first
    channels = test["accelerometer"].values
    channels += generator.normal(0.0, _OFFSET, channels.shape[1])
    channels += (
        ACCELEROMETER_NOISE * noise["accelerometer"] * _coloured(generator, channels.shape, noise["memory"])
    )
    return test


def _coloured(generator, shape, memory):
    """First-order noise of unit variance along the first axis."""
    white = generator.normal(0.0, 1.0, shape)
    white[0] /= np.sqrt(1.0 - memory**2)
    return lfilter([np.sqrt(1.0 - memory**2)], [1.0, -memory], white, axis=0)


def _gaps(generator, shape):
    """Readings lost in bursts of geometric length, never the first."""
    starts = generator.random(shape) < _GAPS / _GAP
    length = generator.geometric(1.0 / _GAP, shape)
    lost = np.zeros(shape, dtype=bool)
    for row, marker in np.argwhere(starts):
        lost[max(row, 1) : row + length[row, marker], marker] = True
    return lost
