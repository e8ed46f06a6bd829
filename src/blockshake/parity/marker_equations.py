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
DRIFT, GAIN, PLACE = "drift", "gain", "place"


@dataclass(frozen=True)
class MarkerFaults:
    """Faults of the markers of one body in every test, as one vector: drifts by test and marker, gains, places.

    Attributes
    ----------
    values : float64 array, shape (n_unknowns,)
    n_tests : int
    """

    values: np.ndarray
    n_tests: int

    @classmethod
    def none(cls, n_tests, n_markers):
        """No fault."""
        return cls(np.zeros((3 * n_tests + 4) * n_markers), n_tests)

    @property
    def n_markers(self):
        """Of the body."""
        return len(self.values) // (3 * self.n_tests + 4)

    @property
    def drift(self):
        """Over the whole record, inertial frame, (n_tests, n_markers, 3) [m]."""
        return self.values[: 3 * self.n_tests * self.n_markers].reshape(self.n_tests, -1, 3)

    @property
    def gain(self):
        """Reading over displacement, less 1, (n_markers,) [1]."""
        return self.values[-4 * self.n_markers : -3 * self.n_markers]

    @property
    def place(self):
        """True place of the marker less its stated place, body frame, (n_markers, 3) [m]."""
        return self.values[-3 * self.n_markers :].reshape(-1, 3)

    def columns(self, kind, marker, test=0):
        """Where a marker's unknowns of a kind are in the vector."""
        first, size = {
            DRIFT: (3 * self.n_markers * test, 3),
            GAIN: (3 * self.n_markers * self.n_tests, 1),
            PLACE: (3 * self.n_markers * self.n_tests + self.n_markers, 3),
        }[kind]
        return first + size * marker + np.arange(size)


@dataclass(frozen=True)
class MarkerEquations:
    """Normal equations of one body over its tests; unknowns are constants by test and marker, then `MarkerFaults`.

    Attributes
    ----------
    normal, right : float64 arrays, shapes (n_unknowns, n_unknowns), (n_unknowns,)
        [m2 over the unknowns' units]
    variance : float
        Of a reading, times the factor by which coloured noise averages out more slowly than white noise [m2].
    noise, misfit : float64 arrays, shape (n_markers,)
        Standard deviation of each marker's residual, scaled to that of a reading, after and before faults are taken
        out [m].
    """

    normal: np.ndarray
    right: np.ndarray
    variance: float
    noise: np.ndarray
    misfit: np.ndarray


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
    size = 3 * n_markers * n_tests + len(faults.values)
    normal, right, kept = np.zeros((size, size)), np.zeros(size), []
    for test, (time, displacement) in enumerate(tests):
        design, residual, projector = _one_test(
            points, start_position, start_rotation, time, displacement, faults, test
        )
        own = np.arange(3 * n_markers) + 3 * n_markers * test
        own = np.concatenate([own, own + 3 * n_markers * n_tests, np.arange(6 * n_markers * n_tests, size)])
        flat = design.reshape(-1, design.shape[2])
        normal[np.ix_(own, own)] += flat.T @ flat
        right[own] += flat.T @ residual.ravel()
        kept.append((own, design, residual, projector))
    ridge = 1e-9 * np.diag(np.diagonal(normal)) + 1e-12 * np.eye(size)
    free = np.linalg.lstsq(normal + ridge, right, rcond=None)[0]
    variance, noise = _noise(kept, free, n_markers)
    return MarkerEquations(normal, right, variance, noise, _noise(kept, None, n_markers)[1])


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
    same = np.eye(n_markers)
    back = rotation.transpose(0, 2, 1)
    # (n_times, n_markers or 1, 3, n_unknowns of a marker)
    parts = [
        np.broadcast_to(np.eye(3), (len(used), 1, 3, 3)),
        (scale[used, None, None] * back)[:, None],
        (moved @ rotation)[..., None],
        (np.eye(3) - turned)[:, None],
    ]
    signatures = [
        (part[:, :, :, None] * same[:, None, :, None]).reshape(len(used), n_markers, 3, -1) for part in parts
    ]
    signatures = np.concatenate(signatures, axis=-1)
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
