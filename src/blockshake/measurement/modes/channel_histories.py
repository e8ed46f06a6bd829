"""Histories of a test's channels, even in time and without gaps, and which channels could not be so."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from blockshake.errors import InputError
from blockshake.geometry.schema import AXES
from blockshake.measurement.sensors.markers import directions_read, marker_bodies

LONGEST_GAP = 10  # readings; across more a spline no longer knows what the blocks did
_EVEN = 0.01  # of the step, by which times may be uneven


@dataclass(frozen=True)
class Histories:
    """Channels of one instrument.

    Attributes
    ----------
    time : float64 array, shape (n_times,)
        Even [s].
    values : float64 array, shape (n_times, n_channels)
        No gaps.
    names : list of tuple (name, axis), length n_channels
        Marker or accelerometer, and its axis.
    driven : bool array, shape (n_channels,)
        On the driven body.
    left_out : list of str
        ``NAME.axis`` of channels with too long a gap.
    """

    time: np.ndarray
    values: np.ndarray
    names: list
    driven: np.ndarray
    left_out: list

    def base(self, axis):
        """Mean of the driven body's channels along the axis, and their number; (None, 0) without any."""
        own = [place for place, name in enumerate(self.names) if self.driven[place] and name[1] == axis]
        return (self.values[:, own].mean(axis=1), len(own)) if own else (None, 0)


def marker_histories(test, structure):
    """Displacement of every marker along every axis [m]; raises `InputError` where no channel is whole."""
    displacement = test["marker_displacement"].transpose("time", "marker", "axis")
    markers = [str(name) for name in displacement["marker"].values]
    bodies = marker_bodies(structure, markers)
    names = [(marker, axis) for marker in markers for axis in AXES]
    values = displacement.sel(axis=list(AXES)).to_numpy().astype(float)
    read = directions_read(values).ravel()  # a direction that is not measured is no channel
    names = [name for name, kept in zip(names, read, strict=True) if kept]
    driven = np.repeat(_driven(structure, bodies), 3)[read]
    return _whole(test["time"].to_numpy(), values.reshape(len(values), -1)[:, read], names, driven, "marker")


def accelerometer_histories(test, structure):
    """Readings of every accelerometer channel [m/s2]; None where the test has none."""
    if "accelerometer" not in test or not test.sizes["channel"]:
        return None
    names = [tuple(str(name).rsplit("-", 1)) for name in test["channel"].values]
    bodies = {sensor.name: sensor.body for sensor in structure.file.accelerometers}
    for name, _ in names:
        if name not in bodies:
            raise InputError(
                "accelerometer", name, f"expected channels of {', '.join(bodies) or 'no sensor'}"
            )
    values = test["accelerometer"].transpose("time_acc", "channel").to_numpy().astype(float)
    driven = _driven(structure, [bodies[name] for name, _ in names])
    return _whole(test["time_acc"].to_numpy(), values, names, driven, "accelerometer")


def _driven(structure, bodies):
    driven = {body.name for body in structure.file.bodies if body.driven}
    return np.array([body in driven for body in bodies])


def _whole(time, values, names, driven, what):
    """Short gaps by a cubic spline; a run's end after an abort cut off; channels with longer gaps left out."""
    read = np.flatnonzero(np.isfinite(values).any(axis=1))
    if not len(read):
        raise InputError("dynamic properties", what, "expected readings; all are missing")
    part = slice(read[0], read[-1] + 1)
    time, values = np.asarray(time, dtype=float)[part], values[part]
    kept = [place for place in range(values.shape[1]) if _longest_gap(values[:, place]) <= LONGEST_GAP]
    if not kept:
        raise InputError(
            "dynamic properties", what, f"expected a channel without gaps above {LONGEST_GAP} readings"
        )
    steps = np.diff(time)
    even = np.linspace(time[0], time[-1], len(time))
    uneven = len(time) > 1 and np.ptp(steps) > _EVEN * np.median(steps)
    filled = np.empty((len(time), len(kept)))
    for column, place in enumerate(kept):
        known = np.isfinite(values[:, place])
        if known.all() and not uneven:
            filled[:, column] = values[:, place]
        else:
            filled[:, column] = CubicSpline(time[known], values[known, place])(even)
    left_out = [".".join(names[place]) for place in range(len(names)) if place not in kept]
    return Histories(even, filled, [names[place] for place in kept], driven[kept], left_out)


def _longest_gap(values):
    """Largest number of missing readings in a row; more than any length where an end is missing."""
    known = np.flatnonzero(np.isfinite(values))
    if len(known) < 4 or known[0] > 0 or known[-1] < len(values) - 1:
        return len(values)
    return int(np.diff(known).max()) - 1
