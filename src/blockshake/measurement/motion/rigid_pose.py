"""Pose of a block from its markers, by least squares, with its uncertainty."""

from dataclasses import dataclass

import numpy as np

from blockshake.errors import InputError

_FEWEST = 3
# Two markers' spread over the largest below which they lie on a line.
_COLLINEAR = 1e-3


@dataclass(frozen=True)
class RigidPoses:
    """Poses of one body in time.

    Attributes
    ----------
    position : float64 array, shape (n_times, 3)
        Of the mass centre, inertial frame [m]; NaN where fewer than three markers were read.
    rotation : float64 array, shape (n_times, 3, 3)
        Body to world.
    covariance : float64 array, shape (n_times, 6, 6)
        Of position [m] and small rotation, world frame [rad].
    misfit : float64 array, shape (n_times,)
        Root mean square over the markers and axes of what a rigid body leaves unexplained [m]; NaN where there is
        nothing left to check.
    """

    position: np.ndarray
    rotation: np.ndarray
    covariance: np.ndarray
    misfit: np.ndarray


def fit_poses(points, readings, marker_noise):
    """Fit a rigid body to its markers at every time.

    Parameters
    ----------
    points : float64 array, shape (n_markers, 3)
        Markers in the body frame [m].
    readings : float64 array, shape (n_times, n_markers, 3)
        Their positions, inertial frame [m]; a marker with a NaN is not used at that time.
    marker_noise : float
        Standard deviation of a position along an axis, the same for all [m].

    Returns
    -------
    RigidPoses

    Raises
    ------
    InputError
        Fewer than three markers, or all on a line.

    Notes
    -----
    Rotation from the singular vectors of the cross-covariance (Arun, Huang and Blostein 1987; Umeyama 1991).
    To first order the covariance is ``noise^2 (J^T J)^-1`` with J the change of the markers' positions by a
    displacement and a small rotation.
    """
    points = np.asarray(points, dtype=float)
    _check(points)
    n_times = len(readings)
    found = RigidPoses(
        np.full((n_times, 3), np.nan), np.full((n_times, 3, 3), np.nan), np.full((n_times, 6, 6), np.nan),
        np.full(n_times, np.nan),
    )  # fmt: skip
    read = np.isfinite(readings).all(axis=2)
    # times that read the same markers are fitted at once
    for pattern in np.unique(read, axis=0):
        if pattern.sum() < _FEWEST or _spread(points[pattern])[1] < _COLLINEAR * _spread(points)[0]:
            continue
        times = np.flatnonzero((read == pattern).all(axis=1))
        _fit_into(
            found, times, points[pattern], readings[np.ix_(times, np.flatnonzero(pattern))], marker_noise
        )
    return found


def _fit_into(found, times, points, readings, marker_noise):
    middle, centre = points.mean(axis=0), readings.mean(axis=1)
    cross = np.einsum("tmi,mj->tij", readings - centre[:, None], points - middle)
    left, _, right = np.linalg.svd(cross)
    sign = np.sign(np.linalg.det(left @ right))
    left[:, :, 2] *= sign[:, None]
    rotation = left @ right
    found.rotation[times] = rotation
    found.position[times] = centre - rotation @ middle
    arms = np.einsum("tij,mj->tmi", rotation, points)
    left_over = readings - found.position[times][:, None] - arms
    freedom = 3 * len(points) - 6
    found.misfit[times] = np.sqrt((left_over**2).sum(axis=(1, 2)) / freedom) if freedom > 0 else np.nan
    jacobian = np.zeros((len(times), len(points), 3, 6))
    jacobian[..., :3] = np.eye(3)
    jacobian[..., 3:] = -_cross_matrices(arms)
    normal = np.einsum("tmij,tmik->tjk", jacobian, jacobian)
    found.covariance[times] = marker_noise**2 * np.linalg.inv(normal)


def _cross_matrices(vectors):
    """Matrices that turn ``b`` into ``vector x b``, shape (..., 3, 3)."""
    zero = np.zeros(vectors.shape[:-1])
    x, y, z = np.moveaxis(vectors, -1, 0)
    rows = [(zero, -z, y), (z, zero, -x), (-y, x, zero)]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _spread(points):
    """Singular values of the points about their middle, largest first [m]."""
    return np.linalg.svd(points - points.mean(axis=0), compute_uv=False)


def _check(points):
    if len(points) < _FEWEST:
        raise InputError("rigid pose", "markers", f"expected at least {_FEWEST} on a body, not {len(points)}")
    values = _spread(points)
    if values[1] < _COLLINEAR * values[0]:
        raise InputError("rigid pose", "markers", "expected three markers that are not on one line")
