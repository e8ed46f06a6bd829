"""Motion of the bodies with its covariance, from all their sensors at once."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.forces.equations import AccelerationEquations
from blockshake.forces.kernel_noise import Colour
from blockshake.forces.local_fit import REACH, fit_locally
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_poses import NOTHING, PLANAR, TRANSLATION, body_poses
from blockshake.measurement.motion.joints import rotation_vectors

WIDTH = 0.015  # s, standard deviation of the smoothing kernel
_STEP = 0.01  # s, between instants: less than the kernel's width
_COVERED = 2.5  # of it: an instant nearer to an end of the record is left out
_SHORTEST = 0.5  # s of instants
_FAR_OUT = 6.0  # median distances, four standard deviations


@dataclass(frozen=True)
class Motion:
    """Smoothed motion of all bodies; all vectors in the world frame."""

    time: np.ndarray  # float64 (n_times,) [s]
    # position, velocity, acceleration: float64 (n_times, n_bodies, 3); of the mass centres [m, m/s, m/s2];
    # NaN where unknown
    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    rotation: np.ndarray  # float64 (n_times, n_bodies, 3, 3); body to world
    # angular_velocity, angular_acceleration: float64 (n_times, n_bodies, 3) [rad/s, rad/s2]
    angular_velocity: np.ndarray
    angular_acceleration: np.ndarray
    # float64 (n_times, n_bodies, 6, 6); inverse covariance of acceleration and angular acceleration; singular
    # where a direction is not read, zero where nothing is
    information: np.ndarray
    # list of dict of Colour to float64 (n_times, 6, n_sources); by body: errors of its accelerations by one standard
    # deviation of every sensor's noise [m/s2, rad/s2]
    errors: list
    # pose_covariance, rate_covariance: float64 (n_bodies, 6, 6); of the smoothed position and small rotation
    # [m, rad], and of their rates [m/s, rad/s]
    pose_covariance: np.ndarray
    rate_covariance: np.ndarray
    known: list  # of str, length n_bodies; as of `body_poses`
    width: float  # standard deviation of the smoothing kernel [s]

    def velocity_at(self, body, point):
        """Velocity of the point of a body that is at ``point`` (n_times, 3), in the world frame [m/s]."""
        return self.velocity[:, body] + np.cross(
            self.angular_velocity[:, body], point - self.position[:, body]
        )


def is_short(test):
    """Whether a test is too short for the kernel, to either side of half a second of instants."""
    return float(test["time"][-1] - test["time"][0]) < 2.0 * REACH * WIDTH + _SHORTEST


def smooth_motion(test, structure, sensors):
    """Motion of all bodies of a test.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file, outliers left out; markers count from rest.
    structure : Structure
    sensors : Sensors

    Returns
    -------
    Motion
        At instants that the kernel covers, of the markers' times.

    Notes
    -----
    Positions are local parabolas through the poses that the markers give. Accelerations are the least squares of
    two kinds of equations, each with its variance: a marker at the arm r has the second derivative
    ``a + alpha x r + omega x (omega x r)``, and an accelerometer along d reads ``d . (that - g)``, both smoothed by the
    same positive kernel, see `fit_locally`.
    """
    read_at = test["time"].to_numpy()
    time = _instants(read_at)
    poses = body_poses(test, structure, sensors.marker_noise)
    start = rotation_matrices(structure.orientation)
    position, velocity, gains = _smooth_position(read_at, poses.position, time, sensors.marker_slow)
    rotation, spin = _smooth_rotation(read_at, poses.rotation, start, time)
    equations = AccelerationEquations(len(time), len(structure.mass))
    turning = np.where(np.isfinite(rotation), rotation, start), np.where(np.isfinite(spin), spin, 0.0)
    _add_markers(equations, test, structure, sensors, time, turning)
    _hold_unread(equations, structure, poses.known)
    if "accelerometer" in test:
        posed = np.array([known != NOTHING for known in poses.known])
        by_markers = np.where(posed[:, None], equations.solve()[0], np.nan)
        _add_accelerometers(equations, test, structure, sensors, by_markers, time, turning)
    acceleration, information = equations.solve()
    return Motion(
        time, position, velocity, acceleration[..., :3], rotation, spin, acceleration[..., 3:], information,
        equations.errors(), gains[0] * poses.covariance, gains[1] * poses.covariance, poses.known, WIDTH,
    )  # fmt: skip


def _instants(read_at):
    """Times of every so-manieth reading, from where to where the kernel's weight lies within the record."""
    every = max(1, round(_STEP / float(np.median(np.diff(read_at)))))
    chosen = read_at[::every]
    return chosen[(chosen >= read_at[0] + _COVERED * WIDTH) & (chosen <= read_at[-1] - _COVERED * WIDTH)]


def _smooth_position(read_at, position, time, slow):
    """Smoothed positions and velocities, and by how much less noise they have than one reading."""
    values, variances = fit_locally(read_at, position.reshape(len(read_at), -1), time, WIDTH)
    usual = np.where(np.isfinite(variances), variances, np.nan)
    gains = (1.0 - slow.share) * np.nanmedian(usual.reshape(3, -1), axis=1)
    gains[:2] += slow.share * np.array([1.0, slow.memory**-2.0])
    return *values[:2].reshape(2, len(time), *position.shape[1:]), gains


def _smooth_rotation(read_at, rotation, start, time):
    """Smoothed rotations and angular velocities.

    Rotation vectors from the start are smoothed: those of blocks that rock stay far below a radian, and to second
    order the angular velocity is ``v' + v x v' / 2``.
    """
    vectors = rotation_vectors(rotation @ np.swapaxes(start, -1, -2))
    values, _ = fit_locally(read_at, vectors.reshape(len(read_at), -1), time, WIDTH)
    value, rate = values[:2].reshape(2, len(time), *vectors.shape[1:])
    known = np.isfinite(value).all(axis=-1)
    smooth = np.full((len(time), *rotation.shape[1:]), np.nan)
    smooth[known] = Rotation.from_rotvec(value[known]).as_matrix()
    return smooth @ start, rate + 0.5 * np.cross(value, rate)


def _add_markers(equations, test, structure, sensors, time, turning):
    """Equations of all markers: their second derivatives along the three axes."""
    read_at = test["time"].to_numpy()
    rotation, spin = turning
    displacement = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()
    fit = fit_locally(read_at, displacement.reshape(len(read_at), -1), time, WIDTH)
    second, variance = (part[2].reshape(len(time), *displacement.shape[1:]) for part in fit)
    noise = _noise(sensors.marker_slow, True, sensors.noise_by_axis, variance)
    axes = np.broadcast_to(np.eye(3), (len(time), 3, 3))
    for column, name in enumerate(map(str, test["marker"].values)):
        (marker,) = (marker for marker in structure.file.markers if marker.name == name)
        body, arm = _carried(structure, marker, rotation)
        towards = _centripetal(spin[:, body], arm)
        own = {colour: part[:, column] for colour, part in noise.items()}
        equations.add(body, axes, arm, second[:, column] - towards, own)


def _noise(slow, twice, size, variance):
    """Noise of smoothed readings of the standard deviation ``size``, by `Colour`: what is white, and what is slow.

    ``variance`` is that of smoothed white noise of variance 1.
    """
    noise = {Colour(twice, 0.0): np.sqrt((1.0 - slow.share) * variance) * size}
    if slow.share > 0.0:
        colour = Colour(twice, slow.memory)
        noise[colour] = np.broadcast_to(np.sqrt(slow.share * colour.variance(WIDTH)) * size, variance.shape)
    return noise


def _add_accelerometers(equations, test, structure, sensors, by_markers, time, turning):
    """Equations of all channels: specific force along an axis of the body, less its offset.

    The offset is the mean distance from the accelerations that the markers give, (n_times, n_bodies, 6), but for
    outliers as of impacts: their own mean is the change of velocity over the test, known to a few mm/s. A mean of the
    reading at rest would hold the first motion of the table, which is in the accelerations before it shows in the
    markers. It stays where the markers give none.
    """
    read_at = test["time_acc"].to_numpy()
    rotation, spin = turning
    gravity = np.array(structure.file.gravity)
    readings = test["accelerometer"].transpose("time_acc", "channel").to_numpy()
    channels = [str(name) for name in test["channel"].values]
    for sensor in structure.file.accelerometers:
        for axis in sensor.axes:
            if f"{sensor.name}-{axis}" not in channels:
                continue
            body, arm = _carried(structure, sensor, rotation)
            direction = rotation[:, body, :, "xyz".index(axis)]
            weight = direction @ gravity
            # the direction turns little within the kernel: its product with gravity is smoothed with the reading
            force = readings[:, channels.index(f"{sensor.name}-{axis}")] + np.interp(
                read_at, time, weight - weight[0]
            )
            mean, variance = fit_locally(read_at, force[:, None], time, WIDTH, degree=0)
            towards = (direction * _centripetal(spin[:, body], arm)).sum(axis=-1)
            values = mean[0, :, 0] - towards
            moved = by_markers[:, body, :3] + np.cross(by_markers[:, body, 3:], arm)
            away = values - (direction * moved).sum(axis=-1)
            values = values - _usual(away[np.isfinite(away)])
            noise = _noise(sensors.accelerometer_slow, False, sensors.accelerometer_noise, variance[0])
            equations.add(body, direction[:, None], arm, values[:, None], noise)


def _usual(values):
    """Mean of the values within four robust standard deviations of their median, 0 of none."""
    if len(values) == 0:
        return 0.0
    away = np.abs(values - np.median(values))
    return values[away <= _FAR_OUT * np.median(away)].mean()


def _carried(structure, sensor, rotation):
    """Body of a sensor, and its arm from the mass centre in the world frame, (n_times, 3)."""
    (body,), (arm,) = structure.carriers([sensor]), structure.arms([sensor])
    return body, rotation[:, body] @ arm


def _centripetal(spin, arm):
    return np.cross(spin, np.cross(spin, arm))


def _hold_unread(equations, structure, known):
    """Take as none the turns that too few markers leave open: of planar bodies, and of a table with one marker."""
    equations.hold([body for body, extent in enumerate(known) if extent == PLANAR], [3, 5])
    tables = [body for body, extent in enumerate(known) if extent == TRANSLATION and structure.driven[body]]
    equations.hold(tables, [3, 4, 5])
