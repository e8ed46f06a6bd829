"""Linear equations of the markers' faults on one body: the residual that each fault leaves in the rigid fit."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from blockshake.measurement.motion.body_frame import outlying, see_from_body

_LARGEST_ROTATION = 0.3  # rad; a body that lies on its side is no longer checked
_WEAK_LEVER = 0.1  # lever of the markers about an axis, over the largest: the turn about it is mostly noise
_SMOOTHING = 101  # readings, half a second, over which such a turn is averaged
_SEGMENT = 40  # readings over which coloured noise averages out, 0.2 s at 200 Hz
CONSTANT, DRIFT, GAIN, PLACE = "constant", "drift", "gain", "place"
_SIZES = {CONSTANT: 3, DRIFT: 3, GAIN: 1, PLACE: 3}


@dataclass(frozen=True)
class MarkerFaults:
    """Faults of the markers of one body in every test.

    Attributes
    ----------
    gain : float64 array, shape (n_markers,)
        Reading over displacement, less 1 [1].
    place : float64 array, shape (n_markers, 3)
        True place of the marker less its stated place, body frame [m].
    drift : float64 array, shape (n_tests, n_markers, 3)
        Over the whole record, inertial frame [m].
    """

    gain: np.ndarray
    place: np.ndarray
    drift: np.ndarray

    @classmethod
    def none(cls, n_tests, n_markers):
        """No fault."""
        return cls(np.zeros(n_markers), np.zeros((n_markers, 3)), np.zeros((n_tests, n_markers, 3)))

    def plus(self, vector):
        """Faults changed by a vector in the order of `columns`."""
        n_drift, n_gain = self.drift.size, self.gain.size
        drift, gain, place = np.split(vector, [n_drift, n_drift + n_gain])
        return MarkerFaults(
            self.gain + gain, self.place + place.reshape(-1, 3), self.drift + drift.reshape(self.drift.shape)
        )


@dataclass(frozen=True)
class MarkerEquations:
    """Normal equations of one body over its tests; parameters as in `columns`.

    Attributes
    ----------
    normal, right : float64 arrays, shapes (n_parameters, n_parameters), (n_parameters,)
        [m2 over the parameters' units]
    square : float
        Sum of the squared residuals [m2].
    variance : float
        Of a reading, times the factor by which coloured noise averages out more slowly than white noise [m2].
    noise : float64 array, shape (n_markers,)
        Standard deviation of each marker's residual, scaled to that of a reading [m].
    misfit : float64 array, shape (n_markers,)
        The same before any fault is taken out [m].
    """

    normal: np.ndarray
    right: np.ndarray
    square: float
    variance: float
    noise: np.ndarray
    misfit: np.ndarray


def columns(kind, n_tests, n_markers, marker, test=0):
    """Places of a marker's parameters in the vector [constants, drifts, gains, places]."""
    first = {
        CONSTANT: 3 * n_markers * test,
        DRIFT: 3 * n_markers * (n_tests + test),
        GAIN: 6 * n_markers * n_tests,
        PLACE: 6 * n_markers * n_tests + n_markers,
    }[kind]
    size = _SIZES[kind]
    return first + size * marker + np.arange(size)


def marker_equations(points, start_position, start_rotation, tests, faults):
    """`MarkerEquations` of one body, linear about the faults given.

    Parameters
    ----------
    points : float64 array, shape (n_markers, 3)
        Body frame [m].
    start_position, start_rotation : float64 arrays, shapes (3,), (3, 3)
        Pose at rest, of the structure.
    tests : list of (time, displacement)
        Times [s] and readings (n_times, n_markers, 3) of each test, inertial frame [m].
    faults : MarkerFaults
        Faults that are taken out of the readings first.

    Notes
    -----
    In the body's frame with rotation R(t) and start R0, what remains of a reading is P applied to the sum over the
    markers of ``c + R' s d + R' u g + (1 - R' R0) e`` with constant c, drift d over the record (s from -1/2 to 1/2),
    gain g of the displacement u and place e: a gain follows the displacement, a wrong place follows the rotation and is
    nothing before it.
    """
    n_tests, n_markers = len(tests), len(points)
    size = 6 * n_markers * n_tests + 4 * n_markers
    normal, right, square = np.zeros((size, size)), np.zeros(size), 0.0
    kept = []
    for test, (time, displacement) in enumerate(tests):
        design, residual, projector = _one_test(
            points, start_position, start_rotation, time, displacement, faults, test
        )
        own = np.concatenate(
            [
                np.arange(3 * n_markers) + columns(kind, n_tests, n_markers, 0, test)[0]
                for kind in (CONSTANT, DRIFT)
            ]
            + [np.arange(6 * n_markers * n_tests, size)]
        )
        flat = design.reshape(-1, design.shape[2])
        normal[np.ix_(own, own)] += flat.T @ flat
        right[own] += flat.T @ residual.ravel()
        square += (residual**2).sum()
        kept.append((own, design, residual, projector))
    free = np.linalg.lstsq(
        normal + 1e-9 * np.diag(np.diagonal(normal)) + 1e-12 * np.eye(size), right, rcond=None
    )[0]
    variance, noise = _noise(kept, free, n_markers)
    misfit = _noise(kept, None, n_markers)[1]
    return MarkerEquations(normal, right, square, variance, noise, misfit)


def take_out(displacement, scale, faults, test):
    """Displacements of one body's markers without gain and drift [m], shape (n_times, n_markers, 3), inertial frame.

    ``scale(n_times,)`` runs from -1/2 to 1/2 over the record. A wrong place is no error of the reading: it belongs to
    the marker's point.
    """
    drift = scale[:, None, None] * faults.drift[test]
    return (displacement - drift) / (1.0 + faults.gain[:, None])


def record_scale(time):
    """From -1/2 at the first reading to 1/2 at the last."""
    return (time - time[0]) / (time[-1] - time[0]) - 0.5


def _one_test(points, start_position, start_rotation, time, displacement, faults, test):
    n_markers = len(points)
    scale = record_scale(time)
    points = points + faults.place
    places = start_position + points @ start_rotation.T
    readings = places + take_out(displacement, scale, faults, test)
    pose = see_from_body(points, readings, start_position, start_rotation)
    turned = np.einsum("tji,jk->tik", pose.rotation, start_rotation)
    used = np.flatnonzero(
        pose.projector.any(axis=(1, 2))
        & ~outlying(pose.residual).any(axis=1)
        & (np.trace(turned, axis1=1, axis2=2) > 1.0 + 2.0 * np.cos(_LARGEST_ROTATION))
    )
    rotation = _steadied(points, pose.rotation[used], start_rotation)
    turned = np.einsum("tji,jk->tik", rotation, start_rotation)
    moved = pose.position[used, None] + np.einsum("tij,mj->tmi", rotation, points) - places
    signatures = np.zeros((len(used), n_markers, 3, 10 * n_markers))
    for marker in range(n_markers):
        signatures[:, marker, :, 3 * marker : 3 * marker + 3] = np.eye(3)
        drift = 3 * (n_markers + marker)
        signatures[:, marker, :, drift : drift + 3] = scale[used, None, None] * rotation.transpose(0, 2, 1)
        signatures[:, marker, :, 6 * n_markers + marker] = np.einsum("tji,tj->ti", rotation, moved[:, marker])
        place = 7 * n_markers + 3 * marker
        signatures[:, marker, :, place : place + 3] = np.eye(3) - turned
    projector = pose.projector[used]
    design = projector @ signatures.reshape(len(used), 3 * n_markers, -1)
    residual = np.nan_to_num(pose.residual[used]).reshape(len(used), -1)
    residual = np.einsum("tij,tj->ti", projector, residual)
    return design, residual, projector


def _steadied(points, rotation, start_rotation):
    """Rotations whose turn about an axis through nearly all markers is averaged over time.

    Its noise would enter the signatures and make every estimate that rests on it too small.
    """
    arms = points - points.mean(axis=0)
    lever, axes = np.linalg.eigh((arms**2).sum() * np.eye(3) - arms.T @ arms)
    weak = axes[:, lever < _WEAK_LEVER**2 * lever.max()]
    if not weak.size or not len(rotation):
        return rotation
    vectors = Rotation.from_matrix(np.einsum("ji,tjk->tik", start_rotation, rotation)).as_rotvec()
    about = vectors @ weak
    steady = uniform_filter1d(about, _SMOOTHING, axis=0, mode="nearest")
    return start_rotation @ Rotation.from_rotvec(vectors + (steady - about) @ weak.T).as_matrix()


def _noise(kept, parameters, n_markers):
    """Variance for slow signatures, and each marker's standard deviation."""
    slow = fast = 0.0
    squares, shares = np.zeros(n_markers), np.zeros(n_markers)
    freedom = 0.0
    for own, design, residual, projector in kept:
        left = residual - (design @ parameters[own] if parameters is not None else residual.mean(axis=0))
        diagonal = np.diagonal(projector, axis1=1, axis2=2).reshape(len(residual), n_markers, 3)
        squares += (left.reshape(-1, n_markers, 3) ** 2).sum(axis=(0, 2))
        shares += diagonal.sum(axis=(0, 2))
        whole = len(left) // _SEGMENT * _SEGMENT
        if whole:
            sums = left[:whole].reshape(-1, _SEGMENT, left.shape[1]).sum(axis=1)
            slow += (sums**2).sum()
            fast += (left[:whole] ** 2).sum()
        freedom += diagonal.sum()
    if not freedom or not fast:
        return np.nan, np.full(n_markers, np.nan)
    variance = squares.sum() / freedom * max(slow / fast, 1.0)
    return variance, np.sqrt(squares / np.maximum(shares, 1e-9))
