"""The base's motion from what was measured of it: differentiated as in the paper, or smoothed, with its uncertainty."""

from dataclasses import dataclass

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
    every, of_marker, of_reading = _together(time, marker, np.asarray(time_acc), np.asarray(accelerometer))
    mean, covariance = np.empty((len(every), N_STATES)), np.empty((len(every), N_STATES, N_STATES))

    def run(exponent):
        mean[0] = 0.0
        covariance[0] = np.diag([marker_noise**2, 1e-12, _ACCELERATION_SPREAD**2, _OFFSET_SPREAD**2])
        return -smooth(
            every, of_marker, marker_noise**2, of_reading, accelerometer_noise**2, 10.0**exponent, mean, covariance
        )  # fmt: skip

    best = minimize_scalar(run, bounds=_DENSITIES, method="bounded", options={"xatol": 0.05})
    run(best.x)
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


def _together(time, marker, time_acc, accelerometer):
    """All times of both systems, and what each read then; NaN where it read nothing."""
    every = np.unique(np.concatenate([time, time_acc]))
    every = every[np.concatenate([[True], np.diff(every) > _SAME_TIME])]
    read = []
    for own, values in ((time, marker), (time_acc, accelerometer)):
        row = np.full(len(every), np.nan)
        row[np.searchsorted(every, own - _SAME_TIME)] = values
        read.append(row)
    return every, *read
