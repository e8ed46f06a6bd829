"""Accelerometers against the markers of the same body, in the band in which both are informative."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import make_interp_spline

from blockshake.measurement.motion.body_frame import ON_LINE, outlying, rigid_jacobian, see_from_body
from blockshake.parity.marker_equations import record_scale, take_out

_SHORT_GAUSSIAN, _LONG_GAUSSIAN = 0.02, 0.1  # s, standard deviations of the two: a band of 1.5 to 10 Hz
_FINE_GAUSSIAN = 0.012  # s, of the Gaussian within which a body's axes do not turn
_SLOW_GAUSSIAN = 0.25  # s, of the Gaussian that shows drifts
_COLOUR = 3.0  # of noise with a coefficient of 0.5 from reading to reading: its variance after a long filter
_KERNEL_SUPPORT = 5.0  # standard deviations
_LARGEST_GAP = 2  # readings that interpolation bridges
_LARGEST_ROTATION = 0.3  # rad
_READINGS = 50  # that a channel needs
_SIGNAL_TO_NOISE = 10.0  # times its own noise that a channel must show in the band
LARGEST_MAGNIFICATION = 3.0  # noise of the sensor's point over a marker's, above which nothing is compared
LARGEST_UNSEEN_ARM = 0.1  # m per rad


@dataclass(frozen=True)
class ChannelPair:
    """One accelerometer channel and its expectation from the markers, both through the same band.

    Attributes
    ----------
    name, sensor : str
    time : float64 array, shape (n_times,)
        Of the markers [s].
    expected, expected_slow : float64 arrays, shape (n_times,)
        From the markers [m/s2]; NaN near gaps and ends.
    read, read_slow : callables of times
        Band-passed and low-passed readings at the accelerometers' times [m/s2]; NaN near gaps and ends.
    noise : float
        Standard deviation of the accelerometer's own noise in the band [m/s2].
    unseen : bool
        The markers lie on a line, and a turn about it, which they do not show, moves the sensor along its axis.
    """

    name: str
    sensor: str
    time: np.ndarray
    expected: np.ndarray
    expected_slow: np.ndarray
    read: object
    read_slow: object
    noise: float
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
    """Pairs of a test, for every channel on a body with three markers.

    Parameters
    ----------
    structure : Structure
    test : xarray.Dataset
        As in a campaign.
    poses : dict of str to MeasuredPose
        Of bodies in this test.
    accelerometer_noise : float
        Standard deviation of a reading [m/s2].

    Notes
    -----
    Along the sensor's axis the specific force is ``R' (a - g)``. The markers' point at the sensor is convolved with the
    second derivative of a narrow Gaussian and then with the rest of the kernel with which the readings are
    convolved: nothing is differentiated on its own and both lose the same frequencies. The kernel is a difference of
    two Gaussians: no constant offset passes.
    """
    time_acc = test["time_acc"].to_numpy()
    read = {str(name): test["accelerometer"].sel(channel=name).to_numpy() for name in test["channel"].values}
    pairs = []
    for sensor in structure.file.accelerometers:
        if sensor.body not in poses:
            continue
        points, time, position, rotation, _ = poses[sensor.body]
        for axis in sensor.axes:
            name = f"{sensor.name}-{axis}"
            if name not in read or len(time) < 2:
                continue
            magnified, unseen = sight(points, sensor.position, np.eye(3)["xyz".index(axis)])
            if magnified > LARGEST_MAGNIFICATION:
                continue
            point = position + rotation @ np.array(sensor.position, dtype=float)
            own = rotation[:, :, "xyz".index(axis)]
            expected, slow = (
                _expected(time, point, own, np.array(structure.file.gravity), kernel)
                for kernel in (_band, _low)
            )
            rate = (len(time_acc) - 1) / (time_acc[-1] - time_acc[0])
            weights = _band(_lags(_LONG_GAUSSIAN, rate)) / rate
            noise = accelerometer_noise * np.sqrt(_COLOUR * (weights**2).sum())
            pairs.append(ChannelPair(
                name, sensor.name, time, expected, slow, _filtered(time_acc, read[name], _band, _LONG_GAUSSIAN),
                _filtered(time_acc, read[name], _low, _SLOW_GAUSSIAN), noise, unseen > LARGEST_UNSEEN_ARM,
            ))  # fmt: skip
    return pairs


def sight(points, place, direction):
    """Noise and visibility of a point's motion along a direction of its body, as the markers give it.

    Returns
    -------
    magnified : float
        Its noise over that of a marker [1].
    unseen : float
        Its motion along the direction in a unit turn that the markers do not show [m].
    """
    jacobian = rigid_jacobian(points - points.mean(axis=0))
    row = direction @ rigid_jacobian((np.array(place, dtype=float) - points.mean(axis=0))[None])
    inverse = np.linalg.pinv(jacobian, rcond=ON_LINE)
    return np.linalg.norm(row @ inverse), np.linalg.norm(row - row @ inverse @ jacobian)


class MeasuredPose(NamedTuple):
    """Pose of a body in one test.

    Attributes
    ----------
    points : float64 array, shape (n_markers, 3)
        Of its markers, as the structure has them, body frame [m].
    time : float64 array, shape (n_times,)
        Even [s]; none where too little was read.
    position, rotation : float64 arrays, shapes (n_times, 3), (n_times, 3, 3)
        NaN where gaps are too long.
    read : bool array, shape (n_times, n_markers)
    """

    points: np.ndarray
    time: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    read: np.ndarray


def measured_pose(body, faults, test):
    """`MeasuredPose` of `BodyMarkers` in the test of this number, `MarkerFaults` taken out."""
    time, displacement = body.readings[test]
    points = body.points + faults.place
    places = body.position + points @ body.rotation.T
    readings = places + take_out(displacement, record_scale(time), faults, test)
    pose = see_from_body(points, readings, body.position, body.rotation)
    readings[outlying(pose.residual)] = np.nan
    # steps where a marker comes or goes would look like acceleration
    readings = readings - np.einsum(
        "tij,mj->tmi", np.nan_to_num(pose.rotation), np.nan_to_num(np.nanmean(pose.residual, axis=0))
    )
    pose = see_from_body(points, readings, body.position, body.rotation)
    turned = np.einsum("tij,ij->t", pose.rotation, body.rotation)
    known = np.isfinite(turned) & (turned > 1.0 + 2.0 * np.cos(_LARGEST_ROTATION))
    even = np.linspace(time[0], time[-1], len(time) if known.sum() > 1 else 0)
    flat = np.concatenate([pose.position, pose.rotation.reshape(-1, 9)], axis=1)
    filled = np.full((len(even), 12), np.nan)
    if len(even):
        near = ~_far_from(even, time[known], time[1] - time[0])
        for column, values in enumerate(flat.T):
            filled[near, column] = np.interp(even[near], time[known], values[known])
    read = np.isfinite(readings).all(axis=2)[: len(even)]
    return MeasuredPose(body.points, even, filled[:, :3], filled[:, 3:].reshape(-1, 3, 3), read)


def _far_from(even, known, step):
    """Times at which interpolation between known readings is not to be trusted."""
    after = np.clip(np.searchsorted(known, even - 1e-9), 0, len(known) - 1)
    before = np.clip(np.searchsorted(known, even + 1e-9) - 1, 0, len(known) - 1)
    return (known[after] - known[before] > (_LARGEST_GAP + 1.5) * step) | (even > known[-1] + 1e-9)


def _band(lag, done=0.0):
    """Band-pass kernel at these times [1/s], less a Gaussian already passed."""
    short, long = (np.sqrt(spread**2 - done**2) for spread in (_SHORT_GAUSSIAN, _LONG_GAUSSIAN))
    return _gaussian(lag, short) - _gaussian(lag, long)


def _low(lag, done=0.0):
    """Low-pass kernel, the same way."""
    return _gaussian(lag, np.sqrt(_SLOW_GAUSSIAN**2 - done**2))


def _gaussian(lag, spread, order=0):
    """Gaussian [1/s] or its second derivative [1/s3]."""
    value = np.exp(-0.5 * (lag / spread) ** 2) / (np.sqrt(2.0 * np.pi) * spread)
    return value if order == 0 else value * ((lag / spread) ** 2 - 1.0) / spread**2


def _lags(spread, rate):
    count = int(np.ceil(_KERNEL_SUPPORT * spread * rate))
    return np.arange(-count, count + 1) / rate


def _expected(time, point, own, gravity, kernel):
    """Specific force along the sensor's axis, through the kernel, shape (n_times,); NaN near gaps."""
    rate = (len(time) - 1) / (time[-1] - time[0])
    short = _lags(_FINE_GAUSSIAN, rate)
    acceleration, steady = (
        np.stack(
            [_convolved(axis - axis[0], _gaussian(short, _FINE_GAUSSIAN, order) / rate) for axis in values.T],
            axis=1,
        )
        for values, order in ((point, 2), (own, 0))
    )
    # the axis turns while the kernel lasts: the product comes before the long filter
    force = ((steady + own[0]) * acceleration).sum(axis=1) - steady @ gravity
    spread = _LONG_GAUSSIAN if kernel is _band else _SLOW_GAUSSIAN
    return _convolved(force, kernel(_lags(spread, rate), _FINE_GAUSSIAN) / rate)


def _convolved(values, weights):
    """Convolution over gaps bridged, NaN where a gap or an end is near the kernel's middle."""
    known = np.isfinite(values)
    if not known.any():
        return np.full(len(values), np.nan)
    filled = np.interp(np.arange(len(values)), np.flatnonzero(known), values[known])
    half = len(weights) // 2
    found = np.convolve(filled, weights, mode="same") if len(values) >= len(weights) else filled * np.nan
    near = np.convolve(~known, np.ones(2 * max(half // 4, 1) + 1), mode="same") > 0.5
    found[near] = np.nan
    found[:half] = found[-half:] = np.nan
    return found


def _filtered(time, values, kernel, spread):
    rate = (len(time) - 1) / (time[-1] - time[0])
    level = np.nanmedian(values)
    return between_readings(time, _convolved(values - level, kernel(_lags(spread, rate)) / rate))


def between_readings(time, values):
    """Callable of times: the cubic spline through readings (n_times,), NaN beside a gap and outside of the record."""
    known = np.isfinite(values)
    if known.sum() < 4:
        return lambda times: np.full(len(times), np.nan)
    spline = make_interp_spline(time[known], values[known], k=3)

    def at(times):
        found = spline(np.clip(times, time[known][0], time[known][-1]))
        place = np.clip(np.searchsorted(time, times), 1, len(time) - 1)
        inside = known[place] & known[place - 1] & (times >= time[0]) & (times <= time[-1])
        return np.where(inside, found, np.nan)

    return at
