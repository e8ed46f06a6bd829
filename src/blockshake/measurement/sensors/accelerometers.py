"""Readings of an accelerometer on a block: specific force along the block's own axes."""

from typing import NamedTuple

import numpy as np
import scipy
from scipy.interpolate import CubicSpline

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.sensors.markers import driven_names

RATE = 512.0  # Hz, of the readings
NOISE = 0.02  # m/s2, standard deviation of the readings where nothing else is stated
FINE_RATE = 4.0 * RATE  # Hz, of the states they are made from
CUTOFF = 50.0  # Hz, where each of the two passes is 3 dB down
ORDER = 4

SKIP = round(FINE_RATE / RATE)  # states from one reading to the next
_PAD = round(0.25 * FINE_RATE)  # a quarter second: the filter has forgotten its start after 0.1 s
LONGEST_GAP = 10  # readings; across more a spline no longer knows what the blocks did
EVEN = 0.01  # of the step, by which times may be uneven


def channel_carriers(structure):
    """Body and axis of every channel by its name ``NAME-axis``, in file order."""
    return {
        f"{sensor.name}-{axis}": (sensor.body, axis)
        for sensor in structure.file.accelerometers
        for axis in sensor.axes
    }


def accelerometer_channels(structure):
    """Channel names ``NAME-axis`` in file order."""
    return list(channel_carriers(structure))


def read_channels(test):
    """Names of the channels of which a test has any reading, list of str."""
    if "accelerometer" not in test:
        return []
    read = test["accelerometer"].notnull().any("time_acc")
    return list(map(str, test["channel"].values[read.to_numpy()]))


def shaken_channels(test, structure):
    """Channels of a test that read a driven body along x, in file order, list of str."""
    if "accelerometer" not in test:
        return []
    driven, read = driven_names(structure), set(test["channel"].values)
    carriers = channel_carriers(structure).items()
    return [name for name, (body, axis) in carriers if name in read and body in driven and axis == "x"]


def reading_times(time):
    """Times of the readings from those of the states at `FINE_RATE` [s]."""
    return time[0] + np.arange((len(time) - 1) // SKIP + 1) / RATE


def specific_forces(structure, orientation, velocity, angular_velocity):
    """Mean specific force of every channel between each two states at `FINE_RATE`, until the last whole one.

    Parameters
    ----------
    structure : Structure
    orientation : float64 array, shape (n_fine, n_bodies, 4)
        Unit quaternions (w, x, y, z), body to world, continuous in sign; NaN after an abort.
    velocity, angular_velocity : float64 arrays, shape (n_fine, n_bodies, 3)
        World frame [m/s, rad/s]; NaN after an abort.

    Returns
    -------
    float64 array, shape (n_intervals, n_channels)
        In the axes of the bodies in the middle of the interval [m/s2].

    Notes
    -----
    The velocity of the sensor's point, differenced over a fine interval, is the mean acceleration in it exactly,
    whatever impacts it holds: an impact enters with its whole change of velocity. That mean belongs to the middle of
    the interval and is turned into the body's axes by the orientation there.
    """
    sensors = structure.file.accelerometers
    if not sensors:
        return np.empty((max(len(orientation) - 1, 0), 0))
    bodies = structure.carriers(sensors)
    whole = _whole_states(orientation[:, bodies], velocity[:, bodies], angular_velocity[:, bodies])
    force = _specific_force(
        structure.arms(sensors),
        np.array(structure.file.gravity),
        orientation[:whole, bodies],
        velocity[:whole, bodies],
        angular_velocity[:whole, bodies],
    )
    return np.column_stack(
        [force[:, sensor, "xyz".index(axis)] for sensor, item in enumerate(sensors) for axis in item.axes]
    )


def readings_of(forces, times):
    """Readings of channels at `reading_times` from their `specific_forces` of a whole run.

    Parameters
    ----------
    forces : float64 array, shape (n_intervals, n_channels)
        [m/s2]
    times : float64 array, shape (n_readings,)
        [s]

    Returns
    -------
    float64 array, shape (n_readings, n_channels)
        Specific force [m/s2]: a block at rest reads +9.81 along an upward axis, a falling one 0. NaN after the last
        whole state.

    Notes
    -----
    Four neighbours give the value at the state between them (third order), the low-pass (a 4th-order Butterworth at 50
    Hz, forwards and backwards, so without lag) runs at 2048 Hz, and every fourth value is a reading. Beyond the ends
    the record continues as its point reflection for a quarter second; a record cut by an abort ends where the states
    do.
    """
    readings = np.full((len(times), forces.shape[1]), np.nan)
    if len(forces):
        smooth = low_pass(_at_states(forces))[::SKIP]
        readings[: len(smooth)] = smooth
    return readings


def low_pass(values):
    """The 50 Hz low-pass of finite values (n_fine, n_channels) at `FINE_RATE`, along the first axis, without lag."""
    sections = scipy.signal.butter(ORDER, CUTOFF, fs=FINE_RATE, output="sos")
    return scipy.signal.sosfiltfilt(sections, values, axis=0, padlen=min(_PAD, len(values) - 1))


def _whole_states(*arrays):
    """Number of leading times at which everything is finite."""
    finite = np.logical_and.reduce([np.isfinite(array).all(axis=(1, 2)) for array in arrays])
    return len(finite) if finite.all() else int(np.argmin(finite))


def _specific_force(arms, gravity, orientation, velocity, angular_velocity):
    """Specific force in the body's axes in the middle of every interval, (n_fine - 1, n_sensors, 3)."""
    arm = np.einsum("tsij,sj->tsi", rotation_matrices(orientation), arms)
    point_velocity = velocity + np.cross(angular_velocity, arm)
    acceleration = np.diff(point_velocity, axis=0) * FINE_RATE
    # the normalised mean of two near quaternions is the rotation half-way between them
    middle = orientation[1:] + orientation[:-1]
    middle /= np.linalg.norm(middle, axis=-1, keepdims=True)
    return np.einsum("tsji,tsj->tsi", rotation_matrices(middle), acceleration - gravity)


def _at_states(middles):
    """Values at the states from values in the middle of the intervals, one more row."""
    padded = np.pad(middles, ((2, 2), (0, 0)), mode="edge")
    # in place: an hour of one channel is 56 MiB
    values = padded[1:-2] + padded[2:-1]
    values *= 9.0
    values -= padded[:-3]
    values -= padded[3:]
    values /= 16.0
    return values


class WholeChannels(NamedTuple):
    """Readings of channels, ``names``, at even times: float64 (n_times,) [s] and (n_times, n_channels) without gaps."""

    time: np.ndarray
    values: np.ndarray
    names: list


def whole_channels(test, structure):
    """`WholeChannels` of the accelerometers on blocks; None where no channel is whole.

    The test is as in a campaign's file. Short gaps are bridged by a cubic spline. Channels with a gap of more than ten
    readings are left out. Times after the last reading of all channels, as after an abort, are cut off.
    """
    if "accelerometer" not in test:
        return None
    readings = test["accelerometer"].transpose("time_acc", "channel")
    read = np.flatnonzero(readings.notnull().any("channel"))
    if not len(read):
        return None
    readings = readings[read[0] : read[-1] + 1]
    carriers, driven = channel_carriers(structure), driven_names(structure)
    names = [
        name
        for name in map(str, readings["channel"].values)
        if name in carriers
        and carriers[name][0] not in driven
        and _longest_gap(readings.sel(channel=name).to_numpy()) <= LONGEST_GAP
    ]
    if not names:
        return None
    time, values = readings["time_acc"].to_numpy(), readings.sel(channel=names).to_numpy()
    steps = np.diff(time)
    even = np.linspace(time[0], time[-1], len(time))
    uneven = np.ptp(steps) > EVEN * np.median(steps)
    for column in range(len(names)):
        known = np.isfinite(values[:, column])
        if uneven or not known.all():
            values[:, column] = CubicSpline(time[known], values[known, column])(even)
    return WholeChannels(even, values, names)


def _longest_gap(values):
    """Largest number of missing readings in a row; more than any length where an end is missing."""
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < 4 or known[0] > 0 or known[-1] < len(values) - 1:
        return len(values)
    return int(np.diff(known).max()) - 1
