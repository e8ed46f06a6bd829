"""Accelerometers against the markers of the same body, in the band in which both are informative."""

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.ndimage import binary_dilation, gaussian_filter1d

from blockshake.parity.body_markers import LARGEST_MAGNIFICATION, LARGEST_UNSEEN_ARM, sight

_SHORT_GAUSSIAN, _LONG_GAUSSIAN = 0.02, 0.1  # s, standard deviations of the two: a band of 1.5 to 10 Hz
_FINE_GAUSSIAN = 0.012  # s, of the Gaussian within which a body's axes do not turn
_SLOW_GAUSSIAN = 0.25  # s, of the Gaussian that shows drifts
COLOUR = 3.0  # of noise with a coefficient of 0.5 from reading to reading: its variance after a long filter
_SUPPORT = 5.0  # standard deviations
_READINGS = 50  # that a channel needs
_SIGNAL_TO_NOISE = 10.0  # times its own noise that a channel must show in the band


@dataclass(frozen=True)
class ChannelPair:
    """One accelerometer channel and its expectation from the markers, both through the same band."""

    name: str
    sensor: str
    time: np.ndarray  # float64 (n_times,); of the markers [s]
    # expected, expected_slow: float64 (n_times,); from the markers [m/s2]; NaN near gaps and ends
    expected: np.ndarray
    expected_slow: np.ndarray
    # read, read_slow: callables of times; band-passed and low-passed readings at the accelerometers' times
    # [m/s2]; NaN near gaps and ends
    read: object
    read_slow: object
    noise: float  # standard deviation of the accelerometer's own noise in the band [m/s2]
    # the markers lie on a line, and a turn about it, which they do not show, moves the sensor along its axis
    unseen: bool

    @cached_property
    def informed(self):
        """Whether the channel reads much more than its noise in the band."""
        read = self.read(self.time)
        return np.isfinite(read).sum() > _READINGS and np.nanstd(read) > _SIGNAL_TO_NOISE * self.noise

    def enough(self, read, expected=None):
        """Times at which both readings and expectation are known, bool (n_times,); None where there are too few."""
        known = np.isfinite(self.expected if expected is None else expected) & np.isfinite(read)
        return known if known.sum() >= _READINGS else None


def channel_pairs(structure, test, poses, accelerometer_noise):
    """Pair every accelerometer channel on a body with three markers with the acceleration of the markers.

    Parameters
    ----------
    structure : Structure
    test : xarray.Dataset
        As in a campaign.
    poses : dict of str to MeasuredPose
        Bodies in this test.
    accelerometer_noise : float
        Standard deviation of a reading [m/s2].

    Notes
    -----
    Along the sensor's axis the specific force is ``R' (a - g)``. The markers' point at the sensor is convolved with the
    second derivative of a narrow Gaussian and then with the rest of the kernel with which the readings are
    convolved: nothing is differentiated on its own and both lose the same frequencies. The kernel is a difference of
    two Gaussians: no constant offset passes.
    """
    if "accelerometer" not in test:
        return []
    time_acc = test["time_acc"].to_numpy()
    rate = (len(time_acc) - 1) / (time_acc[-1] - time_acc[0])
    pulse = np.zeros(4 * _reach(_LONG_GAUSSIAN, rate))
    pulse[len(pulse) // 2] = 1.0
    noise = accelerometer_noise * np.sqrt(COLOUR * (_band(pulse, rate) ** 2).sum())
    pairs = []
    for sensor in structure.file.accelerometers:
        pose = poses.get(sensor.body)
        for axis in sensor.axes if pose is not None else ():
            name, along = f"{sensor.name}-{axis}", np.eye(3)["xyz".index(axis)]
            magnified, unseen = sight(pose.points, sensor.position, along)
            if name not in test["channel"].values or magnified > LARGEST_MAGNIFICATION:
                continue
            force, pose_rate = _specific_force(structure, sensor, along, pose)
            read = test["accelerometer"].sel(channel=name).to_numpy()
            read = read - np.nanmedian(read)
            expected, slow = (
                _over_gaps(
                    partial(kernel, rate=pose_rate, done=_FINE_GAUSSIAN), force, _reach(width, pose_rate)
                )
                for kernel, width in _KERNELS
            )
            band, low = (
                between_readings(time_acc, _over_gaps(partial(kernel, rate=rate), read, _reach(width, rate)))
                for kernel, width in _KERNELS
            )
            pairs.append(ChannelPair(
                name, sensor.name, pose.time, expected, slow, band, low, noise, unseen > LARGEST_UNSEEN_ARM
            ))  # fmt: skip
    return pairs


def _specific_force(structure, sensor, along, pose):
    """Specific force along the sensor's axis, through the fine Gaussian [m/s2], and readings a second of the pose."""
    rate = (len(pose.time) - 1) / (pose.time[-1] - pose.time[0])
    point = pose.position + pose.rotation @ np.array(sensor.position, dtype=float)
    axis, reach = pose.rotation @ along, _reach(_FINE_GAUSSIAN, rate)
    acceleration, steady = (
        np.stack([_over_gaps(kernel, column, reach) for column in (values - values[0]).T], axis=1)
        for values, kernel in (
            (point, partial(_gaussian, rate=rate, spread=_FINE_GAUSSIAN, order=2)),
            (axis, partial(_gaussian, rate=rate, spread=_FINE_GAUSSIAN)),
        )
    )
    # the axis turns while the kernel lasts: the product comes before the long filter
    return ((steady + axis[0]) * acceleration).sum(axis=1) - steady @ np.array(structure.file.gravity), rate


def _gaussian(values, rate, spread, order=0):
    """Values through a Gaussian of this standard deviation [s], or through its second derivative."""
    filtered = gaussian_filter1d(values, spread * rate, order=order, truncate=_SUPPORT, mode="nearest")
    return filtered * rate**order


def _band(values, rate, done=0.0):
    """Band-pass values to which a Gaussian of width ``done`` [s] was applied before."""
    short, long = (np.sqrt(spread**2 - done**2) for spread in (_SHORT_GAUSSIAN, _LONG_GAUSSIAN))
    return _gaussian(values, rate, short) - _gaussian(values, rate, long)


def _low(values, rate, done=0.0):
    """Low-pass values to which a Gaussian of width ``done`` [s] was applied before."""
    return _gaussian(values, rate, np.sqrt(_SLOW_GAUSSIAN**2 - done**2))


_KERNELS = (_band, _LONG_GAUSSIAN), (_low, _SLOW_GAUSSIAN)


def _reach(spread, rate):
    """Readings to either side that a kernel takes in."""
    return int(np.ceil(_SUPPORT * spread * rate))


def _over_gaps(kernel, values, reach):
    """Values through a kernel, gaps bridged; NaN where a gap is near the kernel's middle, and at the ends."""
    known = np.isfinite(values)
    if not known.any() or len(values) <= 2 * reach:
        return np.full(len(values), np.nan)
    rows = np.arange(len(values))
    filtered = kernel(np.interp(rows, rows[known], values[known]))
    near = binary_dilation(~known, iterations=max(reach // 4, 1))
    return np.where(near | (rows < reach) | (rows >= len(rows) - reach), np.nan, filtered)


def between_readings(time, values):
    """Callable of times: the cubic spline through readings (n_times,), NaN next to a gap and outside of the record."""
    known = np.isfinite(values)
    if known.sum() < 4:
        return lambda times: np.full(len(times), np.nan)
    spline = make_interp_spline(time[known], values[known], k=3)

    def at(times):
        after = np.clip(np.searchsorted(time, times), 1, len(time) - 1)
        inside = known[after] & known[after - 1] & (times >= time[0]) & (times <= time[-1])
        return np.where(inside, spline(np.clip(times, time[known][0], time[known][-1])), np.nan)

    return at
