"""The base's motion from what was measured of it: differentiated as in the paper, or smoothed, with its uncertainty."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from blockshake.errors import InputError
from blockshake.measurement.motion.kalman import (
    ACCELERATION,
    DISPLACEMENT,
    N_STATES,
    OFFSET,
    VELOCITY,
    smooth,
)

_OFFSET_SPREAD = 1.0  # m/s2, of an accelerometer's constant offset before anything is read
_ACCELERATION_SPREAD = 1e-2  # m/s2, of a table at rest
_DENSITIES = (-4.0, 8.0)  # decimal logarithms of the jerk's density that are searched [m2/s5]
_SAME_TIME = 1e-7  # s


@dataclass(frozen=True)
class BaseMotion:
    """Motion of the base along one axis.

    Attributes
    ----------
    time : float64 array, shape (n_times,)
        Of the marker [s].
    displacement, velocity, acceleration : float64 arrays, shape (n_times,)
        [m, m/s, m/s2]
    displacement_error, velocity_error : float64 arrays, shape (n_times,)
        Standard deviations [m, m/s]; NaN for differentiation, which has none.
    accelerometer_offset : float
        Estimated [m/s2]; NaN without an accelerometer.
    """

    time: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    displacement_error: np.ndarray
    velocity_error: np.ndarray
    accelerometer_offset: float


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


def likeliest_density(readings, decades=_DENSITIES):
    """Density of the white jerk at which `BaseReadings` are likeliest, between two powers of ten [m2/s5]."""
    best = minimize_scalar(
        lambda exponent: -smooth_readings(readings, 10.0**exponent).likelihood,
        bounds=decades, method="bounded", options={"xatol": 0.05},
    )  # fmt: skip
    return 10.0**best.x


def smoothed_base(time, marker, marker_noise, time_acc=None, accelerometer=None, accelerometer_noise=None):
    """Motion smoothed over all readings of a marker and, where there is one, an accelerometer.

    Parameters
    ----------
    time, marker : float64 arrays, shape (n_times,)
        Displacement since the first reading; NaN is a gap [s, m].
    marker_noise : float
        Standard deviation of a marker's position [m].
    time_acc, accelerometer : float64 arrays, shape (n_readings,), optional
        Acceleration along the same axis, with a constant offset; NaN is a gap [s, m/s2].
    accelerometer_noise : float, optional
        Standard deviation of a reading [m/s2].

    Returns
    -------
    BaseMotion
        At the marker's times, gaps filled.

    Raises
    ------
    InputError
        Times that do not increase, fewer than four marker readings, or noise that is not positive.

    Notes
    -----
    The base starts at rest and its acceleration is driven by white jerk, whose density is the one of the largest
    likelihood. The first reading's own error is in all displacements: it is a constant and no part of the velocity.
    """
    time, marker = np.asarray(time, dtype=float), np.asarray(marker, dtype=float)
    _check(time, marker, marker_noise)
    if accelerometer is None:
        time_acc, accelerometer, accelerometer_noise = np.empty(0), np.empty(0), 1.0
    elif not (accelerometer_noise and accelerometer_noise > 0.0):
        raise InputError("base motion", "accelerometer_noise", "expected a positive number")
    readings = together(
        time, marker, marker_noise, np.asarray(time_acc), np.asarray(accelerometer), accelerometer_noise
    )
    every = readings.time
    mean, covariance, _ = smooth_readings(readings, likeliest_density(readings))
    there = np.searchsorted(every, time - _SAME_TIME)
    errors = np.sqrt(np.maximum(np.diagonal(covariance[there], axis1=1, axis2=2), 0.0))
    return BaseMotion(
        time=time,
        displacement=mean[there, DISPLACEMENT],
        velocity=mean[there, VELOCITY],
        acceleration=mean[there, ACCELERATION],
        displacement_error=errors[:, DISPLACEMENT],
        velocity_error=errors[:, VELOCITY],
        accelerometer_offset=float(mean[-1, OFFSET]) if len(time_acc) else np.nan,
    )


def _check(time, marker, marker_noise):
    if len(time) != len(marker) or np.isfinite(marker).sum() < 4:
        raise InputError("base motion", "marker", "expected at least four readings of the base's marker")
    if not (np.diff(time) > 0.0).all():
        raise InputError("base motion", "time", "expected times that increase")
    if not marker_noise > 0.0:
        raise InputError("base motion", "marker_noise", f"expected a positive number, not {marker_noise}")


def together(time, marker, marker_noise, time_acc, accelerometer, accelerometer_noise):
    """`BaseReadings` of both systems, each with its own times; empty arrays where there is no accelerometer."""
    every = np.unique(np.concatenate([time, time_acc]))
    every = every[np.concatenate([[True], np.diff(every) > _SAME_TIME])]
    read = []
    for own, values in ((time, marker), (time_acc, accelerometer)):
        row = np.full(len(every), np.nan)
        row[np.searchsorted(every, own - _SAME_TIME)] = values
        read.append(row)
    return BaseReadings(every, read[0], marker_noise, read[1], accelerometer_noise)
