"""The noise of sensors as it is: its size, by axis, and its slow part, from the rest and from redundant markers."""

from itertools import product
from typing import NamedTuple

import numpy as np
import scipy
from scipy.linalg import solve_triangular, toeplitz

from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import AXES
from blockshake.measurement.motion.body_frame import ON_LINE, rigid_jacobian
from blockshake.measurement.sensors.instruments import SlowNoise
from blockshake.measurement.sensors.quiet_start import counted_from_rest

_SHARES = (0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9)
_MEMORIES = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)  # s
_GAINS = 3.0  # nats, by which a slow part has to explain the rest better than white noise does
_FEWEST_AT_REST = 20  # readings of a rest
_MOST_GAPS = 0.2  # of a sensor's readings in it
_FEWEST_REDUNDANT = 3  # markers of a body
_ROUNDED = 0.01  # of the usual variance: less is of readings that are rounded
_LEAST = 0.5  # of the stated noise: rounded readings may not move at all in a rest
_STATED = 100.0  # readings that what is stated counts for
_FAR_SHARE = 0.1  # of the variance: a slow part that is farther from the stated one is remarked
_FILTERED = 0.03  # s; of a shorter memory are filters, whose noise no campaign states
_UNEVEN = 1.1  # between the noise along two axes, within which one figure states both
_OFFSET = 100.0  # variance of a constant, over that of the noise


class _Rest(NamedTuple):
    """Readings of one sort in the rest of a test, and what a motion of the whole stack makes of them."""

    step: float  # between readings [s]
    values: np.ndarray  # float64 (n_times, n_columns)
    group: np.ndarray  # int (n_columns,); columns of one group have one standard deviation
    motion: np.ndarray  # float64 (n_columns, 6)


def found_noise(tests, structure, sensors):
    """`Sensors` with the noise that the rest before the tests shows.

    Parameters
    ----------
    tests : dict of str to xarray.Dataset
        By name, without outliers.
    structure : Structure
    sensors : Sensors
        As stated: what is kept where no test has a rest.

    Notes
    -----
    The stack at rest may still move with the table, as one body: at each instant rigid motions are taken out by least
    squares. The rest is a Gaussian process of white noise and of a share of slow noise, ``exp(-|t| / memory)``;
    share and memory are those of the largest likelihood on a grid, the means of the readings free. How the noise is
    shared by the axes is found from the redundant markers of each body over the whole tests.
    """
    sensors = sensors.not_noiseless()
    at_rest = [counted_from_rest(test, structure, sensors) for test in tests.values()]
    markers = [rest for one in at_rest if (rest := _of_markers(*one, structure))]
    channels = [rest for one in at_rest if (rest := _of_channels(*one, structure))]
    found = {}
    if markers:
        sizes, found["marker_slow"] = _noise(markers, sensors.noise_by_axis)
        found["marker_noise"] = usual = float(np.sqrt((sizes**2).mean()))
        found["marker_axes"] = tuple(_shares_by_axis(tests.values(), structure, sizes / usual).tolist())
    if channels:
        (size,), found["accelerometer_slow"] = _noise(channels, np.array([sensors.accelerometer_noise]))
        found["accelerometer_noise"] = float(size)
    return sensors.model_copy(update=found)


def noise_words(sensors):
    """Words on the noise of `Sensors`: its size, by axis where it is uneven, and its slow part."""
    of_markers = f"{1e3 * sensors.marker_noise:.2g} mm"
    if np.ptp(np.log(sensors.marker_axes)) > np.log(_UNEVEN):
        of_markers = f"{', '.join(f'{1e3 * size:.2g}' for size in sensors.noise_by_axis)} mm along x, y, z"
    parts = (
        ("markers", of_markers, sensors.marker_slow),
        ("accelerometers", f"{sensors.accelerometer_noise:.2g} m/s2", sensors.accelerometer_slow),
    )
    words = [f"{what} {size}{_slow_words(slow)}" for what, size, slow in parts]
    return f"noise of {'; of '.join(words)}"


def _slow_words(slow):
    return f", {100.0 * slow.share:.0f} % of its variance slow ({slow.memory:g} s)" if slow.share else ""


def noise_remarks(found, stated):
    """Remarks on noise whose slow part, or whose share along an axis, is far from what is stated."""
    far = max(
        abs(np.log(found.noise_by_axis / found.marker_noise * stated.marker_noise / stated.noise_by_axis))
    )
    slow = [
        abs(_slow_share(getattr(found, part)) - _slow_share(getattr(stated, part))) >= _FAR_SHARE
        for part in ("marker_slow", "accelerometer_slow")
    ]
    if far < np.log(_UNEVEN) and not any(slow):
        return []
    return [f"at rest the {noise_words(found)}; stated is a {noise_words(stated)}"]


def _slow_share(slow):
    return slow.share if slow.memory > _FILTERED else 0.0


def _shares_by_axis(tests, structure, at_rest):
    """Noise of markers along each axis over the usual one, float64 (3,), as redundant markers leave it in whole tests.

    Second differences of the readings leave out slow motion, the rigid motion of each body is taken out of them, and
    the variance of a coordinate, from the median against gaps and blows, is a mean of the variances along the axes with
    the squares of the projector as weights. ``at_rest`` is kept where no body has redundant markers, or where rounded
    readings along an axis do not change: blocks that settle in the rest make it uneven.
    """
    weights, variances = [], []
    for test, name in product(tests, structure.body_names):
        read = set(map(str, test["marker"].values))
        markers = [marker for marker in structure.file.markers if marker.body == name and marker.name in read]
        if len(markers) < _FEWEST_REDUNDANT:
            continue
        moved = test["marker_displacement"].sel(marker=[marker.name for marker in markers])
        moved = moved.transpose("time", "marker", "axis").to_numpy().reshape(moved.sizes["time"], -1)
        change = np.diff(moved, 2, axis=0)
        change = change[np.isfinite(change).all(axis=1)]
        if len(change) < _FEWEST_AT_REST:
            continue
        orientation = structure.orientation[structure.body_names.index(name)]
        arms = structure.arms(markers) @ rotation_matrices(orientation).T
        jacobian = rigid_jacobian(arms - arms.mean(axis=0))
        projector = np.eye(len(jacobian)) - jacobian @ np.linalg.pinv(jacobian, rcond=ON_LINE)
        weights.append((projector**2).reshape(len(jacobian), -1, 3).sum(axis=1))
        variances.append(np.median(np.abs(change @ projector), axis=0) ** 2)
    if not weights:
        return at_rest
    variance = scipy.optimize.nnls(np.concatenate(weights), np.concatenate(variances))[0]
    usual = variance.mean()
    return np.sqrt(variance / usual) if variance.min() > _ROUNDED * usual else at_rest


def _of_markers(test, until, structure):
    named = {marker.name: marker for marker in structure.file.markers}
    markers = [named[name] for name in map(str, test["marker"].values)]
    points = structure.position[structure.carriers(markers)] + structure.arms(markers)
    moved = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()
    motion = rigid_jacobian(points - points.mean(axis=0))
    return _rest(
        test["time"], until, moved.reshape(len(moved), -1), np.tile(np.arange(3), len(markers)), motion
    )


def _of_channels(test, until, structure):
    if "accelerometer" not in test:
        return None
    sensors = [(sensor, axis) for sensor in structure.file.accelerometers for axis in sensor.axes]
    read = [f"{sensor.name}-{axis}" in test["channel"].values for sensor, axis in sensors]
    sensors = [one for one, there in zip(sensors, read, strict=True) if there]
    if not sensors:
        return None
    names = [f"{sensor.name}-{axis}" for sensor, axis in sensors]
    carried = [sensor for sensor, _ in sensors]
    points = structure.position[structure.carriers(carried)] + structure.arms(carried)
    axes = [AXES.index(axis) for _, axis in sensors]
    motion = rigid_jacobian(points - points.mean(axis=0)).reshape(len(points), 3, 6)
    motion = motion[np.arange(len(points)), axes]
    values = test["accelerometer"].sel(channel=names).transpose("time_acc", "channel").to_numpy()
    return _rest(test["time_acc"], until, values, np.zeros(len(names), dtype=int), motion)


def _rest(time, until, values, group, motion):
    """`_Rest` of the columns that are read until the table moves, short gaps bridged; None of too few readings."""
    time = time.to_numpy()
    quiet = time <= until
    values = values[quiet]
    read = np.isfinite(values)
    kept = read.mean(axis=0) > 1.0 - _MOST_GAPS if len(values) >= _FEWEST_AT_REST else np.zeros(0, dtype=bool)
    if kept.sum() <= motion.shape[1]:
        return None
    rows = np.arange(len(values))
    whole = [np.interp(rows, rows[read[:, one]], values[read[:, one], one]) for one in np.flatnonzero(kept)]
    step = float(np.median(np.diff(time[quiet])))
    return _Rest(step, np.stack(whole, axis=1), group[kept], motion[kept])


def _noise(rests, stated):
    """Standard deviation of each group, (n_groups,), and `SlowNoise`, of one sort of sensors."""
    sizes = _sizes([_without_motion(rest, np.ones(len(rest.group))) for rest in rests], rests, stated)
    left = []
    for rest in rests:
        scale = sizes[rest.group]
        rows, projector = _without_motion(rest, scale)
        values, vectors = np.linalg.eigh(projector)
        left.append((rest.step, rows / scale @ vectors[:, values > 0.5]))
    white, size = _likelihood(left, 0.0, 1.0)
    best, slow = white + _GAINS, SlowNoise()
    for share, memory in product(_SHARES, _MEMORIES):
        log, factor = _likelihood(left, share, memory)
        if log > best:
            best, slow, size = log, SlowNoise(share=share, memory=memory), factor
    return np.maximum(sizes * size, _LEAST * stated), slow


def _without_motion(rest, scale):
    """Readings without rigid motions, weighted by their standard deviations, and the projector of the scaled ones."""
    motion = rest.motion / scale[:, None]
    projector = np.eye(len(motion)) - motion @ np.linalg.pinv(motion)
    return rest.values / scale @ projector * scale, projector


def _sizes(parts, rests, stated):
    """Standard deviation of every group from the sums of squares that motions leave, (n_groups,)."""
    n_groups = len(stated)
    shares, squares = _STATED * np.eye(n_groups), _STATED * stated**2
    for (rows, projector), rest in zip(parts, rests, strict=True):
        of = np.eye(n_groups)[rest.group]
        shares += (len(rows) - 1) * of.T @ projector**2 @ of
        squares += of.T @ ((rows - rows.mean(axis=0)) ** 2).sum(axis=0)
    return np.sqrt(np.maximum(np.linalg.solve(shares, squares), (_LEAST * stated) ** 2))


def _likelihood(left, share, memory):
    """Logarithm of the likelihood of independent histories of noise, at their best common size, and that size."""
    squares, count, spread = np.finfo(float).tiny, 0, 0.0
    for step, rows in left:
        covariance = toeplitz(share * np.exp(-step * np.arange(len(rows)) / memory)) + _OFFSET
        covariance[np.diag_indices(len(rows))] += 1.0 - share
        root = np.linalg.cholesky(covariance)
        squares += (solve_triangular(root, rows, lower=True) ** 2).sum()
        count += rows.size
        spread += rows.shape[1] * np.log(np.diag(root)).sum()
    return -0.5 * count * np.log(squares / count) - spread, np.sqrt(squares / count)
