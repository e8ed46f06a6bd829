"""The base's motion as its sensors read it, each coordinate smoothed over both systems, with its uncertainty.

The base starts at rest and its acceleration is driven by white jerk, whose density is that of the largest likelihood.
The first reading's own error is in all displacements: the error is a constant and no part of the velocity.
"""

from typing import NamedTuple

import numpy as np
import scipy

from blockshake.measurement.motion.body_poses import TRANSLATION, body_poses, driven_body
from blockshake.measurement.motion.kalman import N_STATES, smooth

_OFFSET_SPREAD = 1.0  # m/s2, of an accelerometer's constant offset before anything is read
_ACCELERATION_SPREAD = 1e-2  # m/s2, of a table at rest
# decimal logarithms of the jerk's density that are tried first; the lowest is a rest [m2/s5]
_DENSITIES = np.arange(-14.0, 8.1, 2.0)
SAME_TIME = 1e-7  # s


class BaseReadings(NamedTuple):
    """Readings by both systems of one coordinate of the base, at all times of either; NaN where one read nothing.

    ``time``, ``marker``, ``reading``: float64 (n_times,), displacement since the first reading and acceleration with a
    constant offset [s, m, m/s2]; ``marker_noise``, ``reading_noise``: standard deviations [m, m/s2]. A rotation is
    read alike, in rad for m.
    """

    time: np.ndarray
    marker: np.ndarray
    marker_noise: float
    reading: np.ndarray
    reading_noise: float


class Smoothed(NamedTuple):
    """States of all times, float64 (n_times, N_STATES), their covariances, and the log-likelihood of the readings."""

    mean: np.ndarray
    covariance: np.ndarray
    likelihood: float


def first_variances(marker_noise):
    """Variances of the state before the first reading, whose own error is in all displacements, (N_STATES,)."""
    return np.array([marker_noise**2, 1e-12, _ACCELERATION_SPREAD**2, _OFFSET_SPREAD**2])


def smooth_readings(readings, density):
    """`Smoothed` of `BaseReadings` for a density of the white jerk [m2/s5]; the base starts at rest."""
    n_times = len(readings.time)
    mean, covariance = np.empty((n_times, N_STATES)), np.empty((n_times, N_STATES, N_STATES))
    mean[0], covariance[0] = 0.0, np.diag(first_variances(readings.marker_noise))
    likelihood = smooth(
        readings.time, readings.marker, readings.marker_noise**2, readings.reading, readings.reading_noise**2,
        density, mean, covariance,
    )  # fmt: skip
    return Smoothed(mean, covariance, likelihood)


def most_probable_density(readings):
    """Density of the white jerk at which `BaseReadings` are most probable [m2/s5].

    A weak pitch has a second, lower summit at rest.
    """
    return 10.0 ** most_probable(
        lambda exponent: smooth_readings(readings, 10.0**exponent), _DENSITIES, 2.0, 0.05
    )


def most_probable(smoothed, tried, step, tolerance):
    """Value at which a function gives the most probable `Smoothed`: the best of those tried, closer within a step of
    it."""

    def unlikely(value):
        return -smoothed(value).likelihood

    best = tried[int(np.argmin([unlikely(value) for value in tried]))]
    bounds = best - step, best + step
    return scipy.optimize.minimize_scalar(unlikely, bounds=bounds, options={"xatol": tolerance}).x


def together(time, marker, marker_noise, time_acc, accelerometer, accelerometer_noise):
    """`BaseReadings` of both systems, each with its own times; empty arrays where there is no accelerometer."""
    every = np.unique(np.concatenate([time, time_acc]))
    every = every[np.concatenate([[True], np.diff(every) > SAME_TIME])]
    read = []
    for times, values in ((time, marker), (time_acc, accelerometer)):
        row = np.full(len(every), np.nan)
        row[np.searchsorted(every, times - SAME_TIME)] = values
        read.append(row)
    return BaseReadings(every, read[0], marker_noise, read[1], accelerometer_noise)


def base_coordinates(test, structure, sensors):
    """Displacement of the driven body's mass centre and its pitch, since the first reading.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    structure : Structure
    sensors : Sensors

    Returns
    -------
    values : float64 array, shape (n_times, 4)
        x, y, z [m] and pitch [rad]; NaN is a gap, or a direction that is not measured; a pitch that the markers do
        not tell is 0.
    noise : float64 array, shape (4,)
        Standard deviations [m, rad]; 0 of a coordinate that is not read.
    """
    poses = body_poses(test, structure, sensors.marker_noise, selected=structure.driven)
    body = driven_body(structure, poses)
    turn = poses.rotation[:, body]
    first = int(np.flatnonzero(np.isfinite(poses.position[:, body, 0]))[0])
    against = turn @ turn[first].T
    pitch = 0.5 * (against[:, 0, 2] - against[:, 2, 0])
    moved = poses.position[:, body] - poses.position[first, body]
    noise = np.sqrt(np.diag(poses.covariance[body])[[0, 1, 2, 4]])
    if poses.known[body] == TRANSLATION:
        pitch, noise[3] = np.zeros(len(pitch)), 0.0
    unread = ~poses.axes_read[body]
    moved[:, unread], noise[:3][unread] = np.nan, 0.0
    return np.column_stack([moved, pitch]), noise
