"""Pose of a block from its markers, by least squares, with its uncertainty."""

import numpy as np

from blockshake.measurement.motion.body_frame import rigid_jacobian

_FEWEST_POINTS = 3
# Two markers' spread over the largest below which they lie on a line.
COLLINEAR = 1e-3


def fit_poses(points, readings, marker_noise):
    """Fit a rigid body to its markers at every time.

    Parameters
    ----------
    points : float64 array, shape (n_markers, 3)
        Markers in the body frame, three or more that are not on a line [m].
    readings : float64 array, shape (n_times, n_markers, 3)
        Their positions, inertial frame [m]; a marker with a NaN is not used at that time.
    marker_noise : float
        Standard deviation of a position along an axis, the same for all [m].

    Returns
    -------
    position : float64 array, shape (n_times, 3)
        Of the mass centre, inertial frame [m]; NaN, as all else, where fewer than three markers were read, or markers
        on a line alone.
    rotation : float64 array, shape (n_times, 3, 3)
        Body to world.
    covariance : float64 array, shape (n_times, 6, 6)
        Of position [m] and small rotation, world frame [rad].

    Notes
    -----
    Rotation from the singular vectors of the cross-covariance (Arun, Huang and Blostein 1987; Umeyama 1991).
    To first order the covariance is ``noise^2 (J^T J)^-1`` with J the change of the markers' positions by a
    displacement and a small rotation.
    """
    n_times = len(readings)
    position, rotation = np.full((n_times, 3), np.nan), np.full((n_times, 3, 3), np.nan)
    covariance = np.full((n_times, 6, 6), np.nan)
    read = np.isfinite(readings).all(axis=2)
    # times that read the same markers are fitted at once
    for pattern in np.unique(read, axis=0):
        if pattern.sum() < _FEWEST_POINTS or spread(points[pattern])[1] < COLLINEAR * spread(points)[0]:
            continue
        times = np.flatnonzero((read == pattern).all(axis=1))
        known = points[pattern]
        seen = readings[np.ix_(times, np.flatnonzero(pattern))]
        middle, centre = known.mean(axis=0), seen.mean(axis=1)
        left, _, right = np.linalg.svd(np.einsum("tmi,mj->tij", seen - centre[:, None], known - middle))
        left[:, :, 2] *= np.sign(np.linalg.det(left @ right))[:, None]
        rotation[times] = left @ right
        position[times] = centre - rotation[times] @ middle
        jacobian = rigid_jacobian(np.einsum("tij,mj->tmi", rotation[times], known))
        normal = np.einsum("tmj,tmk->tjk", jacobian, jacobian)
        covariance[times] = marker_noise**2 * np.linalg.inv(normal)
    return position, rotation, covariance


def spread(points):
    """Singular values of the points about their middle, largest first [m]."""
    return np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
