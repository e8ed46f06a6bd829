"""Accelerometer channels of blocks, even in time and without gaps, as a spectrum needs them."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

LONGEST_GAP = 10  # readings; across more a spline no longer knows what the blocks did
EVEN = 0.01  # of the step, by which times may be uneven


class WholeChannels(NamedTuple):
    """Readings of channels.

    Attributes
    ----------
    time : float64 array, shape (n_times,)
        Even [s].
    values : float64 array, shape (n_times, n_channels)
        No gaps [m/s2].
    names : list of str, length n_channels
    """

    time: np.ndarray
    values: np.ndarray
    names: list


def whole_channels(test, structure):
    """`WholeChannels` of the accelerometers on blocks; None where no channel is whole.

    Short gaps are bridged by a cubic spline. Channels with a gap of more than ten readings are left out, and what
    follows the last reading of all channels, as the end of a run after an abort, is cut off.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    structure : Structure
        Whose accelerometers they are.
    """
    if "accelerometer" not in test:
        return None
    driven = {body.name for body in structure.file.bodies if body.driven}
    on_blocks = {
        f"{sensor.name}-{axis}"
        for sensor in structure.file.accelerometers
        if sensor.body not in driven
        for axis in sensor.axes
    }
    readings = test["accelerometer"].transpose("time_acc", "channel")
    read = np.flatnonzero(readings.notnull().any("channel"))
    if not len(read):
        return None
    readings = readings[read[0] : read[-1] + 1]
    names = [str(name) for name in readings["channel"].values]
    names = [
        name
        for name in names
        if name in on_blocks and _longest_gap(readings.sel(channel=name).to_numpy()) <= LONGEST_GAP
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
