"""The base's motion in a test as the input of a simulation: what is known of it, and draws from that."""

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from blockshake.dynamics.motion import CHANNELS, PITCH, ground_motion
from blockshake.measurement.motion.base_motion import (
    SAME_TIME,
    BaseReadings,
    base_coordinates,
    first_variances,
    most_probable,
    most_probable_density,
    smooth_readings,
    together,
)
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.kalman import ACCELERATION, DISPLACEMENT, OFFSET, VELOCITY, walk_into
from blockshake.measurement.sensors.accelerometers import shaken_channels

_LARGEST_CLOCK_LAG = 0.05  # s, between the clocks of the two systems
_LAG_STEP = 0.005  # s, of the lags that are tried first
_LONG_NAMES = {
    "marker": "displacement of the slab's mass centre since the first reading, or its pitch, as the markers read it",
    "reading": "acceleration as the accelerometer reads it, gravity's part taken out",
    "displacement": "smoothed displacement or pitch",
    "velocity": "its rate",
    "displacement_error": "standard deviation of the smoothed displacement or pitch",
    "velocity_error": "standard deviation of its rate",
}


def measure_base(test, structure, sensors, command):
    """Motion of the driven body in a test, with all that its draws are made from.

    Parameters
    ----------
    test : xarray.Dataset
        A test whose times count from the start of the command, see `from_command`.
    structure : Structure
    sensors : Sensors
    command : GroundMotion
        Commanded motion of the table.

    Returns
    -------
    xarray.Dataset
        Along ``time``, that of the markers and of the accelerometer together, and ``channel`` (x, y, z, pitch_y; the
        mass centre's displacement since the first reading [m], and the pitch [rad]): the readings ``marker`` and
        ``reading``, and ``displacement``, ``velocity`` and their ``_error``, smoothed. By channel ``marker_noise``,
        ``reading_noise`` and ``jerk_density``. ``of_markers`` is 1 at the markers' times. Attributes: ``start`` of a
        simulation on the test's clock [s]: 0, that of the command, or that of the record where it starts later;
        ``follows`` as of the test; ``accelerometer_lag``, which the accelerometer's times were moved by [s]; ``end`` of
        the record [s]; ``unread``, the axes that no marker of the body measures.

    Notes
    -----
    Each coordinate is smoothed by itself, as by `smooth_readings`; the accelerometer is that along x, moved onto the
    markers' clock by the lag of the largest likelihood. A pitch that the markers do not tell is none. An axis that no
    marker measures has no reading and no error (NaN), and moves as commanded where the table follows the command, else
    not at all. The accelerometer's arm above the mass centre, and the correlation between coordinates, are left out.
    """
    test = without_outliers(test, structure)
    time = test["time"].to_numpy()
    values, noise = base_coordinates(test, structure, sensors)
    none = np.empty(0)
    parts = [
        together(time, column, sigma, none, none, 1.0) for column, sigma in zip(values.T, noise, strict=True)
    ]
    densities = [most_probable_density(part) if part.marker_noise > 0.0 else 0.0 for part in parts]
    lag = 0.0
    for channel in shaken_channels(test, structure)[:1]:
        time_acc, pitch = test["time_acc"].to_numpy(), np.zeros(len(time))
        if densities[PITCH]:
            pitch = smooth_readings(parts[PITCH], densities[PITCH]).mean[:, DISPLACEMENT]
        weight = -structure.file.gravity[2] * np.interp(time_acc, time, pitch)
        read = time, values[:, 0], noise[0]
        level = test["accelerometer"].sel(channel=channel).to_numpy() + weight, sensors.accelerometer_noise
        lag = _accelerometer_lag(read, time_acc, level, densities[0])
        parts[0] = together(*read, time_acc + lag, *level)
        densities[0] = most_probable_density(parts[0])
    base = _gathered(time, parts, densities)
    unread = [CHANNELS[axis] for axis in np.flatnonzero(np.isnan(values[:, :3]).all(axis=0))]
    base.attrs = {
        "Conventions": "CF-1.11",
        "title": "measured motion of the slab",
        "start": record_start(time),
        "end": float(time[-1]),
        "follows": test.attrs["follows"],
        "accelerometer_lag": float(lag),
        "unread": "".join(unread),
    }
    for axis in unread:
        _move_as_commanded(base, axis, command)
    return base


def record_start(time):
    """Time from which a test's record drives a simulation: the start of the command, or the first reading after it [s].

    ``time`` (n_times,): times of the markers, counted from the start of the command [s].
    """
    return max(float(time[0]), 0.0)


def _move_as_commanded(base, axis, command):
    """Give an axis that nothing measures the commanded motion, or rest, and errors that nobody knows."""
    at = {"channel": axis}
    for derivative, name in enumerate(("displacement", "velocity")):
        if base.attrs["follows"]:
            commanded = command.evaluate(base["time"].to_numpy(), derivative)
            commanded = commanded - command.evaluate(np.full(1, base.attrs["start"])) * (derivative == 0)
            base[name].loc[at] = commanded[:, CHANNELS.index(axis)]
        base[f"{name}_error"].loc[at] = np.nan


def draw_base(base, generator):
    """One motion that the readings allow: displacement at the markers' times, (n_times, 4) [m, rad].

    Parameters
    ----------
    base : xarray.Dataset
        From `measure_base`.
    generator : numpy.random.Generator
        Advanced.

    Notes
    -----
    Durbin and Koopman (2002), A simple and efficient simulation smoother, Biometrika 89: a motion is drawn from the
    process before any reading, read with noise at the same times and smoothed; its error is added to the smoothed
    readings, which has the covariance of the posterior over all times together.
    """
    there = base["of_markers"].to_numpy() == 1
    drawn = np.zeros((there.sum(), len(CHANNELS)))
    for index, readings in enumerate(_readings(base)):
        density = float(base["jerk_density"][index])
        coordinate = base.isel(channel=index)
        if density == 0.0:
            drawn[:, index] = coordinate["displacement"].to_numpy()[there]
            continue
        count = len(readings.time)
        states = np.empty((count, 4))
        states[0] = generator.normal(size=4) * np.sqrt(first_variances(readings.marker_noise))
        walk_into(readings.time, density, generator.normal(size=(count, 3)), states)
        marker = states[:, DISPLACEMENT] + readings.marker_noise * generator.normal(size=count)
        level = states[:, ACCELERATION] + states[:, OFFSET]
        level += readings.reading_noise * generator.normal(size=count)
        seen = readings._replace(
            marker=np.where(np.isfinite(readings.marker), marker, np.nan),
            reading=np.where(np.isfinite(readings.reading), level, np.nan),
        )
        error = (states - smooth_readings(seen, density).mean)[:, DISPLACEMENT]
        at = np.searchsorted(readings.time, base["time"].to_numpy()[there] - SAME_TIME)
        drawn[:, index] = coordinate["displacement"].to_numpy()[there] + error[at]
    return drawn


def base_as_motion(base, displacement, name, attributes):
    """`GroundMotion` from the base's ``displacement`` (n_times, 4) at the markers' times; time 0 is the start."""
    time = base["time"].to_numpy()[base["of_markers"].to_numpy() == 1] - base.attrs["start"]
    rows = np.concatenate([[0.0], time[time > SAME_TIME]])
    values = CubicSpline(time, displacement)(rows)
    columns = dict(zip(CHANNELS, (values - values[0]).T, strict=True))
    return ground_motion(name, rows, columns, "displacement", attributes)


def _accelerometer_lag(read, time_acc, level, density):
    """By how much the accelerometer's times are moved onto the markers' clock: the most probable lag [s]."""
    count = round(_LARGEST_CLOCK_LAG / _LAG_STEP)
    lags = _LAG_STEP * np.arange(-count, count + 1)

    def smoothed(lag):
        return smooth_readings(together(*read, time_acc + lag, *level), density)

    return most_probable(smoothed, lags, _LAG_STEP, 1e-5)


def _gathered(marker_time, parts, densities):
    """Readings and smoothed states of all coordinates at the times of any."""
    time = parts[0].time
    shape = len(time), len(parts)
    columns = {name: np.full(shape, np.nan) for name in _LONG_NAMES}
    for index, (part, density) in enumerate(zip(parts, densities, strict=True)):
        at = np.searchsorted(time, part.time - SAME_TIME)
        columns["marker"][at, index], columns["reading"][at, index] = part.marker, part.reading
        if density == 0.0:
            for name in ("displacement", "velocity", "displacement_error", "velocity_error"):
                columns[name][:, index] = 0.0
            continue
        mean, covariance, _ = smooth_readings(part, density)
        for state, name in ((DISPLACEMENT, "displacement"), (VELOCITY, "velocity")):
            columns[name][at, index] = mean[:, state]
            columns[f"{name}_error"][at, index] = np.sqrt(np.maximum(covariance[:, state, state], 0.0))
    of_markers = np.zeros(len(time), dtype=np.int8)
    of_markers[np.searchsorted(time, marker_time - SAME_TIME)] = 1
    return xr.Dataset(
        {name: (("time", "channel"), values, {"long_name": _LONG_NAMES[name]}) for name, values in columns.items()}
        | {
            "of_markers": ("time", of_markers),
            "marker_noise": ("channel", [part.marker_noise for part in parts]),
            "reading_noise": ("channel", [part.reading_noise for part in parts]),
            "jerk_density": ("channel", densities),
        },
        {"time": ("time", time, {"units": "s"}), "channel": list(CHANNELS)},
    )  # fmt: skip


def _readings(base):
    """`BaseReadings` of every coordinate, those of coordinates without accelerometer at the markers' times alone."""
    for index in range(base.sizes["channel"]):
        coordinate = base.isel(channel=index)
        kept = (coordinate["of_markers"].to_numpy() == 1) | np.isfinite(coordinate["reading"].to_numpy())
        yield BaseReadings(
            *(coordinate[name].to_numpy()[kept] for name in ("time", "marker")), float(coordinate["marker_noise"]),
            coordinate["reading"].to_numpy()[kept], float(coordinate["reading_noise"]),
        )  # fmt: skip
